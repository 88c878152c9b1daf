#pragma once

#include "learned/graph/feature_options.hpp"

namespace selvedge {

// First columns in the row of a node: velocity 3, type, level, normal 3, (dt,) mass, objective, (is_init,) bending, mu,
// lambda, flags.
struct NodeColumns {
  int type, level, normal, mass, time, objective, materials, flags;

  explicit NodeColumns(const FeatureOptions& options)
      : type(embedding_columns(options).type),
        level(embedding_columns(options).level),
        normal(level + options.level_columns) {
    const bool dt = options.time == TimeFeature::timestep;
    const int behind = normal + 5 + objective_columns(options);  // of the materials
    mass = dt ? normal + 4 : normal + 3;
    objective = mass + 1;
    time = dt ? normal + 3 : behind - 1;
    materials = behind;
    flags = materials + 3;
  }
};

}  // namespace selvedge
