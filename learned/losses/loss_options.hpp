#pragma once

#include "collision/contour/contour_energy.hpp"
#include "collision/penetration/penetration_loss.hpp"

namespace selvedge {

// A weight that goes linearly from one value to another between two points of the run. Points are fractions of it,
// never iteration counts: no run is too short for its losses. Members are described where keys are bound to them:
// pipeline/training/objective_options.cpp.
struct LossRamp {
  double from = 1, to = 1, begin = 0, end = 0;
};
double weight_at(const LossRamp&, double progress);
inline bool is_used(const LossRamp& ramp) { return ramp.from != 0 || ramp.to != 0; }

// The face of the body that belongs to a cloth vertex, both where they are now: the face with the nearest centroid,
// however far (HOOD), or with the nearest point within a radius (ContourCraft).
enum class BodyMatching { nearest_centroid, nearest_face };

// The penalty of a depth p = max(eps - d, 0): w p^3 [w in N/m^2], as published, or the softer w p^2 / 2 [w in N/m].
enum class DepthPenalty { cubic, quadratic };

// Samples of the cloth that are kept out of the body: the vertices, as published; also the middles of edges; also the
// centroids of triangles. Each counts as a vertex does. Edges between vertices that are outside cut a round arm.
enum class ClothSamples { vertices, edges, faces };

// Penetration of the body. Members are described where keys are bound to them: pipeline/training/objective_options.cpp.
struct CollisionLoss {
  LossRamp weight{5e3, 5e5, 1.0 / 3, 1};
  double thickness = 2e-3;
  BodyMatching matching = BodyMatching::nearest_centroid;
  double radius = 3e-2;
  DepthPenalty penalty = DepthPenalty::cubic;
  ClothSamples samples = ClothSamples::vertices;
};

// Friction is weaker for slides along this axis. The released code takes z in a world where y is up.
enum class SlopeAxis { x, y, z };

// Friction on the body. Members are described where keys are bound to them: pipeline/training/objective_options.cpp.
struct FrictionLoss {
  LossRamp weight{0, 0};
  double coefficient = 0.5;
  double squared_radius = 3e-3;
  SlopeAxis slope = SlopeAxis::z;
};

// Repulsion between layers of cloth. Members are described where keys are bound to them:
// pipeline/training/objective_options.cpp.
struct RepulsionLoss {
  LossRamp weight{0, 0};
  double thickness = 3e-3;
  double correspondence = 1e-2;
  double pinned_factor = 100;
};

// Length of intersection contours. Members are described where keys are bound to them:
// pipeline/training/objective_options.cpp.
struct ContourLoss {
  LossRamp weight{0, 0};
  ContourGradient gradient = ContourGradient::translational;
  ContourNormal normal = ContourNormal::frozen;
  double share = 0;
};

// enclosed: all crossings, with garments closed by fans (Liao et al. 2024). winding: crossings of a garment with itself
// by its winding number, without fans; crossings between garments as above.
enum class VolumeForm { enclosed, winding };

// The volume that self-penetrating cloth encloses: L_sc. Members are described where keys are bound to them:
// pipeline/training/objective_options.cpp.
struct VolumeLoss {
  LossRamp weight{0, 0};
  VolumeForm form = VolumeForm::enclosed;
  PenetrationOptions regions;
  PenetrationMeasure measure = PenetrationMeasure::volume;
  CrossingMotion crossings = CrossingMotion::exact;
  double saturation = 0;
};

// The repulsion that the paper compares L_sc with: (distance - d)^power of vertices without a common edge. Members are
// described where keys are bound to them: pipeline/training/objective_options.cpp.
struct VertexRepulsionLoss {
  LossRamp weight{0, 0};
  double distance = 0.05;
  int power = 2;
};

// What is summed up. A term whose weight is zero is not evaluated. The defaults are HOOD's. Members are described where
// keys are bound to them: pipeline/training/objective_options.cpp.
struct LossOptions {
  LossRamp stretching, bending, gravity, inertia;
  CollisionLoss collision;
  FrictionLoss friction;
  RepulsionLoss repulsion;
  ContourLoss contours;
  VolumeLoss volume;
  VertexRepulsionLoss vertex_repulsion;
  LossRamp targets{0, 0}, potential{0, 0};
  double gravity_strength = 9.81;
  double relaxation_dt = 1.0 / 3;
};

// Options as published, with iterations as fractions of the run, which has 150,000 (parity README).
LossOptions hood_losses();
// The fast recipe of docs/training.md: collision 5e3 to 1e6 between a tenth and half of the run, eps 3 mm, contours 30
// N/m.
LossOptions fast_losses();

}  // namespace selvedge
