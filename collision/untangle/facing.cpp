#include "collision/untangle/facing.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "collision/geometry/cell_grid.hpp"
#include "collision/geometry/eight_lanes.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "collision/search/bvh_traversal.hpp"

namespace selvedge {
namespace {

constexpr double come_closer = 0.5;   // of their distance at rest: vertices that are nearer have come together
constexpr double deepest_part = 0.7;  // of a part's thickness: deeper, the other part counts as behind it
constexpr float widened = 1e-5F;      // widens the limits of single-precision bounds, which are wrong by less than 1e-6
constexpr int in_a_group = 4;         // vertices of a cube in a group
constexpr int in_a_block = 8;         // groups that are compared at once
constexpr int cubes_away = 2;         // length of the reach in cubes

// Bounds of the places, normals and places at rest of some vertices, one coordinate after the other, rounded outward.
struct Bounds {
  std::array<float, 9> lo, hi;
  Bounds() {
    lo.fill(std::numeric_limits<float>::infinity());
    hi.fill(-std::numeric_limits<float>::infinity());
  }
  void take(int coordinate, double value) {
    const float near = static_cast<float>(value), rounding = std::abs(near) * 0x1p-22F + 1e-30F;
    lo[coordinate] = std::min(lo[coordinate], near - rounding);
    hi[coordinate] = std::max(hi[coordinate], near + rounding);
  }
  void take(const double* x, const double* normal, const double* rest) {
    for (int k = 0; k < 3; ++k) {
      take(k, x[k]);
      take(3 + k, normal[k]);
      take(6 + k, rest[k]);
    }
  }
  void take(const Bounds& other) {
    for (int i = 0; i < 9; ++i) {
      lo[i] = std::min(lo[i], other.lo[i]);
      hi[i] = std::max(hi[i], other.hi[i]);
    }
  }
};

// The bounds of eight groups. A place that is left over has NaN.
struct Block {
  alignas(32) float lo[9][in_a_block], hi[9][in_a_block];
};

// Two groups, vertex by vertex: places, normals and places at rest. What is left over has NaN.
struct TwoGroups {
  alignas(32) float at[9][2 * in_a_group];
};
// A vertex, and up to where others may face it: squares of lengths, widened by what rounding may do.
struct VertexLimits {
  float at[9];
  float most;    // of the distance [m2]
  float closer;  // added to the part of the distance at rest [m2]
};

template <class Lanes>
[[gnu::always_inline]] inline void load(const float* from, Lanes& lanes) {
  __builtin_memcpy(&lanes, from, sizeof lanes);
}
template <class Lanes>
[[gnu::always_inline]] inline void keep_smaller(const Lanes& other, Lanes& lanes) {
  lanes = other < lanes ? other : lanes;
}
template <class Lanes>
[[gnu::always_inline]] inline void keep_larger(const Lanes& other, Lanes& lanes) {
  lanes = other > lanes ? other : lanes;
}

// Sets the flags of the groups of the block from `first` on: false only if no vertex of the group is nearer than the
// square root of `most` to a vertex in the bounds, faces it, and was farther away at rest. Vectors are arguments, since
// clang cannot return wide ones between functions of different instruction sets.
template <class Lanes, class Flags>
[[gnu::always_inline]] inline void set_flags(const Bounds& a, const Block& b, int first, float most, Flags& flags) {
  constexpr float cosine = static_cast<float>(facing_cosine) + widened;
  constexpr float closer = static_cast<float>(come_closer * come_closer) * (1 + widened);
  Lanes gap{}, dot{}, at_rest{};
  for (int x = 0, n = 3, r = 6; x < 3; ++x, ++n, ++r) {
    Lanes lo, hi, lo_n, hi_n, lo_r, hi_r;
    load(b.lo[x] + first, lo);
    load(b.hi[x] + first, hi);
    load(b.lo[n] + first, lo_n);
    load(b.hi[n] + first, hi_n);
    load(b.lo[r] + first, lo_r);
    load(b.hi[r] + first, hi_r);
    Lanes apart = a.lo[x] - hi;
    keep_larger<Lanes>(lo - a.hi[x], apart);
    keep_larger<Lanes>(Lanes{}, apart);
    gap += apart * apart;
    Lanes least = a.lo[n] * lo_n;
    keep_smaller<Lanes>(a.lo[n] * hi_n, least);
    keep_smaller<Lanes>(a.hi[n] * lo_n, least);
    keep_smaller<Lanes>(a.hi[n] * hi_n, least);
    dot += least;
    Lanes far = a.hi[r] - lo_r;
    keep_larger<Lanes>(hi_r - a.lo[r], far);
    at_rest += far * far;
  }
  flags = (gap <= most) & (dot <= cosine) & (gap <= closer * at_rest);
}

// Sets the flags of the vertices from `first` on, as set_flags does for groups.
template <class Lanes, class Flags>
[[gnu::always_inline]] inline void set_vertex_flags(const VertexLimits& a, const TwoGroups& b, int first,
                                                    Flags& flags) {
  constexpr float cosine = static_cast<float>(facing_cosine) + widened;
  constexpr float closer = static_cast<float>(come_closer * come_closer) * (1 + widened);
  Lanes gap{}, dot{}, at_rest{};
  for (int x = 0, n = 3, r = 6; x < 3; ++x, ++n, ++r) {
    Lanes place, normal, rest;
    load(b.at[x] + first, place);
    load(b.at[n] + first, normal);
    load(b.at[r] + first, rest);
    gap += (place - a.at[x]) * (place - a.at[x]);
    dot += normal * a.at[n];
    at_rest += (rest - a.at[r]) * (rest - a.at[r]);
  }
  flags = (gap <= a.most) & (dot <= cosine) & (gap <= closer * at_rest + a.closer);
}

// One bit for each group of the block, or for each vertex of two groups.
unsigned may_face_plain(const Bounds& a, const Block& b, float most) {
  LaneFlags low, high;
  set_flags<Bvh::Lanes>(a, b, 0, most, low);
  set_flags<Bvh::Lanes>(a, b, 4, most, high);
  return bits_of(low, high);
}

unsigned vertices_may_face_plain(const VertexLimits& a, const TwoGroups& b) {
  LaneFlags low, high;
  set_vertex_flags<Bvh::Lanes>(a, b, 0, low);
  set_vertex_flags<Bvh::Lanes>(a, b, 4, high);
  return bits_of(low, high);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] unsigned may_face_avx2(const Bounds& a, const Block& b, float most) {
  EightBits flags;
  set_flags<Eight>(a, b, 0, most, flags);
  return bits_avx2(flags);
}
[[gnu::target("avx2")]] unsigned vertices_may_face_avx2(const VertexLimits& a, const TwoGroups& b) {
  EightBits flags;
  set_vertex_flags<Eight>(a, b, 0, flags);
  return bits_avx2(flags);
}
#else
constexpr auto may_face_avx2 = may_face_plain;
constexpr auto vertices_may_face_avx2 = vertices_may_face_plain;
#endif

// Groups of a block, one bit each.
struct Near {
  int block;
  unsigned groups;
};

// A posed body with its vertices also in the order of a grid, so that searches read memory in order.
struct PosedCubes {
  const FacingBody& body;
  const Points &x, &normals;
  unsigned (*may_face)(const Bounds&, const Block&, float) = has_avx2() ? may_face_avx2 : may_face_plain;
  unsigned (*vertices_may_face)(const VertexLimits&, const TwoGroups&) = has_avx2() ? vertices_may_face_avx2
                                                                                    : vertices_may_face_plain;
  CellGrid grid;
  Points x_near, normals_near, rest_near;
  std::vector<int> filled;        // cubes that hold vertices
  std::vector<Bounds> in_filled;  // bounds of these
  std::vector<int> first_group;   // of each cube; one more at the end
  std::vector<int> first_vertex;  // of each group, in the grid's order; one more at the end
  std::vector<Bounds> in_group;   // bounds of the groups, and the same in blocks
  std::vector<Block> blocks;
  std::vector<TwoGroups> by_vertex;  // four for each block
  double largest;                    // coordinate [m]
  double rounding;                   // that a distance in single precision may have, at most [m]
  std::vector<unsigned> moved;       // of each block the groups with a vertex that has moved, one bit each
  std::vector<char> anew;            // of each vertex in the grid's order: whether it or its partner has moved

