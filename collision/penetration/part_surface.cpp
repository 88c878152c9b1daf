#include "collision/penetration/part_surface.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "collision/contour/lockstep_flood.hpp"
#include "collision/geometry/corners.hpp"

namespace selvedge {
namespace {

struct OrderedCut {
  int edge;
  double s;
  CurvePoint at;
  int jump, curve;
  auto key() const { return std::tie(edge, s, at, curve, jump); }
};

std::vector<OrderedCut> ordered_cuts(const PartingSpace& space, std::span<const SurfaceCurve* const> curves) {
  std::vector<OrderedCut> cuts;
  const Edges& edges = space.closed.surface.edges;
  for (int i = 0; i < static_cast<int>(curves.size()); ++i)
    for (const CurveCut& cut : curves[i]->cuts) {
      const double s = cut.at >= 0 ? space.crossings[cut.at].s : edges(cut.edge, 0) == ~cut.at ? 0.0 : 1.0;
      cuts.push_back({cut.edge, s, cut.at, cut.jump, i});
    }
  std::sort(cuts.begin(), cuts.end(), [](const OrderedCut& a, const OrderedCut& b) { return a.key() < b.key(); });
  return cuts;
}

// Shuts edges and marks cut faces; the destructor clears both.
class Marks {
 public:
  Marks(PartingSpace& space, std::span<const SurfaceCurve* const> curves) : space_(space), curves_(curves) { set(1); }
  ~Marks() {
    set(0);
    for (const int edge : edges_) space_.shut[edge] = 0;
  }
  Marks(const Marks&) = delete;
  Marks& operator=(const Marks&) = delete;
  void shut(int edge) {
    space_.shut[edge] = 1;
    edges_.push_back(edge);
  }
  int faces() const { return faces_; }  // how many are cut

