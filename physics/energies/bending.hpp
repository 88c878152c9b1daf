#pragma once

#include <array>
#include <vector>

#include <Eigen/SparseCore>

#include "physics/scene/scene.hpp"

namespace selvedge {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

// Curvature form: the plate of physical stiffness B [N m] and Poisson's ratio nu, independent of the mesh's diagonals,
//   E = B / 2 integral (tr K)^2 - 2 (1 - nu) det K = B integral (1 + nu) (tr K / 2)^2 + (1 - nu) (a^2 + b^2),
// with K, its deviator a and b, measured at every vertex (physics/energies/quadric_stencil.hpp). A sheet that bends one
// way alone has B / 2 times its curvature squared, whatever nu is; the deviator is what resists twist. Vectors stand
// for the entries of K, so that flat rest shapes have a constant Hessian Q (x) I3 (after Bergou et al. 2006). Scenes
// with curved rest shapes: see CurvedVertex; of the plate's energy they have the part (tr K)^2 alone. A clamp is two
// rows of pins: one row is a hinge. A cloth one element wide has no bending.
struct CurvedVertex {      // E = 1/2 stiffness ((L x) . n - rest)^2 with n the area-weighted unit normal of the ring
  std::vector<int> nodes;  // the vertex first, then its ring in order
  std::vector<double> laplacian;  // weights of (L x) over nodes [1]
  double stiffness = 0;           // B W / A^2 [N/m]
  double rest = 0;                // (L x_rest) . n_rest [m]
};
struct CurvatureBending {
  SparseMatrix flat;  // Q [N/m], n x n, symmetric positive semidefinite; no entries where nothing is flat
  std::vector<CurvedVertex> curved;
};
CurvatureBending curvature_bending(const Scene&);  // cloths with BendingModel::curvature and bending > 0

// Poisson's ratio of a plate of this material: the membrane's own in plane stress, 0 for woven cloth.
double bending_poisson(const Material&);

double curved_energy(const CurvedVertex&, const Points& x);  // [J]
// gradient: 3k [N], hessian: 3k x 3k (Gauss-Newton, PSD) [N/m] or null, k = nodes.size(). Returns the energy [J].
double curved_derivatives(const CurvedVertex&, const Points& x, Eigen::VectorXd& gradient, Eigen::MatrixXd* hessian);

// Hinge form: dihedral angle, the papers' weight k l^2 / (4 (A0 + A1)) * (theta - rest)^2 / 2, with rest areas and the
// edge's length l at rest, or now: then an edge that is stretched bends less easily, and bending pulls at it.
struct Hinge {
  std::array<int, 4> nodes;  // the edge's two ends, then the vertices opposite in its two triangles
  double weight = 0;         // k l^2 / (4 (A0 + A1)) [N m]; with the current length k / (4 (A0 + A1)) [N/m]
  double rest_angle = 0;     // [rad]
  HingeLength length = HingeLength::rest;
};
std::vector<Hinge> hinges(const Scene&);  // cloths with BendingModel::hinge and bending > 0

// In (-pi, pi]; zero where flat, positive where the surface is convex seen from the side of its normals (the edge runs
// e0 -> e1 in the triangle with a). Zero where a triangle is degenerate.
double dihedral_angle(const Vec3& e0, const Vec3& e1, const Vec3& a, const Vec3& b);
double hinge_energy(const Hinge&, const Points& x);  // [J]

}  // namespace selvedge
