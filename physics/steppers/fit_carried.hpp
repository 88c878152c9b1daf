#pragma once

#include "physics/steppers/carried_guess.hpp"

namespace selvedge {

// Least squares for the coefficients of a carried guess, as normal equations: of the coefficients' difference from the
// default set, vertex by vertex.
struct CarriedFit {
  using Gram = Eigen::Matrix<double, carried_term_count, carried_term_count>;
  struct OfVertex {
    Gram gram = Gram::Zero();                // sum of products of terms [m2]
    CarriedSet moment = CarriedSet::Zero();  // of terms and what the default set leaves [m2]
    double left = 0;                         // squares of what the default set leaves [m2]
    long frames = 0;
  };
  std::vector<OfVertex> vertices;  // one for each of the scene
};

// Adds a frame: its terms, all of them known, and the motion that is wanted, n x 3 [m]. Vertices that nothing wears,
// pins, and rows that are not finite are left out. False: the terms are not known, and nothing is added.
bool add_frame(const Scene&, const CarriedTerms&, const Points& motion, CarriedFit&);

// The scene's set, which all vertices share. Terms that the frames do not tell apart keep the default's coefficients.
CarriedSet fitted_scene_set(const CarriedFit&);

// A set for each vertex, by ridge regression: the scene's set counts as much as `weight` (> 0) mean frames of a mean
// vertex. A vertex without frames has the scene's set.
CarriedModel fitted_own_sets(const CarriedFit&, double weight);

// RMS distance [m] from the wanted motion, over all frames and vertices; 0 without frames.
double distance_left(const CarriedFit&, const CarriedModel&);

}  // namespace selvedge