 private:
  void set(char mark) {
    faces_ = 0;
    const auto one = [&](int face) {
      faces_ += space_.cut[face] != mark;
      space_.cut[face] = mark;
    };
    for (const SurfaceCurve* curve : curves_) {
      for (const CurveRun& run : curve->runs) one(run.face);
      for (const int face : curve->passed) one(face);
    }
  }
  PartingSpace& space_;
  std::span<const SurfaceCurve* const> curves_;
  std::vector<int> edges_;
  int faces_ = 0;
};

constexpr int right_of(int curve) { return 2 * curve; }
constexpr int left_of(int curve) { return 2 * curve + 1; }

// For a curve inside one face, which crosses no edge. The part round it is found along the line from the curve to the
// face's first corner.
void join_round(const PartingSpace& space, std::span<const SurfaceCurve* const> curves, int i, LockstepFlood& flood) {
  const Surface& surface = space.closed.surface;
  const int face = curves[i]->runs.front().face;
  const bool turned = space.closed.turn[face] < 0;
  const auto flat = [&](CurvePoint at) {
    const std::array<double, 3> w = weights_in(surface, space.crossings, face, at);
    return turned ? Vec2(w[2], w[1]) : Vec2(w[1], w[2]);
  };
  Vec2 start = flat(curves[i]->runs.front().from);
  double area = 0;
  for (const CurveRun& run : curves[i]->runs) {
    const Vec2 p = flat(run.from), q = flat(run.to);
    area += cross(p, q);
    if (p.sum() < start.sum()) start = p;
  }
  const int outer = area > 0 ? right_of(i) : left_of(i);
  int met = -1;
  double nearest = 1;
  for (int other = 0; other < static_cast<int>(curves.size()); ++other) {
    if (other == i) continue;
    for (const CurveRun& run : curves[other]->runs) {
      if (run.face != face) continue;
      const Vec2 p = flat(run.from), along = flat(run.to) - p;
      const auto side = [&](const Vec2& at) { return cross(along, at - p); };
      const double here = side(start), there = side(Vec2::Zero());
      const double first = cross(start, p), last = first + start.x() * along.y() - start.y() * along.x();
      if ((here > 0) == (there > 0) || (first > 0) == (last > 0)) continue;
      const double share = here / (here - there);
      if (share >= nearest) continue;
      nearest = share;
      met = here > 0 ? left_of(other) : right_of(other);
    }
  }
  if (met >= 0)
    flood.join(outer, met);
  else
    flood.seed(surface.triangles(face, 0), outer);
}

// Makes two fronts for each curve, for its right and its left; cut edges seed and join them.
void start_fronts(const PartingSpace& space, std::span<const SurfaceCurve* const> curves, Marks& marks,
                  LockstepFlood& flood) {
  const int count = static_cast<int>(curves.size());
  for (int i = 0; i < 2 * count; ++i) flood.add_front();
  const std::vector<OrderedCut> cuts = ordered_cuts(space, curves);
  const auto before = [](const OrderedCut& cut) { return cut.jump > 0 ? right_of(cut.curve) : left_of(cut.curve); };
  const auto after = [](const OrderedCut& cut) { return cut.jump > 0 ? left_of(cut.curve) : right_of(cut.curve); };
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const int edge = cuts[i].edge;
    if (i == 0 || cuts[i - 1].edge != edge) {
      marks.shut(edge);
      flood.seed(space.closed.surface.edges(edge, 0), before(cuts[i]));
    }
    if (i + 1 == cuts.size() || cuts[i + 1].edge != edge)
      flood.seed(space.closed.surface.edges(edge, 1), after(cuts[i]));
    else
      flood.join(after(cuts[i]), before(cuts[i + 1]));
  }
  for (int i = 0; i < count; ++i)
    if (curves[i]->cuts.empty()) join_round(space, curves, i, flood);
}

std::vector<int> with_one_part(LockstepFlood& flood, int curves) {
  std::vector<int> found;
  for (int i = 0; i < curves; ++i)
    if (flood.root(right_of(i)) == flood.root(left_of(i))) found.push_back(i);
  return found;
}

// Colours of the fronts, different on both sides of each curve, 0 at `start`; empty if there is no such colouring.
std::vector<int> colours_beside(LockstepFlood& flood, int curves, int start) {
  std::vector<std::array<int, 2>> joined;
  for (int i = 0; i < curves; ++i) joined.push_back({flood.root(right_of(i)), flood.root(left_of(i))});
  return two_colours(flood.count(), joined, start);
}

int whole_faces(const PartingSpace& space, const std::vector<int>& vertices) {
  int corners = 0;
  for (const int v : vertices)
    for (const int t : space.closed.surface.triangles_of(v)) corners += !space.cut[t];
  return corners / 3;
}

double face_area(const PartingSpace& space, int face) {
  return 0.5 * twice_area(space.closed.surface.triangles, space.x, face).norm();
}

// The counted area (area times count) as a fraction of the component's area.
double share_of_area(PartingSpace& space, int component, const CountedPart& part) {
  const Surface& surface = space.closed.surface;
  if (space.component_area.empty()) {
    space.component_area.assign(static_cast<std::size_t>(surface.component_count), 0);
    for (int t = 0; t < surface.triangles.rows(); ++t)
      space.component_area[surface.component[surface.triangles(t, 0)]] += face_area(space, t);
  }
  std::vector<char> cut(space.cut.size(), 0);
  double sum = 0;
  for (const ClippedFace& clipped : clip_faces(space.closed, space.crossings, part, space.count, cut).faces)
    sum += 2 * clipped.covered() * face_area(space, clipped.face);
  const double all = space.component_area[component];
  return all > 0 ? sum / all : 0;
}

// The vertices of the fronts with another level than `base`, with the difference.
std::vector<std::pair<int, int>> listed_levels(LockstepFlood& flood, const std::vector<int>& level, int base) {
  std::vector<std::pair<int, int>> listed;
  for (int f = 0; f < flood.count(); ++f)
    if (flood.root(f) == f && level[f] != base)
      for (const int v : flood.reached(f)) listed.emplace_back(v, level[f] - base);
  return listed;
}

// Is the part with colour 1 the larger one?
bool odd_is_larger(PartingSpace& space, std::span<const SurfaceCurve* const> curves, int cut_faces,
                   const std::vector<int>& colour, LockstepFlood& flood) {
  const int component = curves.front()->component;
  int odd = 0;
  for (int f = 0; f < flood.count(); ++f)
    if (flood.root(f) == f && colour[f] == 1) odd += whole_faces(space, flood.reached(f));
  const int even = space.closed.component_faces[component] - cut_faces - odd;
  if (odd != even && space.smaller == SmallerSide::faces) return odd > even;
  CountedPart part{listed_levels(flood, colour, 0), {}};
  for (int i = 0; i < static_cast<int>(curves.size()); ++i)
    part.curves.emplace_back(curves[i], colour[flood.root(left_of(i))] == 1 ? 1 : -1);
  return share_of_area(space, component, part) > 0.5;
}

}  // namespace

PartingSpace::PartingSpace(const ClosedSurface& surface, const Points& positions, const std::vector<Crossing>& found,
                           SmallerSide side)
    : closed(surface), x(positions), crossings(found), smaller(side) {
  owner.assign(static_cast<std::size_t>(surface.surface.vertex_count), -1);
  count.assign(static_cast<std::size_t>(surface.surface.vertex_count), 0);
  shut.assign(static_cast<std::size_t>(surface.surface.edges.rows()), 0);
  cut.assign(static_cast<std::size_t>(surface.surface.triangles.rows()), 0);
}

