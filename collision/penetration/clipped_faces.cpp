#include "collision/penetration/clipped_faces.hpp"

#include <algorithm>
#include <tuple>

namespace selvedge {
namespace {

// A place on an edge, s of the way from its lower vertex to the higher one, where the count rises by `step`.
struct EdgeStep {
  int edge;
  double s;
  CurvePoint at;
  int step;
  auto key() const { return std::tie(edge, s, at, step); }
};

struct CountedRun {
  int face;
  CurvePoint from, to;
  int times;
};

std::vector<EdgeStep> steps_of(const Surface& surface, const std::vector<Crossing>& crossings,
                               const CountedPart& part) {
  std::vector<EdgeStep> steps;
  for (const auto& [curve, times] : part.curves)
    for (const CurveCut& cut : curve->cuts) {
      const double s = cut.at >= 0 ? crossings[cut.at].s : surface.edges(cut.edge, 0) == ~cut.at ? 0.0 : 1.0;
      steps.push_back({cut.edge, s, cut.at, times * cut.jump});
    }
  std::sort(steps.begin(), steps.end(), [](const EdgeStep& a, const EdgeStep& b) { return a.key() < b.key(); });
  return steps;
}

std::vector<CountedRun> runs_of(const CountedPart& part) {
  std::vector<CountedRun> runs;
  for (const auto& [curve, times] : part.curves) {
    for (const CurveRun& run : curve->runs) runs.push_back({run.face, run.from, run.to, times});
    for (const int face : curve->passed) runs.push_back({face, 0, 0, 0});
  }
  std::stable_sort(runs.begin(), runs.end(), [](const CountedRun& a, const CountedRun& b) { return a.face < b.face; });
  return runs;
}

// The corners of a face, in reverse order if the face is turned.
std::array<int, 3> turned_corners(const ClosedSurface& closed, int face) {
  return closed.turn[face] > 0 ? std::array{0, 1, 2} : std::array{0, 2, 1};
}

using Weights = std::array<double, 3>;

// Sums integrals over the areas to the left of closed polygons, each times `times` (Green's theorem).
struct GreenSum {
  int b, c;  // the corners whose barycentric coordinates are u and v
  double one = 0, u = 0, v = 0;

  void add(const Weights& from, const Weights& to, int times) {
    const double u0 = from[b], v0 = from[c], u1 = to[b], v1 = to[c], rise = times * (v1 - v0);
    one += 0.5 * rise * (u0 + u1);
    u += rise * (u0 * u0 + u0 * u1 + u1 * u1) / 6;
    v += rise * (2 * u0 * v0 + u0 * v1 + u1 * v0 + 2 * u1 * v1) / 6;
  }
};

class FaceClipper {
 public:
  FaceClipper(const ClosedSurface& closed, const std::vector<Crossing>& crossings, const std::vector<EdgeStep>& steps,
              const std::vector<int>& count, ClippedPart& result)
      : closed_(closed),
        surface_(closed.surface),
        crossings_(crossings),
        steps_(steps),
        count_(count),
        result_(result) {}

  void clip(int face, std::span<const CountedRun> runs) {
    const std::array<int, 3> corner = turned_corners(closed_, face);
    GreenSum sum{corner[1], corner[2]};
    for (int k = 0; k < 3; ++k) follow_edge(face, corner[k], corner[(k + 1) % 3], sum);
    for (const CountedRun& run : runs) add(face, run.from, run.to, run.times, sum);
    ClippedFace clipped{face, false, {}};
    clipped.moment[corner[0]] = sum.one - sum.u - sum.v;
    clipped.moment[corner[1]] = sum.u;
    clipped.moment[corner[2]] = sum.v;
    result_.faces.push_back(clipped);
  }

 private:
  void add(int face, CurvePoint from, CurvePoint to, int times, GreenSum& sum) {
    if (times == 0 || from == to) return;
    sum.add(weights_in(surface_, crossings_, face, from), weights_in(surface_, crossings_, face, to), times);
    result_.pieces.push_back({face, from, to, times});
  }

