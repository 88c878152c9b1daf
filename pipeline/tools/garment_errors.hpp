#pragma once

#include <optional>
#include <span>
#include <string>

#include "collision/distance/signed_distance.hpp"
#include "collision/geometry/adjacency.hpp"

namespace selvedge {

// Errors of a predicted garment (Tan et al. 2022, section 4.1, and more). Distances are always exact.
struct GarmentErrors {
  std::optional<double> vertex_error;     // MPVE: mean distance from the true vertices [mm]
  double vertices_inside = 0;             // VFCP: share of the vertices with f < -1e-6 m [%]
  bool collision_free = false;            // CFMP counts these: no triangles meet and nothing is inside
  int pairs = 0;                          // pairs of garment and body triangles that meet, by exact signs
  bool judges_agree = true;               // FCL, if the build has it, agrees on all pairs except for rounding
  int vertex_face = 0, edge_edge = 0;     // garment triangles with a crossing of this kind
  std::optional<double> laplacian_error;  // mean difference of x - mean of the ring, over vertices inside before [mm]
  double energy = 0;                      // penetration energy: sum of f^2 over vertices inside [m2]
  std::optional<double> overshoot;        // mean of max(f, 0) over the vertices that were inside before [mm]
};

// Data beside the prediction; null: not known.
struct KnownOfGarment {
  const Points* truth = nullptr;
  const Points* before = nullptr;  // before collisions were treated
};

// The body's field must be at the body's position. Throws Error for another number of points than the garment's
// vertices.
GarmentErrors garment_errors(const DistanceField& body, const Surface& garment, const Points& predicted,
                             const KnownOfGarment&);

// Mean over models, and half the width of its 95 % interval (normal).
struct MeanOverModels {
  double mean = 0, half_width = 0;
  int models = 0;
};
MeanOverModels mean_over_models(std::span<const double>);

std::string errors_text(const GarmentErrors&);

}  // namespace selvedge
