#pragma once

#include <nanobind/nanobind.h>

#include <string>

#include "physics/scene/stepper.hpp"
#include "pipeline/scene/kinds.hpp"

namespace selvedge {

// Makes steppers of a subclass of selvedge.Stepper (selvedge/steppers.py): one instance a scene. They are made and
// stepped with Python's lock, whoever has it. Throws Error that names the kind for what is no such class.
MakeStepper python_maker(const std::string& kind, const nanobind::handle& type);

// The known kinds of steppers and those of a dictionary, name to subclass.
Kinds kinds_with(const nanobind::dict& types);

}  // namespace selvedge
