#include <cmath>
#include <numbers>

#include "pipeline/validate/validate_strip.hpp"

// Large deflections under loads at the tip, without gravity (Sze, Liu and Lo 2004). The loads are terms of the
// potential, which no scene file has: a dead force is linear in the positions, a moment is a couple that is aimed anew
// as its grip turns.
namespace selvedge {
namespace {

constexpr double youngs_modulus = 1.2e6, thickness = 0.1, width = 1;  // theirs; h over L is theirs too
constexpr double pi = std::numbers::pi;

Material steel() { return plate_material(1, youngs_modulus * std::pow(thickness, 3) / 12, thickness, 0); }

std::vector<Measured> end_shear(const ValidationValues& values) {
  constexpr double length = 10, force = 4;
  const Strip strip =
      make_strip_scene(strip_shape(values, length, width), steel(), Vec3::UnitX(), -Vec3::UnitZ(), "clamp");
  const AddedTerm load = dead_load(line_forces(strip.start, strip.tip, force), 1);
  const Points x = settled(strip.scene, strip.start, load, force);
  const Vec3 moved = mean_of(x, strip.tip) - mean_of(strip.start, strip.tip);
  return {{"W of the tip", moved.y(), 6.698, Judged::relative, 0.02},
          {"-U of the tip", -moved.x(), 3.286, Judged::relative, 0.02}};
}

// A couple on the row of elements behind the tip: forces square to it as it lay when the couple was last aimed. Where
// it lies so at rest the couple is the moment.
struct Couple {
  const Strip& strip;
  Vec3 force = Vec3::Zero();  // on the grip, and its opposite on the tip

  Vec3 arm(const Points& x) const { return mean_of(x, strip.grip) - mean_of(x, strip.tip); }
  void aim(double moment, const Points& x) {
    const Vec3 d = arm(x);
    force = moment / d.squaredNorm() * Vec3(-d.y(), d.x(), 0);
  }
  void add_gradient(Points& gradient) const {
    for (const int v : strip.grip) gradient.row(v) -= force.transpose() / static_cast<double>(strip.grip.size());
    for (const int v : strip.tip) gradient.row(v) += force.transpose() / static_cast<double>(strip.tip.size());
  }
};

std::vector<Measured> end_moment(const ValidationValues& values) {
  constexpr double length = 12, full = 50 * pi / 3;
  StripShape shape = strip_shape(values, length, width);
  shape.grip = true;
  const Strip strip = make_strip_scene(shape, steel(), Vec3::UnitX(), -Vec3::UnitZ(), "clamp");
  Couple couple{strip};
  AddedTerm load;
  // Rolled up to a whole circle, a strip under such a couple can leave its plane without resistance; the answer is the
  // plane one, so that both rows at the tip are guided in it.
  std::vector<int> guided = strip.tip;
  guided.insert(guided.end(), strip.grip.begin(), strip.grip.end());
  const double guide = full * std::pow(shape.along / length, 2);  // [N/m]
  load.value = [&](const Points& x) {
    double energy = -couple.force.dot(couple.arm(x));
    for (const int v : guided) energy += 0.5 * guide * std::pow(x(v, 2) - strip.start(v, 2), 2);
    return energy;
  };
  load.add_derivatives = [&](const Points& x, Points& gradient, std::vector<ContactBlock>& blocks) {
    couple.add_gradient(gradient);
    for (const int v : guided) {
      gradient(v, 2) += guide * (x(v, 2) - strip.start(v, 2));
      blocks.push_back({{v, -1, -1, -1}, {1, 0, 0, 0}, Vec3::UnitZ(), guide, 0});
    }
  };
  Points x = strip.start;
  constexpr int parts = 16, most = 30;
  for (int part = 1; part <= most; ++part) {
    const double moment = values.number("turn") * full * std::min(1.0, part / double(parts));
    const Vec3 before = couple.arm(x);
    couple.aim(moment, x);
    x = settled(strip.scene, x, load, couple.force.norm());
    if (part > parts && (couple.arm(x) - before).norm() < 1e-4 * before.norm()) break;
  }
  // A circle's arc: the moment is M over B per width, the angle that times the length.
  const double angle = 2 * pi * values.number("turn"), radius = length / angle;
  const Vec3 tip = mean_of(x, strip.tip);
  const double gap = std::hypot(tip.x() - radius * std::sin(angle), tip.y() - radius * (1 - std::cos(angle)));
  return {{"tip off the arc / L", gap / length, 0, Judged::at_most, 0.02},
          {"-U of the tip", length - tip.x(), length - radius * std::sin(angle), Judged::relative, 0.02}};
}

}  // namespace

std::vector<ValidationCase> shell_cases() {
  return {{"end_shear", "a strip clamped at one end, a force at the other",
           strip_parameters({}, resolution_parameter("30,60", "30"), "one_diagonal,alternating,unstructured", "0,45"),
           end_shear},
          {"end_moment", "a strip clamped at one end, rolled up by a moment at the other",
           strip_parameters({{"turn", "1", "1", "part of a whole circle", {.low = 0, .high = 1, .low_in = false}}},
                            resolution_parameter("40", "40"), "alternating,unstructured", "0,45"),
           end_moment}};
}

}  // namespace selvedge
