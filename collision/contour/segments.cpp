#include "collision/contour/segments.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

#include "collision/exact/symbolic_orientation.hpp"
#include "collision/exact/triangle_pair.hpp"
#include "collision/geometry/corners.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "collision/search/bvh_traversal.hpp"
#include "collision/search/intersections.hpp"

namespace selvedge {
namespace {

// Triangle of a sheet with the ranks of its corners.
struct Face {
  int sheet = 0, triangle = 0;
  std::array<int, 3> vertex;
  std::array<Vec3, 3> at;
  std::array<int, 3> rank;
  RankedPoint corner(int k) const { return {&at[k], rank[k]}; }
};

Face make_face(std::span<const SheetView> sheets, std::span<const int> first_rank, int sheet, int triangle) {
  Face face{sheet, triangle, {}, {}, {}};
  for (int k = 0; k < 3; ++k) {
    face.vertex[k] = sheets[sheet].surface->triangles(triangle, k);
    face.at[k] = row(*sheets[sheet].x, face.vertex[k]);
    face.rank[k] = first_rank[sheet] + face.vertex[k];
  }
  return face;
}

struct Shared {
  int count = 0;
  int in_a = -1, in_b = -1;  // indices of the shared corner last found
};

Shared shared_vertices(const Face& a, const Face& b) {
  Shared shared;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (a.rank[i] == b.rank[j]) shared = {shared.count + 1, i, j};
  return shared;
}

// Sides of the corners of `of` against the plane of `plane`; 0 for the shared corner.
std::array<int, 3> sides(const Face& plane, const Face& of, int shared_corner, bool& exact_zero) {
  std::array<int, 3> side{};
  for (int k = 0; k < 3; ++k)
    if (k != shared_corner)
      side[k] = symbolic_orient3d(plane.corner(0), plane.corner(1), plane.corner(2), of.corner(k), exact_zero);
  return side;
}

bool all_on_one_side(const std::array<int, 3>& side) {
  return (side[0] >= 0 && side[1] >= 0 && side[2] >= 0) || (side[0] <= 0 && side[1] <= 0 && side[2] <= 0);
}

// Does the line through p and q, which lie on different sides of the face, pass through it?
bool line_meets(const RankedPoint& p, const RankedPoint& q, const Face& face, bool& exact_zero) {
  const int first = symbolic_orient3d(p, q, face.corner(0), face.corner(1), exact_zero);
  return first == symbolic_orient3d(p, q, face.corner(1), face.corner(2), exact_zero) &&
         first == symbolic_orient3d(p, q, face.corner(2), face.corner(0), exact_zero);
}

struct Quotients {
  double s;
  std::array<double, 3> weight;
};

long double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  using Long = Eigen::Matrix<long double, 3, 1>;
  const Long origin = a.cast<long double>();
  const Long ab = b.cast<long double>() - origin, ac = c.cast<long double>() - origin;
  return ab.cross(ac).dot(d.cast<long double>() - origin);
}

Quotients quotients(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& f) {
  const long double below = volume(f[0], f[1], f[2], p), above = volume(f[0], f[1], f[2], q), span = below - above;
  Quotients result{span != 0 ? std::clamp(static_cast<double>(below / span), 0.0, 1.0) : 0.5, {}};
  const std::array<long double, 3> part{volume(p, q, f[1], f[2]), volume(p, q, f[2], f[0]), volume(p, q, f[0], f[1])};
  const long double sign = part[0] + part[1] + part[2] < 0 ? -1 : 1;
  long double sum = 0;
  for (long double w : part) sum += std::max(sign * w, 0.0L);
  for (int k = 0; k < 3; ++k)
    result.weight[k] = sum > 0 ? static_cast<double>(std::max(sign * part[k], 0.0L) / sum) : 1.0 / 3;
  return result;
}

Crossing make_crossing(std::span<const SheetView> sheets, const Face& edge_of, int corner, const Face& face) {
  const Surface& surface = *sheets[edge_of.sheet].surface;
  const int edge = surface.triangle_edges(edge_of.triangle, corner);
  const Vec3 p = row(*sheets[edge_of.sheet].x, surface.edges(edge, 0));
  const Vec3 q = row(*sheets[edge_of.sheet].x, surface.edges(edge, 1));
  const Quotients found = quotients(p, q, face.at);
  return {edge_of.sheet, edge, face.sheet, face.triangle, found.s, found.weight};
}

// Two triangles in general position have no crossing or two; with a shared vertex none or one.
struct PairResult {
  std::vector<Crossing> crossings;
  int shared_vertex = -1;
  bool touching = false;
};

void add_crossings(std::span<const SheetView> sheets, const Face& edges_of, const std::array<int, 3>& side,
                   const Face& face, bool& exact_zero, PairResult& result) {
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (side[k] * side[next] < 0 && line_meets(edges_of.corner(k), edges_of.corner(next), face, exact_zero))
      result.crossings.push_back(make_crossing(sheets, edges_of, k, face));
  }
}

