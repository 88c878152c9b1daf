#pragma once

#include <optional>
#include <string>
#include <vector>

#include "collision/geometry/points.hpp"
#include "pipeline/bodies/up_axis.hpp"

namespace selvedge {

// How the coordinates of a mesh file are meant.
struct MeshFrame {
  std::string unit = "m";  // as metres_per_unit takes it
  Up up = Up::y;
};

Points in_metres(const Points& x, const MeshFrame&);     // with y up
Points of_triangles(const Points& x, const Triangles&);  // those that are a corner, each once
std::string frame_text(const MeshFrame&);                // "cm, z up"

// A way in which a garment's coordinates may be meant, by where it puts the garment on its body: on it by
// worn_part.hpp, not beyond the body's box enlarged by a quarter of its diagonal, and no smaller than a tenth of that.
struct FrameFit {
  MeshFrame frame;
  // Mean distance of vertices from the body over the garment's own extent, and the share deeper inside of it than a
  // twentieth of that: less is a garment that clips through the body where it is meant to lie.
  double off = 0;
};

// Those that fit, the best first, of the units m, dm, cm, mm, in and both axes, or of what is given alone. Of two axes
// with one unit, that one is left out with which the garment crosses the body many times as often: a wide skirt is
// about as near to it either way. `body` is in metres, with y up, in the pose in which it wears the garment; its
// triangles face outwards. Distances are those of the nearest vertices, of a sample of the garment's.
std::vector<FrameFit> fitting_frames(const Points& x, const Triangles&, const Points& body,
                                     const Triangles& body_triangles, const std::optional<std::string>& unit = {},
                                     const std::optional<Up>& up = {});

// The first of them where the next one is more than half as far off again. Absent: none fits, or it is not clear which.
std::optional<MeshFrame> clear_frame(const std::vector<FrameFit>&);

}  // namespace selvedge
