#pragma once

#include <functional>

#include "pipeline/shapes/primitives.hpp"

namespace selvedge {

// The zero level of a function inside a box, by marching tetrahedra on a grid of the given edge length (six tetrahedra
// a cube round its diagonal; Treece, Prager and Gee 1999), normals towards positive values. Where it leaves the box it
// has a boundary exactly on the box's face. `value` must change by at most about the distance, since cubes that `value`
// shows farther away than their size are skipped.
Shape isosurface(const std::function<double(const Vec3&)>& value, const Vec3& low, const Vec3& high, double edge);

}  // namespace selvedge
