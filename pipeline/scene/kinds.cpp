#include "pipeline/scene/kinds.hpp"

#include <algorithm>
#include <utility>

#include "collision/geometry/error.hpp"

namespace selvedge {

void Kinds::add(StepperKind kind) {
  if (find(kind.name))
    throw Error("there is a kind of stepper `" + kind.name + "` already", "kinds of steppers", "choose another name");
  kinds_.push_back(std::move(kind));
}

const StepperKind* Kinds::find(const std::string& name) const {
  const auto kind = std::ranges::find(kinds_, name, &StepperKind::name);
  return kind == kinds_.end() ? nullptr : &*kind;
}

std::vector<std::string> Kinds::names() const { return names_of(kinds_); }

}  // namespace selvedge
