#pragma once

#include <yaml-cpp/yaml.h>

namespace selvedge {

// Gives each alias (`*name`) of a file's tree values of its own, so that what changes one leaves the others alone, and
// puts what a merge key (`<<: *name`, or a list of them) names into the map that has it. Keys of the map itself win,
// then those of earlier names. The tree must be bounded (count_values in config_yaml.cpp).
void expand_aliases(YAML::Node root);

}  // namespace selvedge
