#include "pipeline/make_stepper.hpp"

#include "collision/error.hpp"
#include "pipeline/config.hpp"

namespace selvedge {

const std::vector<std::string>& known_steppers() {
  static const std::vector<std::string> known{"conventional", "icm"};
  return known;
}

std::unique_ptr<Stepper> make_stepper(const Setup& setup) {
  if (setup.run.stepper == "conventional") return make_conventional_stepper(setup.scene, setup.run.conventional);
  if (setup.run.stepper == "icm") return make_icm_stepper(setup.scene, setup.run.icm);
  throw Error("unknown stepper `" + setup.run.stepper + "`", setup.file.string(), "known: " + joined(known_steppers()));
}

}  // namespace selvedge
