#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/scene/make_scene.hpp"
#include "physics/solve/assembly.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/validate/validate_strip.hpp"

// Coulomb's law, by the conventional stepper with all that it does about contact.
namespace selvedge {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double g = 9.81, frame = 1.0 / 30;  // [m/s2], [s]

// A sheet laid on a slope along x at the distance that contact keeps.
std::vector<Measured> incline(const ValidationValues& values) {
  const double slope = values.number("slope") * pi / 180, mu = values.number("mu");
  const Vec3 down(std::cos(slope), -std::sin(slope), 0), normal(std::sin(slope), std::cos(slope), 0);
  Strip sheet = make_strip_scene(strip_shape(values, 0.2, 0.2), Material{}, down, Vec3(0, 0, -1), "");
  sheet.scene.contact.friction = mu;
  Points plane(4, 3);
  Triangles faces(2, 3);
  for (int k = 0; k < 4; ++k)
    plane.row(k) = ((k == 1 || k == 2 ? 12.0 : -1.0) * down + Vec3(0, 0, k < 2 ? 1.0 : -1.2)).transpose();
  faces << 0, 1, 2, 0, 2, 3;
  add_obstacle(sheet.scene, static_cast<int>(plane.rows()), faces, false, "slope");
  State state =
      first_state(sheet.scene, sheet.start.rowwise() + sheet.scene.contact.thickness * normal.transpose(), {plane});
  const Drive drive = at_rest(sheet.scene, state);
  const auto stepper = make_recovering_conventional_stepper(sheet.scene);
  const Vec3 start = state.x.colwise().mean();
  constexpr int settle = 10, frames = 40;
  double before = 0;
  for (int n = 1; n <= frames; ++n) {
    advance(*stepper, drive, frame, state);
    if (n == settle) before = Vec3(state.v.colwise().mean()).dot(down);
  }
  if (mu >= std::tan(slope))
    return {{"slid [m] (sticks)", (Vec3(state.x.colwise().mean()) - start).dot(down), 0, Judged::at_most, 1e-3}};
  const double acceleration = (Vec3(state.v.colwise().mean()).dot(down) - before) / ((frames - settle) * frame);
  return {{"acceleration [m/s2]", acceleration, g * (std::sin(slope) - mu * std::cos(slope)), Judged::relative, 0.02}};
}

constexpr double bar_radius = 0.05, leg = 0.1;  // [m]

// Where arc length a of a belt lies that comes up a leg, goes round the bar by `wrap` and down another.
Vec3 on_belt(double a, double wrap, double r, double across) {
  const double along = std::clamp(a / r, 0.0, wrap), beyond = a < 0 ? a : std::max(0.0, a - wrap * r);
  const double angle = pi / 2 + wrap / 2 - along;
  const Vec3 out(std::cos(angle), std::sin(angle), 0), tangent(std::sin(angle), -std::cos(angle), 0);
  return r * out + beyond * tangent + Vec3(0, 0, across);
}

// Pull of the cloth on some pinned vertices along a direction, by the forces of membrane and bending [N].
double pull(const Elastic& elastic, const Points& x, const std::vector<int>& vertices, const Vec3& direction) {
  AssemblyScratch scratch;
  Points gradient;
  elastic_derivatives(elastic, x, scratch, &gradient, nullptr);
  double sum = 0;
  for (const int v : vertices) sum += row(gradient, v).dot(direction);
  return sum;
}

std::vector<Measured> capstan(const ValidationValues& values) {
  const double mu = values.number("mu"), wrap = values.number("wrap") * pi / 180;
  const double r = bar_radius + Scene{}.contact.thickness, length = 2 * leg + wrap * r, width = 0.02;
  Strip belt = make_strip_scene(strip_shape(values, length, width), Material{}, Vec3::UnitX(), -Vec3::UnitZ(), "root");
  Scene& scene = belt.scene;
  scene.pins.insert(scene.pins.end(), belt.tip.begin(), belt.tip.end());
  std::sort(scene.pins.begin(), scene.pins.end());
  scene.contact.friction = mu;
  Points start(belt.start.rows(), 3);
  for (int v = 0; v < start.rows(); ++v)
    start.row(v) = on_belt(belt.start(v, 0) - leg, wrap, r, belt.start(v, 2) + width / 2).transpose();
  constexpr int sides = 90;
  Points bar(2 * sides, 3);
  Triangles faces(2 * sides, 3);
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * pi * i / sides;
    for (const int end : {0, 1})
      bar.row(2 * i + end) << bar_radius * std::cos(angle), bar_radius * std::sin(angle), end - 0.5;
    const int a = 2 * i, b = 2 * ((i + 1) % sides);
    faces.row(2 * i) << a, b, a + 1;
    faces.row(2 * i + 1) << a + 1, b, b + 1;
  }
  add_obstacle(scene, static_cast<int>(bar.rows()), faces, false, "bar");
  // Both ends tighten the belt for ten frames, then the far end pulls it round.
  const Vec3 near = (on_belt(-leg, wrap, r, 0) - on_belt(0, wrap, r, 0)).normalized(),
             far = (on_belt(wrap * r + leg, wrap, r, 0) - on_belt(wrap * r, wrap, r, 0)).normalized();
  const Elastic elastic = make_elastic(scene);
  const auto stepper = make_recovering_conventional_stepper(scene);
  State state = first_state(scene, start, {bar});
  Drive drive;
  drive.obstacles = {bar};
  constexpr int tighten = 10, frames = 45, last = 10;
  double slack = 0, tight = 0;
  for (int n = 1; n <= frames; ++n) {
    const double tightened = 0.008 * std::min(1.0, n / double(tighten)), slid = 0.3e-3 * std::max(0, n - tighten);
    drive.pins.resize(static_cast<Eigen::Index>(scene.pins.size()), 3);
    for (std::size_t p = 0; p < scene.pins.size(); ++p) {
      const int v = scene.pins[p];
      const bool at_root = std::find(belt.root.begin(), belt.root.end(), v) != belt.root.end();
      const Vec3 moved = at_root ? Vec3((tightened - slid) * near) : Vec3((tightened + slid) * far);
      drive.pins.row(static_cast<Eigen::Index>(p)) = start.row(v) + moved.transpose();
    }
    advance(*stepper, drive, frame, state);
    if (n <= frames - last) continue;
    slack += pull(elastic, state.x, belt.root, near) / last;
    tight += pull(elastic, state.x, belt.tip, far) / last;
  }
  return {{"T2 / T1", tight / slack, std::exp(mu * wrap), Judged::relative, 0.02}};
}

}  // namespace

std::vector<ValidationCase> friction_cases() {
  return {{"incline", "a sheet on a slope sticks or slides",
           strip_parameters({{"slope", "15,30", "15,30", "of the plane [degrees]", {.low = 0, .high = 80}},
                             {"mu", "0.3", "0.3", "coefficient of friction", table::not_negative}},
                            resolution_parameter("8", "8", "cloth"), "one_diagonal", "0"),
           incline},
          {"capstan", "a belt is pulled round a bar",
           strip_parameters({{"mu", "0.1,0.3,0.5", "0.3", "coefficient of friction", table::not_negative},
                             {"wrap", "90,180", "180", "angle round the bar [degrees]", {.low = 10, .high = 180}}},
                            resolution_parameter("80", "80", "cloth"), "one_diagonal", "0"),
           capstan}};
}

}  // namespace selvedge
