#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "physics/scene.hpp"

namespace selvedge {

using Vec12 = Eigen::Matrix<double, 12, 1>;
using Mat12 = Eigen::Matrix<double, 12, 12>;
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

// --- curvature form: physical stiffness B [N m], independent of the mesh's diagonals
// ----------------------------------- Mean curvature normal at interior vertices by the cotangent Laplacian of the rest
// metric; lumped areas, boundary area added to the nearest interior vertices. Flat rest shape: E = 1/2 sum_i B_i |(L
// x)_i|^2 / A_i, constant Hessian (scalar) Q (x) I3. Curved rest shape: see CurvedVertex.
struct CurvedVertex {             // E = 1/2 B / A ((L x) . n - rest)^2 with n the unit vertex normal
  std::vector<int> nodes;         // the vertex first, then its ring in order
  std::vector<double> laplacian;  // weights of (L x) over nodes
  double stiffness = 0;           // B / A
  double rest = 0;                // (L x_rest) . n_rest
};
struct CurvatureBending {
  SparseMatrix flat;  // Q [N/m], n x n, symmetric positive semidefinite; empty where nothing is flat
  std::vector<CurvedVertex> curved;
};
CurvatureBending curvature_bending(const Scene&);  // cloths with BendingModel::curvature and bending > 0

double curved_energy(const CurvedVertex&, const Points& x);
// gradient: 3k, hessian: 3k x 3k (Gauss-Newton, PSD), k = nodes.size(). Returns the energy.
double curved_derivatives(const CurvedVertex&, const Points& x, Eigen::VectorXd& gradient, Eigen::MatrixXd* hessian);

// --- hinge form: dihedral angle, the papers' weight k l^2 / (4 (A0 + A1)) * (theta - rest)^2 / 2
// ------------------------
struct Hinge {
  std::array<int, 4> nodes;  // the edge's two ends, then the vertices opposite in its two triangles
  double weight = 0;         // k l^2 / (4 (A0 + A1)) with rest lengths and areas [N m]
  double rest_angle = 0;
};
std::vector<Hinge> hinges(const Scene&);  // cloths with BendingModel::hinge and bending > 0

double dihedral_angle(const Vec3& e0, const Vec3& e1, const Vec3& a, const Vec3& b);
double hinge_energy(const Hinge&, const Points& x);
double hinge_derivatives(const Hinge&, const Points& x, Vec12& gradient, Mat12* hessian, bool psd = true);

}  // namespace selvedge
