#pragma once

#include <array>
#include <span>
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
    Vec3 centre = Vec3::Zero();
    double reach_squared = 0;    // of the distance beyond which it stands for its triangles [m^2]
    Vec3 moment = Vec3::Zero();  // sum of area x normal, over 4 pi
  };
  // A node: with S = sum of (centroid - centre) (area x normal)^T over 4 pi.
  struct SpreadDipole : Dipole {
    double trace = 0;                // of S
    std::array<double, 6> spread{};  // of S + S^T: half of the diagonal, then yz, zx, xy
    int child = 0;                   // as the tree has it
  };
  Bvh bvh;
  std::vector<SpreadDipole> nodes;           // of the tree
  std::vector<Dipole> of_faces;              // by item
  std::vector<int> faces;                    // by item
  std::vector<std::array<Vec3, 3>> corners;  // by item, counter-clockwise seen from outside
  double far = 2;  // in radii: from there on a node is a dipole and a face three; a face is one from twice that
};

// Of some triangles of a surface, each turned as `turn` (+1, -1) says.
DipoleTree make_dipole_tree(const Surface&, const Points& x, const std::vector<int>& faces,
                            const std::vector<signed char>& turn, double far);

struct WindingPoint {
  Vec3 at = Vec3::Zero();
  int left_out = -1;  // a face that does not count: on that face the winding number is its principal value
};

// At each point. The same bits in whatever order and company points come, and on any number of threads.
std::vector<double> winding_numbers(const DipoleTree&, std::span<const WindingPoint>);

}  // namespace selvedge
