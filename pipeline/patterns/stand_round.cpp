#include "pipeline/patterns/stand_round.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

constexpr double floor_rounding = 0.01;  // [m]
constexpr double beside = 0.02;          // heights that differ by less count as equal [m]
constexpr double least_at_height = 1.0 / 3;
constexpr double least_between = 0.05;  // of the body's vertices at the panels' heights: arms may be elsewhere
constexpr int directions = 32;
constexpr double flat = 0.05;  // panels with less depth are on one side of the body, like capes [m]

struct Span {
  double low, high;
  bool has(double y) const { return y > low - beside && y < high + beside; }
  std::string text() const { return fmt::format("{:.2f} m to {:.2f} m", low, high); }
};

Span span_of(const Points& x, int axis) { return {x.col(axis).minCoeff(), x.col(axis).maxCoeff()}; }

// The convex hull of points seen from above, by its widest extents.
class Outline {
 public:
  explicit Outline(const Points& x) {
    for (int k = 0; k < directions; ++k) {
      const double angle = 2 * std::numbers::pi * k / directions;
      along_.emplace_back(std::cos(angle), 0, std::sin(angle));
      most_.push_back((x * along_.back()).maxCoeff());
    }
  }
  bool has(const Vec3& p) const {
    for (std::size_t k = 0; k < along_.size(); ++k)
      if (along_[k].dot(p) > most_[k]) return false;
    return true;
  }
  double width() const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < directions / 2; ++k) least = std::min(least, most_[k] + most_[k + directions / 2]);
    return least;
  }

 private:
  std::vector<Vec3> along_;
  std::vector<double> most_;
};

}  // namespace

double below_floor(const Points& body) {
  const double low = body.col(1).minCoeff();
  return low < -floor_rounding ? -low : 0;
}

void check_stands_round(const PatternMesh& mesh, const Points& body, const std::string& file) {
  const std::string where = file + ": panels",
                    cure =
                        "give a body that stands on the floor of the pattern, y = 0, and faces +z, in metres; check "
                        "`units_in_meter` and the panels' translations";
  const Span panels = span_of(mesh.placed, 1), heights = span_of(body, 1);
  long at_height = 0;
  for (Eigen::Index v = 0; v < mesh.placed.rows(); ++v) at_height += heights.has(mesh.placed(v, 1));
  if (static_cast<double>(at_height) < least_at_height * static_cast<double>(mesh.placed.rows()))
    throw Error(
        fmt::format("do not stand round the body: their heights are {}, the body's {}", panels.text(), heights.text()),
        where, cure);
  const Outline outline(mesh.placed);
  if (outline.width() < flat) return;
  long there = 0, between = 0;
  for (Eigen::Index v = 0; v < body.rows(); ++v) {
    if (!panels.has(body(v, 1))) continue;
    ++there;
    between += outline.has(row(body, static_cast<int>(v)));
  }
  if (static_cast<double>(between) >= least_between * static_cast<double>(std::max(there, 1L))) return;
  throw Error(
      fmt::format("do not stand round the body: they are at x from {}, z from {}, the body at x from {}, z from {}",
                  span_of(mesh.placed, 0).text(), span_of(mesh.placed, 2).text(), span_of(body, 0).text(),
                  span_of(body, 2).text()),
      where, cure);
}

}  // namespace selvedge
