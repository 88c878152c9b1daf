#include "pipeline/patterns/planar_mesh.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/polygon.hpp"
#include "pipeline/patterns/flip_mesh.hpp"

namespace selvedge {
namespace {

constexpr double lattice_clearance = 0.62;  // of the lattice from the outline, in edge lengths
constexpr int relaxations = 30;
constexpr double sound_angle = 0.38;  // if a flip makes a smaller angle, an edge across a corner is cut instead [rad]

FlipMesh outline_mesh(const std::vector<Vec2>& outline) {
  const std::string cure = "draw the panel so that its outline is simple, or take a smaller edge length";
  if (outline.size() < 3 || !(twice_area(outline) > 0)) throw Error("has no area", "outline", cure);
  if (outline.size() > most_eared_corners)
    throw Error(
        fmt::format("is cut into {} edges round its outline; {} are the most", outline.size(), most_eared_corners),
        "outline", "take a larger edge length, or check `units_in_meter`");
  std::vector<Vec3> corners;
  for (const Vec2& p : outline) corners.emplace_back(p.x(), p.y(), 0);
  FlipMesh mesh(outline, polygon_triangles(corners));
  if (!mesh.is_sound()) throw Error("crosses itself when it is cut into edges", "outline", cure);
  mesh.make_delaunay();
  return mesh;
}

double distance_to_outline(const std::vector<Vec2>& outline, const Vec2& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 &a = outline[i], along = outline[(i + 1) % outline.size()] - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + t * along - p).norm());
  }
  return least;
}

void insert_lattice(const std::vector<Vec2>& outline, double edge, FlipMesh& mesh) {
  Vec2 low = outline[0], high = outline[0];
  for (const Vec2& p : outline) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double height = edge * std::sqrt(3.0) / 2;
  // Centred a little beside the middle, so that no point is on an edge of a regular outline.
  const Vec2 middle = (low + high) / 2 + edge * Vec2(0.0137, 0.0071);
  const int rows = static_cast<int>((high.y() - low.y()) / height) + 2,
            columns = static_cast<int>((high.x() - low.x()) / edge) + 2;
  for (int r = -rows / 2 - 1; r <= rows / 2 + 1; ++r)
    for (int c = -columns / 2 - 1; c <= columns / 2 + 1; ++c) {
      const Vec2 p = middle + Vec2(edge * (c + (r % 2 == 0 ? 0.0 : 0.5)), height * r);
      if (distance_to_outline(outline, p) >= lattice_clearance * edge) mesh.insert(p);
    }
}

// Moves each inner vertex to the mean of its neighbours if that turns no triangle over.
void relax(FlipMesh& mesh) {
  for (int round = 0; round < relaxations; ++round) {
    const std::vector<std::vector<int>> around = mesh.triangles_round_vertices();
    for (int v = mesh.fixed; v < static_cast<int>(mesh.points.size()); ++v) {
      Vec2 sum = Vec2::Zero();
      for (const int t : around[v])
        for (const int w : mesh.triangles[t].corner)
          if (w != v) sum += mesh.points[w];
      const Vec2 before = mesh.points[v];
      mesh.points[v] = sum / (2.0 * static_cast<double>(around[v].size()));
      for (const int t : around[v])
        if (mesh.sign(t) <= 0) mesh.points[v] = before;
    }
    mesh.make_delaunay();
  }
}

// Flips inner edges that join vertices of the outline, or cuts them in the middle where a flip makes poor triangles.
void part_chords(FlipMesh& mesh) {
  mesh.may_make_chords = false;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      if (!mesh.is_chord(static_cast<int>(t), k)) continue;
      if (mesh.angle_if_flipped(static_cast<int>(t), k) >= sound_angle)
        mesh.flip(static_cast<int>(t), k);
      else
        mesh.cut(static_cast<int>(t), k);
      k = -1;
    }
}

}  // namespace

double twice_area(const std::vector<Vec2>& outline) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) sum += cross(outline[i], outline[(i + 1) % outline.size()]);
  return sum;
}

PlanarMesh planar_mesh(const std::vector<Vec2>& outline, double edge) {
  FlipMesh mesh = outline_mesh(outline);
  insert_lattice(outline, edge, mesh);
  mesh.make_delaunay();
  part_chords(mesh);
  relax(mesh);
  PlanarMesh result;
  result.points = mesh.points;
  result.triangles.resize(static_cast<Eigen::Index>(mesh.triangles.size()), 3);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) result.triangles(static_cast<Eigen::Index>(t), k) = mesh.triangles[t].corner[k];
  return result;
}

}  // namespace selvedge
