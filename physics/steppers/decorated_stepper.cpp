#include "physics/steppers/decorated_stepper.hpp"

#include <utility>

#include "physics/scene/scene_numbers.hpp"
#include "physics/steppers/cutting_stepper.hpp"
#include "physics/steppers/recovering_stepper.hpp"

namespace selvedge {

std::unique_ptr<Stepper> decorated(const Scene& scene, const MakeStepper& bare, const Decorations& wanted) {
  check_scene(scene);
  const MakeStepper make = [bare, recovery = wanted.recovery](const Scene& part) {
    std::unique_ptr<Stepper> stepper = bare(part);
    return stepper->traits().honours_extras ? make_recovering_stepper(part, std::move(stepper), recovery)
                                            : std::move(stepper);
  };
  std::unique_ptr<Stepper> whole = make(scene);
  if (wanted.rest && whole->traits().may_leave_out_cloths)
    whole = make_resting_stepper(scene, make, std::move(whole), wanted.resting);
  return wanted.cut ? make_cutting_stepper(scene, make, std::move(whole)) : std::move(whole);
}

MakeStepper conventional_maker(const ConventionalOptions& options) {
  return [options](const Scene& scene) { return make_conventional_stepper(scene, options); };
}

std::unique_ptr<Stepper> make_recovering_conventional_stepper(const Scene& scene, const ConventionalOptions& options) {
  return decorated(scene, conventional_maker(options));
}

}  // namespace selvedge
