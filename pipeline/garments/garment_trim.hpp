#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "pipeline/garments/garment.hpp"
#include "pipeline/garments/garment_cut.hpp"
#include "pipeline/shapes/border.hpp"
#include "pipeline/shapes/primitives.hpp"

namespace selvedge {

// The distance field that a garment's surface is the zero level of, positive outside [m].
using DistanceField = std::function<double(const Vec3&)>;

// Adds a turn-down collar to the surface along the part of its boundary that lies in `neck`: it stands up, folds over
// outward, and falls so far that it lies `depth` wide on the garment. Returns its vertices.
std::vector<int> add_collar(Shape&, const DistanceField&, const Border& neck, double depth, double edge);

// Adds a pocket as a component of its own, which hangs before the front. Returns its vertices. Those on its sides and
// lower edge are stitched, each to the nearest of the shape's first `ground` vertices, at the distance that it has.
std::vector<int> add_pocket(Shape&, const DistanceField&, const Pocket&, double edge, int ground,
                            std::vector<Stitch>& stitches);

}  // namespace selvedge
