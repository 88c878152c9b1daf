#include <cmath>
#include <numbers>

#include "collision/geometry/error.hpp"
#include "pipeline/validate/known_answers.hpp"
#include "pipeline/validate/validate_strip.hpp"

// A strip clamped at one end that vibrates, without gravity.
namespace selvedge {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double length = 0.3, density = 0.2, first_frequency = 5;  // [m], [kg/m2], [Hz]
constexpr double amplitude = 0.01;                                  // of the tip over the length

double frequency(double bending, int mode) {
  return std::pow(clamped_free_root(mode), 2) / (2 * pi) * std::sqrt(bending / (density * std::pow(length, 4)));
}

// Started flat with the mode's velocity; the time between the first two returns through the flat shape is half a
// period. Implicit Euler lowers w to atan(w h) / h, by 0.02 % where 240 steps make a period; nothing is corrected for.
double measured_frequency(const Strip& strip, double expected, int mode, int steps) {
  const Scene& scene = strip.scene;
  const double h = 1 / (expected * steps), root = clamped_free_root(mode);
  Points x = strip.start, v = Points::Zero(x.rows(), 3);
  Eigen::VectorXd shape(x.rows());
  for (int i = 0; i < x.rows(); ++i) shape[i] = x(i, 0) > 0 ? clamped_free_mode(root, x(i, 0) / length) : 0;
  v.col(1) = 2 * pi * expected * amplitude * length * shape;
  Points pins(static_cast<Eigen::Index>(scene.pins.size()), 3);
  for (std::size_t p = 0; p < scene.pins.size(); ++p) pins.row(static_cast<Eigen::Index>(p)) = x.row(scene.pins[p]);
  ImplicitEuler solver(scene, {});
  const Eigen::VectorXd weights = solver.masses().cwiseProduct(shape);
  double before = 0;
  std::vector<double> crossings;
  for (int n = 1; n <= 2 * steps && crossings.size() < 2; ++n) {
    StepProblem problem;
    problem.h = h;
    problem.x0 = &x;
    problem.v0 = &v;
    problem.pins = &pins;
    Points next = x + h * v;
    solver.solve(problem, next);
    v = (next - x) / h;
    x = next;
    const double now = weights.dot(x.col(1));
    if (before * now < 0) crossings.push_back(h * (n - 1 + before / (before - now)));
    before = now;
  }
  if (crossings.size() < 2)
    throw Error("the strip does not vibrate", "validate vibration", "report it with the parameters");
  return 0.5 / (crossings[1] - crossings[0]);
}

std::vector<Measured> vibration(const ValidationValues& values) {
  const double bending = std::pow(first_frequency / frequency(1, 1), 2);
  const Strip strip = make_strip_scene(strip_shape(values, length, values.number("width") * length),
                                       plate_material(density, bending, values.number("thickness") * length, 0),
                                       Vec3::UnitX(), -Vec3::UnitZ(), "clamp");
  const int steps = values.integer("steps");
  const double f1 = measured_frequency(strip, frequency(bending, 1), 1, steps);
  const double f2 = measured_frequency(strip, frequency(bending, 2), 2, steps);
  return {{"f1 [Hz]", f1, frequency(bending, 1), Judged::relative, 0.02},
          {"f2 / f1", f2 / f1, 6.2669, Judged::relative, 0.02}};
}

}  // namespace

std::vector<ValidationCase> motion_cases() {
  return {{"vibration", "the first two frequencies of a clamped strip",
           strip_parameters({{"steps", "240", "240", "a period", {.low = 20}},
                             {"thickness", "0.01", "0.01", "of the plate over the length", table::positive},
                             width_parameter()},
                            resolution_parameter("30", "30"), "one_diagonal,unstructured", "0,45"),
           vibration}};
}

}  // namespace selvedge