PairResult cross(std::span<const SheetView> sheets, const Face& a, const Face& b) {
  PairResult result;
  const Shared shared = shared_vertices(a, b);
  if (shared.count > 1) return result;
  bool exact_zero = false;
  const std::array<int, 3> side_b = sides(a, b, shared.in_b, exact_zero);
  if (!all_on_one_side(side_b)) {
    const std::array<int, 3> side_a = sides(b, a, shared.in_a, exact_zero);
    if (!all_on_one_side(side_a)) {
      add_crossings(sheets, a, side_a, b, exact_zero, result);
      add_crossings(sheets, b, side_b, a, exact_zero, result);
    }
  }
  if (shared.count == 1) result.shared_vertex = a.vertex[shared.in_a];
  result.touching = result.crossings.empty() && shared.count == 0 && exact_zero && triangles_meet(a.at, b.at);
  return result;
}

struct Candidate {
  int sheet, a, b;  // a is a triangle of sheet 0, b of `sheet`
};

std::vector<FacePlane> face_planes(const SheetView& sheet) {
  std::vector<FacePlane> planes(static_cast<std::size_t>(sheet.surface->triangles.rows()));
  const int count = static_cast<int>(planes.size());
#pragma omp parallel for schedule(static)
  for (int t = 0; t < count; ++t) planes[t] = face_plane(corners_of(*sheet.surface, *sheet.x, t));
  return planes;
}

// False only if a pair without a common corner has no segment and does not touch. Decides most pairs without exact
// signs.
bool may_meet(const SheetView& of_a, const FacePlane& plane_a, int a, const SheetView& of_b, const FacePlane& plane_b,
              int b) {
  const std::array<Vec3, 3> at_a = corners_of(*of_a.surface, *of_a.x, a), at_b = corners_of(*of_b.surface, *of_b.x, b);
  return !surely_on_one_side(plane_a, at_b) && !surely_on_one_side(plane_b, at_a) && !surely_apart(at_a, at_b);
}

// A triangle at a vertex: its other two corners.
struct RoundVertex {
  int triangle;
  std::array<int, 2> vertex;
  std::array<Vec3, 2> at;
};

void list_round_vertex(const SheetView& sheet, int vertex, std::vector<RoundVertex>& round) {
  round.clear();
  for (const int t : sheet.surface->triangles_of(vertex)) {
    const int* v = sheet.surface->triangles.data() + 3 * t;
    const int k = sheet.surface->corner_of(t, vertex), first = v[(k + 1) % 3], second = v[(k + 2) % 3];
    round.push_back({t, {first, second}, {row(*sheet.x, first), row(*sheet.x, second)}});
  }
}

// Adds pairs of triangles that share a vertex and cross; the triangles `round` are those of one vertex.
void add_round_vertex(const std::vector<RoundVertex>& round, const std::vector<FacePlane>& planes,
                      std::vector<Candidate>& found) {
  for (std::size_t i = 0; i < round.size(); ++i)
    for (std::size_t j = i + 1; j < round.size(); ++j) {
      const RoundVertex &a = round[i], &b = round[j];
      const bool common_edge = (a.vertex[0] == b.vertex[0]) | (a.vertex[0] == b.vertex[1]) |
                               (a.vertex[1] == b.vertex[0]) | (a.vertex[1] == b.vertex[1]);
      if (common_edge || surely_on_one_side(planes[a.triangle], b.at) || surely_on_one_side(planes[b.triangle], a.at))
        continue;
      found.push_back({0, std::min(a.triangle, b.triangle), std::max(a.triangle, b.triangle)});
    }
}

void add_round_vertices(const SheetView& sheet, const std::vector<FacePlane>& planes, std::vector<Candidate>& result) {
  constexpr int chunk = 256;
  const int vertices = sheet.surface->vertex_count, chunks = (vertices + chunk - 1) / chunk;
  PartLists<Candidate> lists(static_cast<std::size_t>(chunks));
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < chunks; ++i) {
    std::vector<RoundVertex> round;
    for (int v = i * chunk; v < std::min(vertices, (i + 1) * chunk); ++v) {
      list_round_vertex(sheet, v, round);
      add_round_vertex(round, planes, lists[static_cast<std::size_t>(i)]);
    }
  }
  for (const auto& list : lists) result.insert(result.end(), list.begin(), list.end());
}

