#include "collision/untangle/facing.hpp"

#include <algorithm>
#include <limits>

#include "collision/geometry/cell_grid.hpp"
#include "collision/geometry/stop_scope.hpp"

namespace selvedge {
namespace {

constexpr double come_closer = 0.5;   // of their distance at rest: vertices that are nearer have come together
constexpr double deepest_part = 0.7;  // of a part's thickness: deeper, the other part counts as behind it
constexpr double widened = 1 + 1e-9;  // factor that widens bounds of many vertices, for rounding
constexpr int in_a_group = 4;         // vertices of a cube in a group
constexpr int cubes_away = 2;         // length of the reach in cubes

struct Extent {
  Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity()), hi = -lo;
  void take(const Vec3& at) {
    lo = lo.cwiseMin(at);
    hi = hi.cwiseMax(at);
  }
  void take(const Extent& other) {
    lo = lo.cwiseMin(other.lo);
    hi = hi.cwiseMax(other.hi);
  }
};

// A lower bound of the dot product of a vector in a and a vector in b.
double least_dot(const Extent& a, const Extent& b) {
  const Eigen::Array3d ll = a.lo.array() * b.lo.array(), lh = a.lo.array() * b.hi.array(),
                       hl = a.hi.array() * b.lo.array(), hh = a.hi.array() * b.hi.array();
  return ll.min(lh).min(hl).min(hh).sum();
}

double least_square(const Extent& a, const Extent& b) {
  return (a.lo - b.hi).cwiseMax(b.lo - a.hi).cwiseMax(0).squaredNorm();
}

double largest_square(const Extent& a, const Extent& b) {
  return (a.hi - b.lo).cwiseAbs().cwiseMax((b.hi - a.lo).cwiseAbs()).squaredNorm();
}

// Bounds of the vertices of a cube, or of a group in it.
struct Extents {
  Extent x, normals, rest;
  void take(const Extents& other) {
    x.take(other.x);
    normals.take(other.normals);
    rest.take(other.rest);
  }
};

// Vertices [first, last) in the grid's order, all in one cube.
struct VertexGroup {
  int first, last;
  Extents extents;
};

// A posed body with its vertices also in the order of a grid, so that searches read memory in order.
struct PosedCubes {
  const FacingBody& body;
  const Points &x, &normals;
  CellGrid grid;
  Points x_near, normals_near;
  std::vector<int> filled;       // cubes that hold vertices
  std::vector<int> place;        // of each cube its index in `filled`; -1: empty
  std::vector<Extents> extents;  // of these
  std::vector<int> first_group;  // of each filled cube; one more at the end
  std::vector<VertexGroup> groups;

