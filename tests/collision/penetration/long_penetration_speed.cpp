#include <catch2/catch.hpp>

#include <ctime>

#include "collision/contour/find_contours.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "collision/penetration/penetration_loss.hpp"
#include "collision/penetration/winding_loss.hpp"
#include "tests/collision/penetration/closed_shapes.hpp"

namespace selvedge::long_penetration_speed {

using namespace closed;

TEST_CASE("penetration: time at 24,000 triangles and some hundred pairs", "[penetration][.long]") {
  // A dress of 120 x 100 quads, dented here and there from one side through the other.
  const Solid dress = rings(120, 101, [](int j, double angle) {
    const double z = 0.012 * j;
    double in = 0;
    for (const double at : {0.15, 0.45, 0.8, 1.1})
      in += 0.615 * std::exp(-90 * (z - at) * (z - at) - 9 * std::pow(std::remainder(angle - 3 * at, 6.2831853), 2));
    return Vec3((0.3 - in) * std::cos(angle) + 0.001 * std::sin(50 * angle), (0.3 - in) * std::sin(angle),
                z + 0.002 * std::sin(7 * angle));
  });
  const ClosedSurface closed = close_surface(dress.surface());
  const Points x = closed_positions(closed, dress.x);
  const SheetView sheet{&closed.surface, &x};
  const Segments segments = penetration_segments(closed, find_segments(std::span(&sheet, 1)));
  // Of all threads together, so that what else runs does not count, and by the clock [ms].
  const auto time_of = [](const auto& work) {
    double best = 1e9, by_clock = 1e9;
    for (int i = 0; i < 9; ++i) {
      const std::clock_t start = std::clock();
      Stopwatch watch;
      work();
      by_clock = std::min(by_clock, 1e3 * watch.lap());
      best = std::min(best, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return std::to_string(best) + " ms of one core, " + std::to_string(by_clock) + " ms by the clock";
  };
  Points gradient;
  Penetration found;
  const std::string volume = time_of([&] {
    found = find_penetration(closed, x, segments, trace_contours(std::span(&sheet, 1), segments));
    penetration_loss(closed, x, found, {}, &gradient);
  });
  WindingReport report;
  const std::string winding = time_of([&] { report = winding_loss(closed, x, segments, {}, &gradient); });
  const std::string detection = time_of([&] { find_segments(std::span(&sheet, 1)); });
  WARN(segments.segments.size() << " pairs, " << found.contours.size() << " contours, " << found.regions.size()
                                << " regions: " << volume << "; winding of " << report.faces << " faces " << winding
                                << "; detection " << detection);
  CHECK(found.regions.size() > 0);
}

}  // namespace selvedge::long_penetration_speed
