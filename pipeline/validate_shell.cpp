#include <cmath>
#include <numbers>

#include "pipeline/validate_strip.hpp"

// Large deflections under loads at the tip, without gravity (Sze, Liu and Lo 2004). The loads are terms of the potential,
// which no scene file has: a dead force is linear in the positions, a moment is dead in the angle of its grip.
namespace selvedge {
namespace {

constexpr double youngs_modulus = 1.2e6, thickness = 0.1, width = 1;  // theirs; h over L is theirs too
constexpr double pi = std::numbers::pi;

Material steel() { return plate_material(1, youngs_modulus * std::pow(thickness, 3) / 12, thickness, 0); }

std::vector<Measured> end_shear(const ValidationValues& values) {
  constexpr double length = 10, force = 4;
  StripShape shape = strip_shape(values, length, width);
  shape.clamp = true;
  const Strip strip = make_strip_scene(shape, steel(), Vec3::UnitX(), -Vec3::UnitZ(), "clamp");
  const std::vector<double> shares = line_shares(strip.start, strip.tip);
  AddedTerm load;
  load.value = [&](const Points& x) {
    double work = 0;
    for (std::size_t k = 0; k < strip.tip.size(); ++k) work += force * shares[k] * x(strip.tip[k], 1);
    return -work;
  };
  load.add_derivatives = [&](const Points&, Points& gradient, std::vector<ContactBlock>&) {
    for (std::size_t k = 0; k < strip.tip.size(); ++k) gradient(strip.tip[k], 1) -= force * shares[k];
  };
  const Points x = settled(strip.scene, strip.start, load, force);
  const Vec3 moved = mean_of(x, strip.tip) - mean_of(strip.start, strip.tip);
  return {{"W of the tip", moved.y(), 6.698, Judged::relative, 0.02},
          {"-U of the tip", -moved.x(), 3.286, Judged::relative, 0.02}};
}

// The couple that turns the row of elements behind the tip about z, as far as its angle from the x axis goes; angles are
// followed from solve to solve, so that a whole turn is one.
struct Couple {
  const Strip& strip;
  double moment = 0, turned = 0;

  Vec3 arm(const Points& x) const { return mean_of(x, strip.grip) - mean_of(x, strip.tip); }
  double angle(const Points& x) const {
    const Vec3 d = arm(x);
    return turned + std::remainder(std::atan2(d.y(), d.x()) - turned, 2 * pi);
  }
  void add_gradient(const Points& x, Points& gradient) const {
    const Vec3 d = arm(x), slope = moment / d.squaredNorm() * Vec3(-d.y(), d.x(), 0);
    for (const int v : strip.grip) gradient.row(v) -= slope.transpose() / static_cast<double>(strip.grip.size());
    for (const int v : strip.tip) gradient.row(v) += slope.transpose() / static_cast<double>(strip.tip.size());
  }
};

std::vector<Measured> end_moment(const ValidationValues& values) {
  constexpr double length = 12, full = 50 * pi / 3;
  StripShape shape = strip_shape(values, length, width);
  shape.clamp = shape.grip = true;
  const Strip strip = make_strip_scene(shape, steel(), Vec3::UnitX(), -Vec3::UnitZ(), "clamp");
  Couple couple{strip};
  AddedTerm load;
  load.value = [&couple](const Points& x) { return -couple.moment * couple.angle(x); };
  load.add_derivatives = [&couple](const Points& x, Points& gradient, std::vector<ContactBlock>&) {
    couple.add_gradient(x, gradient);
  };
  Points x = strip.start;
  constexpr int parts = 12;
  for (int part = 1; part <= parts; ++part) {
    couple.moment = values.number("turn") * full * part / parts;
    x = settled(strip.scene, x, load, couple.moment / length);
    couple.turned = couple.angle(x);
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
  const ValidationParameter fineness{"resolution", "30,60", "30", "elements along the strip", {.low = 4, .high = 400}, {}};
  const std::string meshes = "one_diagonal,alternating,unstructured";
  std::vector<ValidationParameter> moment = strip_parameters(fineness, meshes, "0,45");
  moment.insert(moment.begin(), {"turn", "1", "1", "part of a whole circle", {.low = 0, .high = 1, .low_in = false}, {}});
  return {{"end_shear", "a strip clamped at one end, a force at the other", strip_parameters(fineness, meshes, "0,45"),
           end_shear},
          {"end_moment", "a strip clamped at one end, rolled up by a moment at the other", moment, end_moment}};
}

}  // namespace selvedge
