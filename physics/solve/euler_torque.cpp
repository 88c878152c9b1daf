#include "physics/solve/euler_torque.hpp"

#include <algorithm>
#include <cmath>

#include "physics/energies/joints.hpp"

namespace selvedge {
namespace {

constexpr double on_axis = 1e-9;  // of a pin's distance from the others, for rounding

bool on_one_line(const std::vector<int>& pins, const Points& x, const Vec3& up) {
  const Vec3 first = row(x, pins.front());
  return std::ranges::all_of(pins, [&](int pin) {
    const Vec3 away = row(x, pin) - first;
    return up.cross(away).norm() <= on_axis * (away.norm() + first.norm());
  });
}

// Rotation of a part about an axis through `middle`, relative to its motion.
struct Turn {
  double momentum = 0, inertia = 0;  // [kg m2/s], [kg m2]
  double rate() const { return inertia > 0 ? momentum / inertia : 0; }
};

Turn turn_of(const std::vector<int>& vertices, const Eigen::VectorXd& masses, const Points& x, const Points& v,
             const Vec3& middle, const Vec3& speed, const Vec3& up) {
  Turn turn;
  for (const int i : vertices) {
    const Vec3 arm = up.cross(row(x, i) - middle);
    turn.momentum += masses[i] * arm.dot(row(v, i) - speed);
    turn.inertia += masses[i] * arm.squaredNorm();
  }
  return turn;
}

}  // namespace

EulerTorque::EulerTorque(const Scene& scene) : masses_(lumped_masses(scene)) {
  const std::vector<int> component = joined_components(scene);
  std::vector<Part> parts(scene.surface.component_count);
  std::vector<char> pinned(component.size(), 0);
  for (const int pin : scene.pins) {
    pinned[pin] = 1;
    parts[component[pin]].pins.push_back(pin);
  }
  for (int i = 0; i < scene.surface.vertex_count; ++i)
    if (!pinned[i] && !parts[component[i]].pins.empty()) parts[component[i]].free.push_back(i);
  for (Part& part : parts)
    if (!part.pins.empty() && !part.free.empty()) parts_.push_back(std::move(part));
}

void EulerTorque::take_back(const StepProblem& step, const Points& x1, const Points& unbalanced, Points& v1) const {
  if (step.acceleration.isZero(0) || !step.wind.isZero(0)) return;
  const Points &x0 = *step.x0, &v0 = *step.v0;
  const double h = step.h;
  const Vec3 up = -step.acceleration.normalized();
  for (const Part& part : parts_) {
    if (!on_one_line(part.pins, x0, up) || !on_one_line(part.pins, x1, up)) continue;
    const Vec3 from = row(x0, part.pins.front()), to = row(x1, part.pins.front()), speed = (to - from) / h;
    // Relative to a pin that moves with `speed`, angular momentum changes by -speed x momentum per second.
    double torque = 0;
    Vec3 gained = Vec3::Zero();
    for (const int i : part.free) {
      torque += masses_[i] * up.dot(row(v1, i).cross(row(v0, i)));
      torque += up.dot((row(x1, i) - to).cross(row(unbalanced, i)));
      gained += masses_[i] * (row(v1, i) - row(v0, i));
    }
    torque += 0.5 * up.dot(speed.cross(gained));
    const Turn before = turn_of(part.free, masses_, x0, v0, from, speed, up),
               after = turn_of(part.free, masses_, x1, v1, to, speed, up);
    if (!(after.inertia > 0)) continue;
    const double turned = std::pow(h * after.rate(), 2), lost = after.momentum * turned / (1 + turned);
    const double most = std::max(std::abs(before.momentum), std::abs(after.momentum));
    const double wanted = std::clamp(after.momentum - h * torque - lost, -most, most);
    const double change = (wanted - after.momentum) / after.inertia;
    for (const int i : part.free) v1.row(i) += change * up.cross(row(x1, i) - to).transpose();
  }
}

}  // namespace selvedge
