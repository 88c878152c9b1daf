#pragma once

#include <vector>

#include "collision/penetration/closed_surface.hpp"
#include "collision/search/bvh.hpp"

namespace selvedge {

// How often triangles wind round a point: the solid angle that they are seen under, from behind as positive, over 4 pi
// (Jacobson et al. 2013). Far away a node of the tree is one dipole at its centroid with how its triangles spread round
// that (Barill et al. 2018, second order); nearer a triangle is a dipole, then three at the middles of its edges; near
// by it is exact.
struct DipoleTree {
  struct Dipole {
    Vec3 centre = Vec3::Zero(), moment = Vec3::Zero();  // moment: sum of area x normal, over 4 pi
    double radius = 0;                                  // of a ball round the centre that has all triangles
  };
  Bvh bvh;
  std::vector<Dipole> dipoles, of_faces;     // by node, by item
  std::vector<Mat3> spreads;                 // by node: sum of (centroid - centre) (area x normal)^T, over 4 pi
  std::vector<int> faces;                    // by item
  std::vector<std::array<Vec3, 3>> corners;  // by item, counter-clockwise seen from outside
  double far = 2;  // in radii: from there on a node is a dipole and a face three; a face is one from twice that
};

// Of some triangles of a surface, each turned as `turn` (+1, -1) says.
DipoleTree make_dipole_tree(const Surface&, const Points& x, const std::vector<int>& faces,
                            const std::vector<signed char>& turn, double far);

// All triangles but face `left_out`: on that face the principal value.
double winding_number(const DipoleTree&, const Vec3& at, int left_out = -1);

}  // namespace selvedge