  PosedCubes(const FacingBody& b, const Points& posed, const Points& n, const Facing* before)
      : body(b),
        x(posed),
        normals(n),
        grid(posed, b.reach / cubes_away),
        x_near(posed(grid.order(), Eigen::all)),
        normals_near(n(grid.order(), Eigen::all)),
        rest_near(b.rest(grid.order(), Eigen::all)),
        largest(std::max(largest_coordinate(posed), largest_coordinate(b.rest))),
        rounding(0x1p-21 * largest) {
    for (int cube = 0; cube < grid.cubes(); ++cube) {
      first_group.push_back(static_cast<int>(in_group.size()));
      if (grid.first(cube) == grid.first(cube + 1)) continue;
      filled.push_back(cube);
      in_filled.emplace_back();
      for (int p = grid.first(cube); p < grid.first(cube + 1); p += in_a_group) {
        const int end = std::min(p + in_a_group, grid.first(cube + 1));
        first_vertex.push_back(p);
        in_group.push_back(bounds_of(p, end));
        in_filled.back().take(in_group.back());
      }
    }
    first_group.push_back(static_cast<int>(in_group.size()));
    first_vertex.push_back(static_cast<int>(x.rows()));
    fill_blocks();
    fill_by_vertex();
    mark_moved(before);
  }

