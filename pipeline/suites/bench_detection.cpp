#include "pipeline/suites/bench_detection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "collision/geometry/stopwatch.hpp"
#include "collision/geometry/surface.hpp"
#include "collision/search/intersections.hpp"
#include "collision/search/obstacle.hpp"

namespace selvedge {
namespace {

constexpr double layer_length = 0.12, layer_gap = 0.004;
constexpr int our_repeats = 15, fcl_repeats = 3;

struct DetectionShape {
  std::string name;
  Triangles triangles;
  Points x;
};

DetectionShape shape(const std::string& name, int n, const std::function<Vec3(double, double)>& place) {
  DetectionShape s{name, Triangles(2 * n * n, 3), Points((n + 1) * (n + 1), 3)};
  for (int i = 0, t = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const int a = i * (n + 1) + j;
      s.x.row(a) = place(double(i) / n, double(j) / n).cast<float>().cast<double>().transpose();
      if (i == n || j == n) continue;
      s.triangles.row(t++) << a, a + 1, a + n + 1;
      s.triangles.row(t++) << a + 1, a + n + 2, a + n + 1;
    }
  return s;
}

Vec3 drape(double u, double v) {
  constexpr double radius = 0.2;
  const double out = std::hypot(u - 0.5, v - 0.5), angle = std::atan2(v - 0.5, u - 0.5);
  const double on_ball = std::min(out, 1.4 * radius), hanging = out - on_ball, polar = on_ball / radius;
  const double fold = 0.35 * hanging * std::sin(9 * angle), distance = radius * std::sin(polar) + 0.9 * fold;
  return {distance * std::cos(angle) - 0.3 * fold * std::sin(angle), radius * std::cos(polar) - 0.93 * hanging,
          distance * std::sin(angle) + 0.3 * fold * std::cos(angle)};
}

Vec3 pile(double u, double v, double wave) {
  constexpr double radius = layer_gap / 2, period = layer_length + std::numbers::pi * radius;
  const double layer = std::floor(u / period), along = u - layer * period;
  const double direction = std::fmod(layer, 2) == 0 ? 1 : -1, begin = direction > 0 ? 0 : layer_length;
  Vec3 p(begin + direction * std::min(along, layer_length), layer * layer_gap, v);
  if (along > layer_length) {
    const double turn = (along - layer_length) / radius;
    p += Vec3(direction * radius * std::sin(turn), radius - radius * std::cos(turn), 0);
  }
  return p + Vec3(0.01 * std::sin(9 * v + 2), 0.02 * std::sin(7 * v) + wave * std::sin(90 * u + 31 * v), 0);
}

// Shapes of n x n squares: `drape`, a sheet over a ball with hanging folds; `pile`, eight layers 4 mm apart with a
// crease between each two; `crossing`, the same with waves in which the layers pass through each other.
std::vector<DetectionShape> detection_shapes(int n) {
  return {shape("drape", n, drape), shape("pile", n, [](double u, double v) { return pile(u, v, 0.0004); }),
          shape("crossing", n, [](double u, double v) { return pile(u, v, 0.003); })};
}

template <class Run>
double median_seconds(int repeats, Run&& run) {
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) {
    Stopwatch watch;
    run(i);
    seconds.push_back(watch.lap());
  }
  std::nth_element(seconds.begin(), seconds.begin() + repeats / 2, seconds.end());
  return seconds[repeats / 2];
}

// Something for the refit to do, which leaves every pair as it is.
Points moved(const Points& x, int i) { return x.array() + 0x1p-4 * (i % 2); }

DetectionTiming time_shape(const DetectionShape& s) {
  const Surface surface = make_surface(static_cast<int>(s.x.rows()), s.triangles);
  const std::array<Points, 2> positions{moved(s.x, 0), moved(s.x, 1)};
  IntersectionCache cache;
  std::vector<std::pair<int, int>> ours = intersecting_pairs(surface, s.x, cache), fcl;
  DetectionTiming timing{s.name, static_cast<int>(s.triangles.rows()), static_cast<int>(ours.size()), 0, {}, 0};
  timing.ours =
      median_seconds(our_repeats, [&](int i) { ours = intersecting_pairs(surface, positions[1 - i % 2], cache); });
  if (!obstacle_available()) return timing;
  ObstacleModel model(s.triangles, s.x);
  timing.fcl = median_seconds(fcl_repeats, [&](int i) {
    model.refit(positions[1 - i % 2]);
    fcl = obstacle_self_pairs(model, s.triangles);
  });
  std::vector<std::pair<int, int>> other;
  std::set_symmetric_difference(ours.begin(), ours.end(), fcl.begin(), fcl.end(), std::back_inserter(other));
  timing.other_pairs = static_cast<int>(other.size());
  return timing;
}

}  // namespace

std::vector<DetectionTiming> time_detection() {
  std::vector<DetectionTiming> timings;
  for (const int n : {100, 200})
    for (const DetectionShape& s : detection_shapes(n)) timings.push_back(time_shape(s));
  return timings;
}

std::string detection_table(const std::vector<DetectionTiming>& timings) {
  std::string text = "self-detection of one cloth that has moved [ms]\n";
  text += fmt::format("{:<10} {:>10} {:>10} {:>10} {:>10} {:>22}\n", "shape", "triangles", "pairs", "selvedge", "FCL",
                      "found by one alone");
  for (const DetectionTiming& t : timings)
    text += fmt::format("{:<10} {:>10} {:>10} {:>10.2f} {:>10} {:>22}\n", t.shape, t.triangles, t.pairs, 1e3 * t.ours,
                        t.fcl ? fmt::format("{:.1f}", 1e3 * *t.fcl) : "left out",
                        t.fcl ? fmt::format("{}", t.other_pairs) : "");
  return text;
}

}  // namespace selvedge
