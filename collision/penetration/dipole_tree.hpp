#pragma once

#include <array>
#include <span>
#include <vector>

#include "collision/penetration/closed_surface.hpp"
#include "collision/search/bvh.hpp"

namespace selvedge {

// A tree for winding numbers: the solid angle of triangles seen from a point, positive if seen from behind, over 4 pi
// (Jacobson et al. 2013). Far away a node of the tree is one dipole at its centroid with the spread of its triangles
// (Barill et al. 2018, second order). Nearer, each triangle is a dipole, then three at the middles of its edges; close
// by its solid angle is exact.
struct DipoleTree {
  struct Dipole {
    Vec3 centre = Vec3::Zero();
    double reach_squared = 0;    // squared distance beyond which the dipole replaces its triangles [m^2]
    Vec3 moment = Vec3::Zero();  // sum of area x normal, over 4 pi
  };
  // A node: with S = sum of (centroid - centre) (area x normal)^T over 4 pi.
  struct SpreadDipole : Dipole {
    double trace = 0;                // of S
    std::array<double, 6> spread{};  // of S + S^T: half the diagonal, then yz, zx, xy
    int child = 0;                   // as Bvh::Node::child
  };
  Bvh bvh;
  std::vector<SpreadDipole> nodes;           // as Bvh::nodes
  std::vector<Dipole> of_faces;              // by item
  std::vector<int> faces;                    // by item
  std::vector<std::array<Vec3, 3>> corners;  // by item, counter-clockwise seen from outside
  double far = 2;  // distance in radii from which a node is one dipole and a face three; from twice that a face is one
};

// A tree of the triangles `faces` of a surface, each turned as `turn` (+1, -1) says. `far`: DipoleTree::far.
DipoleTree make_dipole_tree(const Surface&, const Points& x, const std::vector<int>& faces,
                            const std::vector<signed char>& turn, double far);

struct WindingPoint {
  Vec3 at = Vec3::Zero();
  int left_out = -1;  // a face to leave out, -1: none; at a point on that face this gives the principal value
};

// The winding number at each point. A point's result has the same bits whatever other points are asked, in any order,
// and on any number of threads.
std::vector<double> winding_numbers(const DipoleTree&, std::span<const WindingPoint>);

}  // namespace selvedge
