#include "pipeline/shapes/isosurface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "pipeline/shapes/generate.hpp"

namespace selvedge {
namespace {

constexpr int block = 4;  // cubes along a block that is skipped as one

// Corners of a cube are numbered by bits x, y, z; each tetrahedron climbs from 0 to 7.
constexpr std::array<std::array<int, 4>, 6> tetrahedra{
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};

struct Grid {
  const std::function<double(const Vec3&)>& value;
  Vec3 low;
  double edge;
  std::array<long, 3> nodes{};
  std::vector<double> values;  // NaN: not needed yet
  std::unordered_map<long, int> vertex_of;
  std::vector<Vec3> x;
  std::vector<std::array<int, 3>> triangles;

  long node(int i, int j, int k) const { return i + nodes[0] * (j + nodes[1] * static_cast<long>(k)); }
  Vec3 position(long n) const {
    return low + edge * Vec3(static_cast<double>(n % nodes[0]), static_cast<double>(n / nodes[0] % nodes[1]),
                             static_cast<double>(n / (nodes[0] * nodes[1])));
  }
  double at(long n) {
    double& known = values[n];
    if (std::isnan(known)) known = value(position(n));
    return known;
  }
  // The vertex on the grid's edge from node a to b > a; `kind` is the edge's direction in bits.
  int vertex(long a, long b, int kind) {
    const auto [entry, fresh] = vertex_of.emplace(8 * a + kind, static_cast<int>(x.size()));
    if (fresh) {  // away from the nodes, so that no triangle is degenerate
      const double t = std::clamp(at(a) / (at(a) - at(b)), 0.02, 0.98);
      x.push_back((1 - t) * position(a) + t * position(b));
    }
    return entry->second;
  }
};

void add_triangle(Grid& grid, std::array<int, 3> corners, const Vec3& outward) {
  const auto at = [&](int k) -> const Vec3& { return grid.x[corners[k]]; };
  if ((at(1) - at(0)).cross(at(2) - at(0)).dot(outward) < 0) std::swap(corners[1], corners[2]);
  grid.triangles.push_back(corners);
}

void march(Grid& grid, const std::array<long, 8>& node, const std::array<int, 4>& tetrahedron) {
  std::vector<int> in, out;
  for (const int corner : tetrahedron) (grid.at(node[corner]) < 0 ? in : out).push_back(corner);
  if (in.empty() || out.empty()) return;
  const auto vertex = [&](int a, int b) { return grid.vertex(node[std::min(a, b)], node[std::max(a, b)], a ^ b); };
  Vec3 outward = Vec3::Zero();
  for (const int b : out)
    for (const int a : in) outward += grid.position(node[b]) - grid.position(node[a]);
  std::vector<int> loop;
  if (in.size() == 2)
    loop = {vertex(in[0], out[0]), vertex(in[0], out[1]), vertex(in[1], out[1]), vertex(in[1], out[0])};
  else
    for (const int a : in)
      for (const int b : out) loop.push_back(vertex(a, b));
  for (std::size_t k = 2; k < loop.size(); ++k) add_triangle(grid, {loop[0], loop[k - 1], loop[k]}, outward);
}

}  // namespace

Shape isosurface(const std::function<double(const Vec3&)>& value, const Vec3& low, const Vec3& high, double edge) {
  Grid grid{value, low, edge, {}, {}, {}, {}, {}};
  std::array<int, 3> blocks{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double length = high[static_cast<int>(k)] - low[static_cast<int>(k)];
    blocks[k] = static_cast<int>(std::ceil(length / (edge * block)));
    grid.nodes[k] = blocks[k] * block + 1;
  }
  grid.values.assign(static_cast<std::size_t>(grid.nodes[0] * grid.nodes[1] * grid.nodes[2]), std::nan(""));
  const double reach = 1.5 * std::sqrt(3.0) / 2 * block * edge;
  for (int c = 0; c < blocks[2]; ++c)
    for (int b = 0; b < blocks[1]; ++b)
      for (int a = 0; a < blocks[0]; ++a) {
        const long middle = grid.node(a * block + block / 2, b * block + block / 2, c * block + block / 2);
        if (std::abs(grid.at(middle)) > reach) continue;
        for (int cube = 0; cube < block * block * block; ++cube) {
          const int i = a * block + cube % block, j = b * block + cube / block % block,
                    k = c * block + cube / block / block;
          std::array<long, 8> node{};
          for (int corner = 0; corner < 8; ++corner)
            node[corner] = grid.node(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2));
          for (const auto& tetrahedron : tetrahedra) march(grid, node, tetrahedron);
        }
      }
  return {to_points(grid.x), to_triangles(grid.triangles)};
}

}  // namespace selvedge