std::vector<Candidate> candidates(std::span<const SheetView> sheets) {
  std::vector<Candidate> result;
  std::vector<Box> boxes;
  Bvh built, other_built;
  const auto tree_of = [&](const SheetView& sheet, Bvh& place) -> const Bvh& {
    if (sheet.tree) return *sheet.tree;
    triangle_boxes(*sheet.surface, *sheet.x, *sheet.x, 0, boxes);
    return place = build_bvh(boxes);
  };
  PartLists<Candidate> lists;
  const Bvh& own = tree_of(sheets[0], built);
  const std::vector<FacePlane> planes = face_planes(sheets[0]);
  add_round_vertices(sheets[0], planes, result);
  for (int k = 0; k < static_cast<int>(sheets.size()); ++k) {
    const Bvh& other = k == 0 ? own : tree_of(sheets[k], other_built);
    const std::vector<FacePlane> other_planes = k == 0 ? std::vector<FacePlane>() : face_planes(sheets[k]);
    const std::vector<FacePlane>& planes_b = k == 0 ? planes : other_planes;
    const bool knows_quiet = k == 0 && sheets[0].tree && sheets[0].quiet;
    const BvhTraversal traversal{own, other, k == 0, knows_quiet ? sheets[0].quiet : nullptr};
    gather_pairs(traversal, lists, result, [&](int a, int b, std::vector<Candidate>& found) {
      if (k == 0 && share_vertex(sheets[0].surface->triangles, a, b)) return;  // add_round_vertices
      if (!may_meet(sheets[0], planes[a], a, sheets[k], planes_b[b], b)) return;
      found.push_back(k == 0 ? Candidate{0, std::min(a, b), std::max(a, b)} : Candidate{k, a, b});
    });
  }
  return result;
}

auto key(const Crossing& c) { return std::tie(c.edge_sheet, c.edge, c.face_sheet, c.face); }
auto key(const Segment& s) { return std::tie(s.sheet, s.triangle); }

// Sorts and numbers the crossings. Segment ends, which are indices of `all`, become these numbers.
void number_crossings(std::vector<Crossing>& all, Segments& found) {
  found.crossings = all;
  std::ranges::sort(found.crossings, [](const Crossing& a, const Crossing& b) { return key(a) < key(b); });
  found.crossings.erase(std::unique(found.crossings.begin(), found.crossings.end()), found.crossings.end());
  for (Segment& segment : found.segments)
    for (int& end : segment.end) {
      if (end < 0) continue;
      const auto at = std::lower_bound(found.crossings.begin(), found.crossings.end(), all[end],
                                       [](const Crossing& a, const Crossing& b) { return key(a) < key(b); });
      end = static_cast<int>(at - found.crossings.begin());
    }
}

}  // namespace

Segments find_segments(std::span<const SheetView> sheets) {
  std::vector<int> first_rank{0};
  for (const SheetView& sheet : sheets) first_rank.push_back(first_rank.back() + sheet.surface->vertex_count);
  const std::vector<Candidate> tested = candidates(sheets);
  const int count = static_cast<int>(tested.size());
  std::vector<std::optional<PairResult>> results(tested.size());
  StopPoll stop;
#pragma omp parallel for schedule(dynamic, 256)
  for (int i = 0; i < count; ++i) {
    if (stop.wanted()) continue;
    const Candidate& pair = tested[i];
    PairResult result =
        cross(sheets, make_face(sheets, first_rank, 0, pair.a), make_face(sheets, first_rank, pair.sheet, pair.b));
    if (!result.crossings.empty() || result.touching) results[i] = std::move(result);
  }
  stop.check();

  Segments found;
  std::vector<Crossing> all;
  for (int i = 0; i < count; ++i) {
    if (!results[i]) continue;
    const Candidate& pair = tested[i];
    const PairResult& result = *results[i];
    if (result.touching) {
      found.touching.push_back({pair.a, pair.sheet, pair.b});
      continue;
    }
    const int first = static_cast<int>(all.size());
    all.insert(all.end(), result.crossings.begin(), result.crossings.end());
    const bool at_vertex = result.shared_vertex >= 0;
    found.segments.push_back({{0, pair.sheet},
                              {pair.a, pair.b},
                              {at_vertex ? ~result.shared_vertex : first, at_vertex ? first : first + 1}});
  }
  std::ranges::sort(found.segments, [](const Segment& a, const Segment& b) { return key(a) < key(b); });
  std::sort(found.touching.begin(), found.touching.end());
  number_crossings(all, found);
  return found;
}

Vec3 point_of(std::span<const SheetView> sheets, const Crossing& c) {
  const Surface& surface = *sheets[c.edge_sheet].surface;
  const Points& x = *sheets[c.edge_sheet].x;
  return (1 - c.s) * row(x, surface.edges(c.edge, 0)) + c.s * row(x, surface.edges(c.edge, 1));
}

Vec3 end_point(std::span<const SheetView> sheets, const Segments& found, const Segment& segment, int end) {
  const int at = segment.end[end];
  return at < 0 ? row(*sheets[segment.sheet[0]].x, ~at) : point_of(sheets, found.crossings[at]);
}

int intersecting_pairs(const Segments& found) {
  return static_cast<int>(found.touching.size()) +
         static_cast<int>(std::ranges::count_if(found.segments, [](const Segment& s) { return !s.at_vertex(); }));
}

}  // namespace selvedge