  // Of the vertices [begin, end) in the grid's order.
  Bounds bounds_of(int begin, int end) const {
    Bounds bounds;
    for (int p = begin; p < end; ++p)
      bounds.take(x_near.data() + 3 * p, normals_near.data() + 3 * p, rest_near.data() + 3 * p);
    return bounds;
  }

  void fill_blocks() {
    const std::size_t count = in_group.size();
    blocks.resize((count + in_a_block - 1) / in_a_block);
    for (std::size_t g = 0; g < blocks.size() * in_a_block; ++g)
      for (int i = 0; i < 9; ++i) {
        constexpr float none = std::numeric_limits<float>::quiet_NaN();
        Block& block = blocks[g / in_a_block];
        block.lo[i][g % in_a_block] = g < count ? in_group[g].lo[i] : none;
        block.hi[i][g % in_a_block] = g < count ? in_group[g].hi[i] : none;
      }
  }

  void fill_by_vertex() {
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    by_vertex.resize(blocks.size() * in_a_block / 2);
    for (std::size_t g = 0; g < blocks.size() * in_a_block; ++g)
      for (int i = 0; i < in_a_group; ++i) {
        const bool is_used = g < in_group.size() && first_vertex[g] + i < first_vertex[g + 1];
        const int p = is_used ? first_vertex[g] + i : 0;
        const std::size_t lane = g % 2 * in_a_group + static_cast<std::size_t>(i);
        float(&at)[9][2 * in_a_group] = by_vertex[g / 2].at;
        for (int k = 0; k < 3; ++k) {
          at[k][lane] = is_used ? static_cast<float>(x_near(p, k)) : none;
          at[3 + k][lane] = is_used ? static_cast<float>(normals_near(p, k)) : none;
          at[6 + k][lane] = is_used ? static_cast<float>(rest_near(p, k)) : none;
        }
      }
  }

  // Of vertex p of the grid's order, for distances up to `nearest` [m2].
  VertexLimits limits_of(int p, double nearest) const {
    VertexLimits limits;
    for (int k = 0; k < 3; ++k) {
      limits.at[k] = static_cast<float>(x_near(p, k));
      limits.at[3 + k] = static_cast<float>(normals_near(p, k));
      limits.at[6 + k] = static_cast<float>(rest_near(p, k));
    }
    // Twice the root of either square times the rounding; distances at rest are below four times the largest
    // coordinate.
    limits.closer = static_cast<float>(4 * rounding * (body.reach + largest) + 2 * rounding * rounding);
    set_most(nearest, limits);
    return limits;
  }
  void set_most(double nearest, VertexLimits& limits) const {
    const double most = std::sqrt(nearest) + rounding;
    limits.most = static_cast<float>(most * most) * (1 + widened);
  }

  // Without a pose before everything has moved.
  void mark_moved(const Facing* before) {
    anew.assign(static_cast<std::size_t>(x.rows()), before == nullptr);
    moved.assign(blocks.size(), before ? 0U : ~0U);
    if (!before) return;
    const auto has_moved = [&](int v) {
      return x.row(v) != before->x.row(v) || normals.row(v) != before->normals.row(v);
    };
    for (int g = 0; g < static_cast<int>(in_group.size()); ++g)
      for (int p = first_vertex[g]; p < first_vertex[g + 1]; ++p) {
        const int v = grid.order()[p], partner = before->partner[v];
        const bool own = has_moved(v);
        anew[p] = own || (partner >= 0 && has_moved(partner));
        if (own) moved[g / in_a_block] |= 1U << g % in_a_block;
      }
  }
  bool any_anew(int begin, int end) const {
    return std::any_of(anew.begin() + begin, anew.begin() + end, [](char marked) { return marked != 0; });
  }

  // Keeps those of the groups that may face a vertex in the bounds within reach; with `all` false, only those that have
  // moved.
  void keep_facing(const Bounds& bounds, bool all, Near from, std::vector<Near>& kept) const {
    const float most = static_cast<float>(body.reach * body.reach) * (1 + widened);
    if (!all) from.groups &= moved[from.block];
    if (from.groups != 0) from.groups &= may_face(bounds, blocks[from.block], most);
    if (from.groups != 0) kept.push_back(from);
  }

