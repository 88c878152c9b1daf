#pragma once

#include <functional>

#include "physics/scene/make_scene.hpp"
#include "pipeline/garments/garment_rest.hpp"
#include "pipeline/garments/worn_part.hpp"
#include "pipeline/patterns/pattern_mesh.hpp"

namespace selvedge {

struct SewingOptions {
  Material material;
  ContactSettings contact;  // of the drape; while stitches contract nothing rubs
  double fps = 30;
  double closing = 1;       // in which the stitches contract [s]
  double closed = 1e-4;     // gap below which a stitch is closed [m]
  double most_draping = 6;  // until the garment rests, at most [s]
  double damping = 3;       // of its motion, by mass [1/s]; at rest is what garment_rest.hpp says
};

// How far the sewing is, after each frame; positions are of the panels' vertices, whether sewn or not.
struct SewingFrame {
  double time = 0;  // [s]
  bool sewn = false;
  double largest_gap = 0;   // of a stitch [m]
  double moving_share = 0;  // of vertices
  const StepReport* report = nullptr;
  const Points* x = nullptr;
};

// A garment whose seams are edges between two panels.
struct SewnPattern {
  Points x;  // on the body [m]
  Triangles triangles;
  std::vector<RestTriangle> rest;  // of the panels, flat
  std::vector<std::pair<std::string, std::vector<int>>> groups;
  std::vector<int> vertex;   // of each vertex of the panels: its number here
  std::vector<double> gaps;  // of each stitch before it was joined [m]
  double joined_by = 0;      // largest distance that joining moved a vertex [m]
  double moving_share = 1;   // in the last frame
  WornWatch watch;           // of the part that it was on when the stitches had closed; left_in counts all frames
  int closing_frames = 0, draping_frames = 0;
  double seconds = 0;     // that it took
  bool rejected = false;  // a step was
  Points body;            // as it was dressed: parted from itself [m]
  double body_moved = 0;  // by so much at most [m]
};

// Sews the panels round a body that stands still, and lets the garment come to rest on it. The conventional stepper
// makes every frame, from a clean start on: first each stitch is a spring that gets shorter, without gravity and
// friction; then its two vertices become one, in their middle, and the garment falls. Stitches whose vertices lie at
// one place from the start are joined there. A garment that has left the body falls no farther. A body that crosses
// itself, at its armpits say, is parted from itself first: faces that have passed each other leave cloth no place to
// be. `seen` is told of every frame and may be empty.
SewnPattern sew_pattern(const PatternMesh&, const Points& body, const Triangles& body_triangles, const SewingOptions&,
                        const std::function<void(const SewingFrame&)>& seen);

}  // namespace selvedge
