#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <string>
#include <vector>

#include "physics/scene/stepper.hpp"
#include "pipeline/scene/kinds.hpp"

namespace selvedge {

// The objects of Python that makers and steppers hold. A class may refer back to their holder, for example by a name in
// its module, so each holder that is itself an object of Python shows them to Python's collector of cycles.
using HeldObjects = std::shared_ptr<std::vector<std::weak_ptr<nanobind::object>>>;

// Makes steppers of a subclass of selvedge.Stepper (selvedge/steppers.py): one instance a scene. Makes and steps
// them with Python's lock held. Throws Error, which names the kind, for anything else than such a class.
MakeStepper python_maker(const std::string& kind, const nanobind::handle& type, const HeldObjects&);

// The known kinds of steppers and those of a dictionary, name to subclass.
Kinds kinds_with(const nanobind::dict& types, const HeldObjects&);

}  // namespace selvedge
