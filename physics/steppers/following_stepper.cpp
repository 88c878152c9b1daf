#include "physics/steppers/following_stepper.hpp"

#include <algorithm>
#include <utility>

namespace selvedge {
namespace {

class FollowingStepper final : public Stepper {
 public:
  FollowingStepper(const Scene& scene, std::vector<Follower> followers, std::unique_ptr<Stepper> stepper)
      : followers_(std::move(followers)), stepper_(std::move(stepper)) {
    for (const Follower& one : followers_)
      pins_.push_back(static_cast<int>(std::ranges::lower_bound(scene.pins, one.vertex) - scene.pins.begin()));
  }
  const StepperTraits& traits() const override { return stepper_->traits(); }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) override {
    Drive held = drive;  // moving pins would cause substeps
    for (std::size_t k = 0; k < pins_.size(); ++k) held.pins.row(pins_[k]) = from.x.row(followers_[k].vertex);
    StepReport report = stepper_->step(from, held, dt, to, extras);
    if (report.status != StepStatus::accepted) return report;
    for (const Follower& one : followers_) {
      // The path must end at the state, so that the audit of the state can use the search of the motion.
      if (!report.path.part)
        for (SubstepEnd& substep : report.path.substeps) follow(one, substep.nodes);
      follow(one, to.x);
      follow(one, to.v);
      for (MemoryBlock& block : to.memory)
        if (block.positions && block.rows_of == RowsOf::vertices) block.rows.row(one.vertex) = to.x.row(one.vertex);
    }
    return report;
  }

 private:
  static void follow(const Follower& one, Points& rows) {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 3; ++k) sum += one.weights[k] * row(rows, one.of[static_cast<std::size_t>(k)]);
    rows.row(one.vertex) = sum.transpose();
  }

  std::vector<Follower> followers_;
  std::vector<int> pins_;  // of each follower: its row in Scene::pins
  std::unique_ptr<Stepper> stepper_;
};

}  // namespace

std::unique_ptr<Stepper> make_following_stepper(const Scene& scene, std::vector<Follower> followers,
                                                std::unique_ptr<Stepper> stepper) {
  if (followers.empty()) return stepper;
  return std::make_unique<FollowingStepper>(scene, std::move(followers), std::move(stepper));
}

}  // namespace selvedge
