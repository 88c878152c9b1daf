#pragma once

#include <array>
#include <span>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// A convex part of a face, in barycentric coordinates.
struct FaceCell {
  std::vector<Vec2> corners;       // barycentric coordinates 1 and 2 of each, counter-clockwise
  std::array<double, 3> moment{};  // integrals of the coordinates, where the face's area is 1/2
  std::array<bool, 3> at_edge{};   // whether it has a side on the edge from corner k to the next
  Vec3 middle = Vec3::Zero();      // its centroid, in barycentric coordinates
};

// A straight piece of a curve across the face; both ends are barycentric coordinates 1 and 2.
struct FaceChord {
  Vec2 from, to;
};

// Divides a face so that no chord runs through the inside of a cell. Cells without area are left out.
std::vector<FaceCell> face_cells(std::span<const FaceChord> chords);

}  // namespace selvedge
