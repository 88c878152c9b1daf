#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <string>
#include <vector>

#include "physics/scene/stepper.hpp"
#include "pipeline/scene/kinds.hpp"

namespace selvedge {

// The objects of Python that makers and steppers hold. A class may refer to what holds it, by its module's names say,
// so whoever is an object of Python itself shows them to its collector of cycles.
using HeldObjects = std::shared_ptr<std::vector<std::weak_ptr<nanobind::object>>>;

// Makes steppers of a subclass of selvedge.Stepper (selvedge/steppers.py): one instance a scene. They are made and
// stepped with Python's lock, whoever has it. Throws Error that names the kind for what is no such class.
MakeStepper python_maker(const std::string& kind, const nanobind::handle& type, const HeldObjects&);

// The known kinds of steppers and those of a dictionary, name to subclass.
Kinds kinds_with(const nanobind::dict& types, const HeldObjects&);

}  // namespace selvedge