  PosedCubes(const FacingBody& b, const Points& posed, const Points& n)
      : body(b),
        x(posed),
        normals(n),
        grid(posed, b.reach / cubes_away),
        x_near(posed(grid.order(), Eigen::all)),
        normals_near(n(grid.order(), Eigen::all)),
        place(static_cast<std::size_t>(grid.cubes()), -1) {
    for (int cube = 0; cube < grid.cubes(); ++cube) {
      if (grid.first(cube) == grid.first(cube + 1)) continue;
      place[cube] = static_cast<int>(filled.size());
      filled.push_back(cube);
      Extents& own = extents.emplace_back();
      first_group.push_back(static_cast<int>(groups.size()));
      for (int p = grid.first(cube); p < grid.first(cube + 1); ++p) {
        if ((p - grid.first(cube)) % in_a_group == 0) groups.push_back({p, p, {}});
        VertexGroup& group = groups.back();
        group.last = p + 1;
        group.extents.x.take(row(x_near, p));
        group.extents.normals.take(row(normals_near, p));
        group.extents.rest.take(row(body.rest, grid.order()[p]));
      }
      for (std::size_t g = static_cast<std::size_t>(first_group.back()); g < groups.size(); ++g)
        own.take(groups[g].extents);
    }
    first_group.push_back(static_cast<int>(groups.size()));
  }
};

// False only if no vertex of a faces a vertex of b that was farther away at rest.
bool may_face(const Extents& a, const Extents& b, double reach) {
  const double square = least_square(a.x, b.x);
  return square <= widened * reach * reach && least_dot(a.normals, b.normals) <= facing_cosine + (widened - 1) &&
         square <= widened * come_closer * come_closer * largest_square(a.rest, b.rest);
}

// near: groups, ascending.
int facing_vertex(const PosedCubes& posed, int v, const std::vector<int>& near) {
  const FacingBody& body = posed.body;
  const Vec3 at = row(posed.x, v), normal = row(posed.normals, v), rest = row(body.rest, v);
  int found = -1;
  double nearest = body.reach * body.reach;
  const auto look_at = [&](int p) {
    if (row(posed.normals_near, p).dot(normal) > facing_cosine) return;
    const Vec3 way = at - row(posed.x_near, p);
    const double square = way.squaredNorm();
    if (square >= nearest) return;
    const int w = posed.grid.order()[p];
    const double thin = deepest_part * std::min(body.thickness[v], body.thickness[w]);
    if (square >= thin * thin && way.dot(row(posed.normals, w)) < 0) return;
    if (square >= come_closer * come_closer * (body.rest.row(v) - body.rest.row(w)).squaredNorm()) return;
    nearest = square;
    found = w;
  };
  for (const int g : near) {
    const auto& [first, last, extents] = posed.groups[g];
    const double gap = (extents.x.lo - at).cwiseMax(at - extents.x.hi).cwiseMax(0).squaredNorm();
    const double cosine =
        normal.cwiseProduct(extents.normals.lo).cwiseMin(normal.cwiseProduct(extents.normals.hi)).sum();
    if (gap > widened * nearest || cosine > facing_cosine + (widened - 1)) continue;
    const double at_rest =
        (extents.rest.hi - rest).cwiseAbs().cwiseMax((rest - extents.rest.lo).cwiseAbs()).squaredNorm();
    if (gap > widened * come_closer * come_closer * at_rest) continue;
    for (int p = first; p < last; ++p) look_at(p);
  }
  return found;
}

}  // namespace

// Most cubes near a vertex have only vertices of the same part, which face the same way and were as near at rest. Such
// cubes are skipped for all vertices of a cube at once, and such groups for all vertices of a group.
std::vector<int> facing_vertices(const FacingBody& body, const Points& x, const Points& normals) {
  const PosedCubes posed(body, x, normals);
  std::vector<int> partner(static_cast<std::size_t>(x.rows()));
  StopPoll stop;
#pragma omp parallel
  {
    std::vector<int> in_cubes, near;  // groups
#pragma omp for schedule(dynamic, 16)
    for (int c = 0; c < static_cast<int>(posed.filled.size()); ++c) {
      if (stop.wanted()) continue;
      in_cubes.clear();
      posed.grid.for_each_cube_around(posed.filled[c], cubes_away, [&](int cube) {
        const int other = posed.place[cube];
        if (other < 0 || !may_face(posed.extents[c], posed.extents[other], body.reach)) return;
        for (int g = posed.first_group[other]; g < posed.first_group[other + 1]; ++g)
          if (may_face(posed.extents[c], posed.groups[g].extents, body.reach)) in_cubes.push_back(g);
      });
      for (int own = posed.first_group[c]; own < posed.first_group[c + 1]; ++own) {
        const VertexGroup& group = posed.groups[own];
        near.clear();
        for (const int g : in_cubes)
          if (may_face(group.extents, posed.groups[g].extents, body.reach)) near.push_back(g);
        for (int p = group.first; p < group.last; ++p)
          partner[posed.grid.order()[p]] = facing_vertex(posed, posed.grid.order()[p], near);
      }
    }
  }
  stop.check();
  return partner;
}

}  // namespace selvedge