  // The same of the groups of the cubes [first, last].
  void add_facing(const Bounds& bounds, bool all, int first, int last, std::vector<Near>& near) const {
    const int begin = first_group[first], end = first_group[last + 1];
    for (int block = begin / in_a_block; block * in_a_block < end; ++block) {
      const int from = std::max(begin - block * in_a_block, 0), to = std::min(end - block * in_a_block, in_a_block);
      keep_facing(bounds, all, {block, (1U << to) - (1U << from)}, near);
    }
  }
};

// Whether place q of the grid's order comes before vertex w.
bool comes_before(const CellGrid& grid, int q, int w) {
  return std::find(grid.order().begin() + q, grid.order().end(), w) != grid.order().end();
}

// The vertex that faces vertex p of the grid's order; -1: none. near: groups, ascending. known: its partner in the pose
// before, where neither has moved.
int facing_vertex(const PosedCubes& posed, int p, const std::vector<Near>& near, int known) {
  const FacingBody& body = posed.body;
  const int v = posed.grid.order()[p];
  const Vec3 at = row(posed.x_near, p), normal = row(posed.normals_near, p);
  const bool all = posed.anew[p] != 0;
  int found = all ? -1 : known;
  double nearest = found < 0 ? body.reach * body.reach : (at - row(posed.x, found)).squaredNorm();
  VertexLimits limits = posed.limits_of(p, nearest);
  const auto look_at = [&](int q) {
    const Vec3 facing = row(posed.normals_near, q), way = at - row(posed.x_near, q);
    if (facing.dot(normal) > facing_cosine) return;
    const double square = way.squaredNorm();
    if (square > nearest || (square == nearest && (found < 0 || !comes_before(posed.grid, q, found)))) return;
    const int w = posed.grid.order()[q];
    const double thin = deepest_part * std::min(body.thickness[v], body.thickness[w]);
    if (square >= thin * thin && way.dot(facing) < 0) return;
    if (square >= come_closer * come_closer * (posed.rest_near.row(p) - posed.rest_near.row(q)).squaredNorm()) return;
    nearest = square;
    posed.set_most(nearest, limits);
    found = w;
  };
  for (const auto& [block, groups] : near)
    for (unsigned left = all ? groups : groups & posed.moved[block]; left != 0;) {
      const int two = std::countr_zero(left) / 2;
      const unsigned which = left >> 2 * two & 3U;
      left &= ~(3U << 2 * two);
      const unsigned lanes = (which & 1U ? 0x0FU : 0U) | (which & 2U ? 0xF0U : 0U);
      const int pair = block * in_a_block / 2 + two;
      for (unsigned bits = lanes & posed.vertices_may_face(limits, posed.by_vertex[pair]); bits != 0;
           bits &= bits - 1) {
        const int lane = std::countr_zero(bits);
        look_at(posed.first_vertex[2 * pair + lane / in_a_group] + lane % in_a_group);
      }
    }
  return found;
}

bool same_box(const Points& a, const Points& b) {
  return a.rows() == b.rows() && a.rows() > 0 && a.colwise().minCoeff() == b.colwise().minCoeff() &&
         a.colwise().maxCoeff() == b.colwise().maxCoeff();
}

}  // namespace

// Most groups near a vertex have only vertices of the same part, which face the same way and were as near at rest. They
// are skipped for all vertices of a cube at once, then for those of a group, then for each.
Facing facing_vertices(const FacingBody& body, const Points& x, const Points& normals, const Facing* before) {
  if (before && !same_box(before->x, x)) before = nullptr;  // the grid's order differs
  const PosedCubes posed(body, x, normals, before);
  Facing facing{x, normals, std::vector<int>(static_cast<std::size_t>(x.rows()))};
  StopPoll stop;
#pragma omp parallel
  {
    std::vector<Near> near_cube, near_group;
#pragma omp for schedule(dynamic, 16)
    for (int c = 0; c < static_cast<int>(posed.filled.size()); ++c) {
      if (stop.wanted()) continue;
      const int cube = posed.filled[c];
      near_cube.clear();
      const bool all = posed.any_anew(posed.grid.first(cube), posed.grid.first(cube + 1));
      posed.grid.for_each_row_around(cube, cubes_away, [&](int first, int last) {
        posed.add_facing(posed.in_filled[c], all, first, last, near_cube);
      });
      for (int g = posed.first_group[cube]; g < posed.first_group[cube + 1]; ++g) {
        near_group.clear();
        const int begin = posed.first_vertex[g], end = posed.first_vertex[g + 1];
        const bool all_of_group = posed.any_anew(begin, end);
        for (const Near from : near_cube) posed.keep_facing(posed.in_group[g], all_of_group, from, near_group);
        for (int p = begin; p < end; ++p) {
          const int v = posed.grid.order()[p];
          facing.partner[v] = facing_vertex(posed, p, near_group, before ? before->partner[v] : -1);
        }
      }
    }
  }
  stop.check();
  return facing;
}

}  // namespace selvedge