  void follow_edge(int face, int from, int to, GreenSum& sum) {
    const int edge = surface_.triangle_edges(face, to == (from + 1) % 3 ? from : to);
    const auto [first, last] = std::equal_range(steps_.begin(), steps_.end(), EdgeStep{edge, 0, 0, 0},
                                                [](const EdgeStep& a, const EdgeStep& b) { return a.edge < b.edge; });
    const int start = surface_.triangles(face, from), end = surface_.triangles(face, to);
    const bool boundary = surface_.edge_triangles[edge][1] < 0;
    int times = count_[start];
    CurvePoint at = ~start;
    const auto pass = [&](const EdgeStep& step, int sign) {
      if (boundary && times != 0) result_.at_boundary = true;
      add(face, at, step.at, times, sum);
      times += sign * step.step;
      at = step.at;
    };
    if (start < end)
      for (auto step = first; step != last; ++step) pass(*step, 1);
    else
      for (auto step = last; step != first;) pass(*--step, -1);
    if (boundary && times != 0) result_.at_boundary = true;
    add(face, at, ~end, times, sum);
  }

  const ClosedSurface& closed_;
  const Surface& surface_;
  const std::vector<Crossing>& crossings_;
  const std::vector<EdgeStep>& steps_;
  const std::vector<int>& count_;
  ClippedPart& result_;
};

bool has_boundary(const Surface& surface, int face) {
  for (int k = 0; k < 3; ++k)
    if (surface.edge_triangles[surface.triangle_edges(face, k)][1] < 0) return true;
  return false;
}

}  // namespace

ClippedPart clip_faces(const ClosedSurface& closed, const std::vector<Crossing>& crossings, const CountedPart& part,
                       std::vector<int>& count, std::vector<char>& cut) {
  const Surface& surface = closed.surface;
  ClippedPart result;
  const std::vector<EdgeStep> steps = steps_of(surface, crossings, part);
  const std::vector<CountedRun> runs = runs_of(part);
  for (const auto& [vertex, times] : part.vertices) count[vertex] = times;
  FaceClipper clipper(closed, crossings, steps, count, result);
  for (std::size_t first = 0, last = 0; first < runs.size(); first = last) {
    while (last < runs.size() && runs[last].face == runs[first].face) ++last;
    cut[runs[first].face] = 1;
    clipper.clip(runs[first].face, std::span(runs).subspan(first, last - first));
  }
  for (const auto& [vertex, times] : part.vertices)
    for (const int t : surface.triangles_of(vertex)) {
      if (cut[t] || surface.triangles(t, 0) != vertex || times == 0) continue;
      result.faces.push_back({t, true, {times / 6.0, times / 6.0, times / 6.0}});
      result.at_boundary |= has_boundary(surface, t);
    }
  for (const auto& [vertex, times] : part.vertices) count[vertex] = 0;
  for (const CountedRun& run : runs) cut[run.face] = 0;
  return result;
}

std::array<double, 3> weights_in(const Surface& surface, const std::vector<Crossing>& crossings, int face,
                                 CurvePoint at) {
  std::array<double, 3> weight{};
  if (at < 0) {
    weight[surface.corner_of(face, ~at)] = 1;
    return weight;
  }
  const Crossing& c = crossings[at];
  if (c.face == face) return c.weight;
  weight[surface.corner_of(face, surface.edges(c.edge, 0))] = 1 - c.s;
  weight[surface.corner_of(face, surface.edges(c.edge, 1))] = c.s;
  return weight;
}

Vec3 position_of(const Surface& surface, const Points& x, const std::vector<Crossing>& crossings, CurvePoint at) {
  if (at < 0) return row(x, ~at);
  const Crossing& c = crossings[at];
  return (1 - c.s) * row(x, surface.edges(c.edge, 0)) + c.s * row(x, surface.edges(c.edge, 1));
}

}  // namespace selvedge
