#pragma once

#include <functional>
#include <vector>

#include "pipeline/garments/garment.hpp"
#include "pipeline/garments/garment_cut.hpp"
#include "pipeline/shapes/border.hpp"
#include "pipeline/shapes/primitives.hpp"

namespace selvedge {

// The distance field whose zero level is the garment's surface, positive outside [m].
using DistanceField = std::function<double(const Vec3&)>;

// Adds a turn-down collar along the part of the boundary in `neck`: it stands up, folds outward, and covers the garment
// over a width of `depth` [m]. Returns its vertices.
std::vector<int> add_collar(Shape&, const DistanceField&, const Border& neck, double depth, double edge);

// Adds a pocket as a component of its own in front of the garment. Returns its vertices. Those on its sides and lower
// edge are stitched, each to the nearest of the shape's first `ground` vertices, at their present distance.
std::vector<int> add_pocket(Shape&, const DistanceField&, const Pocket&, double edge, int ground,
                            std::vector<Stitch>& stitches);

}  // namespace selvedge
