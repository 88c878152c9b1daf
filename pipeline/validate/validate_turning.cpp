#include <algorithm>
#include <cmath>

#include "physics/energies/measures.hpp"
#include "physics/scene/make_scene.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/validate/validate_strip.hpp"

// Rotation that no force gives or takes, by the conventional stepper without contact.
namespace selvedge {
namespace {

constexpr double length = 0.5, width = 0.3, h = 1.0 / 60;  // [m], [m], [s]

Strip sheet(const ValidationValues& values, double bending) {
  Material material;
  material.bending = bending;
  return make_strip_scene(strip_shape(values, length, width), material, Vec3::UnitX(), -Vec3::UnitZ(), "");
}

Vec3 momentum_about(const Scene& scene, const State& state, const Vec3& middle) {
  return angular_momentum(scene, state.x.rowwise() - middle.transpose(), state.v);
}

// A sheet that starts level, lets go and hangs on one corner: nothing turns it about the vertical through its pin.
std::vector<Measured> pin(const ValidationValues& values) {
  Strip strip = sheet(values, values.number("bending"));
  int corner = 0;
  (strip.start.col(0) + strip.start.col(2)).minCoeff(&corner);
  strip.scene.pins = {corner};
  State state = first_state(strip.scene, strip.start);
  const Vec3 held = row(state.x, corner);
  const Drive drive = at_rest(strip.scene, state);
  const auto stepper = make_recovering_conventional_stepper(strip.scene);
  const Eigen::VectorXd masses = lumped_masses(strip.scene);
  double fastest = 0;
  const int frames = static_cast<int>(std::lround(values.number("seconds") / h));
  for (int n = 0; n < frames; ++n) {
    advance(*stepper, drive, h, state);
    const Points arms = state.x.rowwise() - held.transpose();
    const double inertia = masses.dot(arms.col(0).cwiseAbs2() + arms.col(2).cwiseAbs2());
    fastest = std::max(fastest, std::abs(momentum_about(strip.scene, state, held).y()) / inertia);
  }
  return {{"fastest turn [rad/s]", fastest, 0, Judged::at_most, 0.05}};
}

// A free sheet that turns about its middle. A step of implicit Euler goes along a tangent and so ends farther out: it
// keeps 1 / (1 + w^2 h^2) of the rate, dw / dt = -w^3 h, or 1 / w^2 grows by 2 h a second.
std::vector<Measured> turn(const ValidationValues& values) {
  const Strip strip = sheet(values, Material{}.bending);
  State state = first_state(strip.scene, strip.start);
  const double rate = values.number("rate"), seconds = values.number("seconds");
  const Vec3 axis = values.word("about") == "normal" ? Vec3::UnitY() : Vec3::UnitX();
  const Vec3 middle = lumped_masses(strip.scene).transpose() * state.x / lumped_masses(strip.scene).sum();
  for (int i = 0; i < state.x.rows(); ++i) state.v.row(i) = rate * axis.cross(row(state.x, i) - middle).transpose();
  const auto stepper = make_recovering_conventional_stepper(strip.scene);
  const double before = momentum_about(strip.scene, state, middle).dot(axis);
  Drive nothing;
  nothing.pins = Points(0, 3);
  for (int n = 0; n < std::lround(seconds / h); ++n) advance(*stepper, nothing, h, state);
  const double part = before / momentum_about(strip.scene, state, middle).dot(axis);
  return {{"rate lost a second", (part * part - 1) / (2 * seconds), rate * rate * h, Judged::relative, 0.1}};
}

}  // namespace

std::vector<ValidationCase> turning_cases() {
  const ValidationParameter fineness = resolution_parameter("10", "10", "sheet");
  return {
      {"pin", "a sheet that hangs on one corner does not begin to turn",
       strip_parameters({{"bending", "1e-5,1e-3", "1e-3", "stiffness [N m]", table::positive},
                         {"seconds", "15", "4", "that it swings", table::positive}},
                        fineness, "one_diagonal,unstructured", "0"),
       pin},
      {"turn", "a free sheet turns on, but for what implicit Euler takes",
       strip_parameters({{"rate", "0.3,1", "0.3,1", "at the start [rad/s]", table::positive},
                         {"about", "normal,length", "normal", "the axis that it turns about", {}, {"normal", "length"}},
                         {"seconds", "2", "1", "that it turns", table::positive}},
                        fineness, "one_diagonal", "0"),
       turn}};
}

}  // namespace selvedge
