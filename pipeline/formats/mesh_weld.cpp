#include "pipeline/formats/mesh_weld.hpp"

#include <algorithm>

#include "collision/geometry/same_places.hpp"
#include "pipeline/formats/mesh_io.hpp"

namespace selvedge {
namespace {

void renumber(const std::vector<int>& numbers, int count, Mesh& mesh) {
  Points x(count, 3);
  for (std::size_t v = numbers.size(); v-- > 0;)  // the lowest comes last and stays
    x.row(numbers[v]) = mesh.x.row(static_cast<Eigen::Index>(v));
  mesh.x = std::move(x);
  for (int& v : mesh.triangles.reshaped()) v = numbers[v];
  for (int& corner : mesh.corners) corner = numbers[corner];
  for (auto& [name, vertices] : mesh.groups) {
    for (int& v : vertices) v = numbers[v];
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }
}

}  // namespace

int coincident_vertices(const Points& x) {
  const std::vector<int> places = same_places(x);
  int count = 0;
  for (std::size_t v = 0; v < places.size(); ++v) count += places[v] != static_cast<int>(v);
  return count;
}

void renumber_look(const std::vector<int>& numbers, Mesh& mesh) {
  if (mesh.look.empty() && !mesh.corners.empty())
    mesh.look = plain_look(numbers.size(), mesh.corners, mesh.corner_begin);
  renumber(numbers, mesh.look);
}

void weld(Mesh& mesh, const std::string& name) {
  const std::vector<int> places = same_places(mesh.x);
  mesh.welded.assign(places.size(), 0);
  int count = 0;
  for (std::size_t v = 0; v < places.size(); ++v)
    mesh.welded[v] = places[v] == static_cast<int>(v) ? count++ : mesh.welded[places[v]];
  renumber_look(mesh.welded, mesh);
  renumber(mesh.welded, count, mesh);
  leave_out_repeated(mesh, name);
}

void weld_as(const Mesh& welded, Mesh& mesh) {
  if (welded.welded.empty()) return;
  renumber(welded.welded, static_cast<int>(welded.x.rows()), mesh);
  mesh.triangles = welded.triangles;
}

}  // namespace selvedge