std::optional<PartedTogether> part_together(PartingSpace& space, std::span<const SurfaceCurve* const> curves,
                                            std::vector<int>& culprits) {
  const int count = static_cast<int>(curves.size());
  Marks marks(space, curves);
  LockstepFlood flood(space.closed.surface, space.shut, space.owner);
  start_fronts(space, curves, marks, flood);
  culprits = with_one_part(flood, count);
  if (!culprits.empty()) return std::nullopt;
  const int open = flood.grow(1);
  culprits = with_one_part(flood, count);
  if (!culprits.empty()) return std::nullopt;
  const std::vector<int> colour = colours_beside(flood, count, open);
  if (colour.empty()) return std::nullopt;
  const int inner = odd_is_larger(space, curves, marks.faces(), colour, flood) ? 0 : 1;
  if (open >= 0 && inner == 0) flood.grow(0);

  PartedTogether parted;
  std::vector<int> number(static_cast<std::size_t>(flood.count()), -1);
  for (int i = 0; i < count; ++i) {
    const int left = flood.root(left_of(i)), inside = colour[left] == inner ? left : flood.root(right_of(i));
    parted.inside.push_back(inside == left ? 1 : -1);
    if (number[inside] < 0) {
      number[inside] = static_cast<int>(parted.patch_vertices.size());
      parted.patch_vertices.push_back(flood.reached(inside));
    }
    parted.patch.push_back(number[inside]);
  }
  return parted;
}

namespace {

// Edges that a curve crosses more often in one direction than in the other, with the difference; sorted.
std::vector<std::pair<int, int>> net_jumps(const SurfaceCurve& curve) {
  std::vector<std::pair<int, int>> all, net;
  for (const CurveCut& cut : curve.cuts) all.emplace_back(cut.edge, cut.jump);
  std::sort(all.begin(), all.end());
  for (const auto& [edge, jump] : all)
    if (!net.empty() && net.back().first == edge)
      net.back().second += jump;
    else
      net.emplace_back(edge, jump);
  std::erase_if(net, [](const auto& edge_jump) { return edge_jump.second == 0; });
  return net;
}

// A level for each front: 0 at `start`, higher by the jump at an edge's higher vertex; empty if the jumps contradict.
std::vector<int> levels_of(const Surface& surface, const std::vector<std::pair<int, int>>& jumps, LockstepFlood& flood,
                           int start) {
  struct Step {
    int to, rise;
  };
  std::vector<std::vector<Step>> beside(static_cast<std::size_t>(flood.count()));
  for (const auto& [edge, jump] : jumps) {
    const int low = flood.front_of(surface.edges(edge, 0)), high = flood.front_of(surface.edges(edge, 1));
    beside[low].push_back({high, jump});
    beside[high].push_back({low, -jump});
  }
  std::vector<int> level(beside.size(), 0);
  std::vector<char> known(beside.size(), 0);
  known[start] = 1;
  for (std::vector<int> stack{start}; !stack.empty();) {
    const int at = stack.back();
    stack.pop_back();
    for (const auto& [to, rise] : beside[at]) {
      if (known[to] && level[to] != level[at] + rise) return {};
      if (known[to]) continue;
      known[to] = 1;
      level[to] = level[at] + rise;
      stack.push_back(to);
    }
  }
  return level;
}

// The level that most of the component has.
int base_level(PartingSpace& space, const SurfaceCurve& curve, int cut_faces, LockstepFlood& flood,
               const std::vector<int>& level) {
  const int whole = space.closed.component_faces[curve.component] - cut_faces;
  long sum = 0;
  for (int f = 0; f < flood.count(); ++f)
    if (flood.root(f) == f && level[f] != 0) sum += long{level[f]} * whole_faces(space, flood.reached(f));
  const bool even = whole == 0 || (2 * sum % whole == 0 && 2 * sum / whole % 2 != 0);
  if (space.smaller == SmallerSide::faces && !even)
    return static_cast<int>(std::floor(static_cast<double>(sum) / whole + 0.5));
  const CountedPart part{listed_levels(flood, level, 0), {{&curve, 1}}};
  return static_cast<int>(std::ceil(share_of_area(space, curve.component, part) - 0.5));
}

}  // namespace

std::optional<std::vector<std::pair<int, int>>> part_alone(PartingSpace& space, const SurfaceCurve& curve) {
  const Surface& surface = space.closed.surface;
  const SurfaceCurve* const one = &curve;
  Marks marks(space, std::span(&one, 1));
  LockstepFlood flood(surface, space.shut, space.owner);
  const std::vector<std::pair<int, int>> jumps = net_jumps(curve);
  for (const auto& [edge, jump] : jumps) marks.shut(edge);
  for (const auto& [edge, jump] : jumps)
    for (int k = 0; k < 2; ++k)
      if (flood.front_of(surface.edges(edge, k)) < 0) flood.seed(surface.edges(edge, k), flood.add_front());
  if (jumps.empty()) flood.seed(surface.triangles(curve.runs.front().face, 0), flood.add_front());
  const int open = flood.grow(1);
  const std::vector<int> level = levels_of(surface, jumps, flood, flood.root(open >= 0 ? open : 0));
  if (level.empty()) return std::nullopt;
  const int base = base_level(space, curve, marks.faces(), flood, level);
  if (open >= 0 && base != 0) flood.grow(0);  // the open front is listed too
  return listed_levels(flood, level, base);
}

}  // namespace selvedge
