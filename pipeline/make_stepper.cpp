#include "pipeline/make_stepper.hpp"

#include "collision/error.hpp"

namespace selvedge {

std::unique_ptr<Stepper> make_stepper(const Setup& setup) {
  if (setup.run.stepper == "conventional") return make_conventional_stepper(setup.scene, setup.run.conventional);
  throw Error("unknown stepper `" + setup.run.stepper + "`", setup.file.string(), "known: conventional");
}

}  // namespace selvedge
