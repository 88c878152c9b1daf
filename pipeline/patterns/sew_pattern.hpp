#pragma once

#include <functional>

#include "physics/scene/make_scene.hpp"
#include "pipeline/garments/garment_rest.hpp"
#include "pipeline/garments/worn_part.hpp"
#include "pipeline/patterns/pattern_mesh.hpp"

namespace selvedge {

struct SewingOptions {
  Material material;
  ContactSettings contact;  // of the drape; no friction while stitches contract
  double fps = 30;
  double closing = 1;       // time in which the stitches contract [s]
  double closed = 1e-4;     // gap below which a stitch is closed [m]
  double most_draping = 6;  // longest time until the garment rests [s]
  double damping = 3;       // mass damping of its motion [1/s]; garment_rest.hpp defines rest
};

// The progress of sewing after each frame. Positions are those of the panels' vertices, sewn or not.
struct SewingFrame {
  double time = 0;  // [s]
  bool sewn = false;
  double largest_gap = 0;   // of a stitch [m]
  double moving_share = 0;  // of vertices
  const StepReport* report = nullptr;
  const Points* x = nullptr;
};

// The sewn garment: seams are edges between two panels.
struct SewnPattern {
  Points x;  // on the body [m]
  Triangles triangles;
  std::vector<RestTriangle> rest;  // of the panels, flat
  std::vector<std::pair<std::string, std::vector<int>>> groups;
  std::vector<int> vertex;   // of each vertex of the panels its number in x
  std::vector<double> gaps;  // of each stitch before it was joined [m]
  double joined_by = 0;      // largest distance that joining moved a vertex [m]
  double moving_share = 1;   // in the last frame
  WornWatch watch;           // from when the stitches had closed; left_in counts all frames
  int closing_frames = 0, draping_frames = 0;
  double seconds = 0;     // wall-clock time
  bool rejected = false;  // a step was
  Points body;            // the body used, parted from itself [m]
  double body_moved = 0;  // by parting it, at most [m]
};

// Sews the panels round a body that stands still, and lets the garment come to rest on it. The conventional stepper
// makes every frame from a clean start. First each stitch is a spring that gets shorter, without gravity and friction.
// Then its two vertices are joined at their middle, and the garment falls. Stitches of zero length are joined at the
// start. If the garment leaves the body, draping ends. A body that crosses itself, for example at its armpits, is
// parted from itself first, since faces that have passed each other leave cloth no room. `seen` is called for every
// frame and may be empty.
SewnPattern sew_pattern(const PatternMesh&, const Points& body, const Triangles& body_triangles, const SewingOptions&,
                        const std::function<void(const SewingFrame&)>& seen);

}  // namespace selvedge
