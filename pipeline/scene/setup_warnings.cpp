#include "pipeline/scene/setup_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "collision/distance/signed_distance.hpp"
#include "collision/geometry/box_diagonal.hpp"
#include "collision/geometry/counted.hpp"

namespace selvedge {
namespace {

constexpr double storm = 120;  // [m/s]

// How many of the points have a coordinate that a float misses by more than half of `step` [m].
int coarser_than(double step, const Points& x) {
  int count = 0;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const auto largest = static_cast<float>(x.row(v).cwiseAbs().maxCoeff());
    count += std::nextafter(largest, std::numeric_limits<float>::infinity()) - largest > step;
  }
  return count;
}

}  // namespace

void warn_of_thickness(const Scene& scene, std::vector<std::string>& warnings) {
  int thin = 0, flat = 0;
  for (const RestTriangle& triangle : scene.rest_triangle) {
    const double altitude = smallest_altitude(triangle);
    if (altitude * altitude <= 2e-9 * area(triangle))  // a billionth of the longest edge
      ++flat;
    else if (altitude < scene.contact.thickness)
      ++thin;
  }
  if (flat > 0)
    warnings.push_back(counted(flat, "triangle") + " of zero rest area, which " + by_number(flat, "resists", "resist") +
                       " no stretch");
  if (thin > 0 && scene.contact.self)
    warnings.push_back(fmt::format("contact.thickness {} m is larger than the smallest altitude of {}",
                                   scene.contact.thickness, counted(thin, "triangle")));
}

void warn_of_rounding(const Scene& scene, const Points& x, const std::vector<Points>& obstacles,
                      std::vector<std::string>& warnings) {
  const double step = 0.1 * scene.contact.thickness;
  int count = coarser_than(step, x);
  for (const Points& obstacle : obstacles) count += coarser_than(step, obstacle);
  if (count > 0)
    warnings.push_back(fmt::format(
        "{} so far from the origin that stored positions are rounded by more than a tenth of "
        "contact.thickness; move the scene to the origin by `translate`, or give a larger contact.thickness",
        counted(count, "vertex is", "vertices are")));
}

void warn_of_pins_inside(const std::vector<ClothPart>& parts, const Scene& scene, const Points& x,
                         const std::vector<Points>& obstacles, std::vector<std::string>& warnings) {
  if (std::ranges::all_of(parts, [](const ClothPart& part) { return part.pins.empty(); })) return;
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const Surface& surface = scene.obstacles[k].surface;
    if (!is_closed(surface) || !obstacles[k].allFinite()) continue;
    DistanceField field(surface, BodyShape::raw);
    field.move_to(obstacles[k]);
    for (std::size_t c = 0; c < parts.size(); ++c)
      for (const PinPart& pin : parts[c].pins) {
        const Points at =
            Points(x.middleRows(scene.cloths[c].first_vertex, scene.cloths[c].vertex_count))(pin.vertices, Eigen::all);
        // Those on the surface, as garments that are sewn to a body have them, are where they belong.
        const auto deep = [&](const SignedDistance& one) { return one.value < -scene.contact.thickness; };
        if (const auto count = std::ranges::count_if(field.ask(at), deep); count > 0)
          warnings.push_back(
              fmt::format("{} {} of cloth `{}` {} inside the obstacle `{}`: where it does not move away, {} there",
                          counted(count, "pin"), pin.name, parts[c].name, by_number(count, "is", "are"),
                          scene.obstacles[k].name, by_number(count, "it stays", "they stay")));
      }
  }
}

void warn_of_fast_pins(const std::vector<ClothPart>& parts, double fps, int frames,
                       std::vector<std::string>& warnings) {
  for (const ClothPart& part : parts) {
    const double size = box_diagonal(part.rest);
    for (const PinPart& pin : part.pins) {
      if (!pin.keyed) continue;
      Points before = pin.at(0);
      for (int frame = 1; frame <= frames; ++frame) {
        const Points now = pin.at(frame / fps);
        const double way = (now - before).rowwise().norm().maxCoeff();
        if (way > size) {
          warnings.push_back(fmt::format(
              "pins {} of cloth `{}` move {:.3g} m in frame {}, and the cloth is {:.3g} m large: it cannot follow, and "
              "its steps take long; give the motion more time",
              pin.name, part.name, way, frame, size));
          break;
        }
        before = now;
      }
    }
  }
}

void warn_of_storm(const std::vector<Vec3>& wind, std::vector<std::string>& warnings) {
  double most = 0;
  for (const Vec3& one : wind) most = std::max(most, one.norm());
  if (most > storm)
    warnings.push_back(
        fmt::format("wind of {:.4g} m/s is faster than any storm: steps take long; `velocity` is in m/s", most));
}

}  // namespace selvedge
