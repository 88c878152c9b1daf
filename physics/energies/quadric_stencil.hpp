#pragma once

#include <vector>

#include <Eigen/Core>

#include "physics/scene/scene.hpp"

namespace selvedge {

// What a vertex of a flat bending cloth measures of the second fundamental form K, as weights over vertices near it;
// the weights apply to each coordinate of the positions. K is that of the quadric through the vertex that fits its
// neighbours best, near ones first, in the flat rest shape: exact for every quadric on every mesh, inside and along
// boundaries. Neighbours are the ring, with the vertices across the ring's edges where the ring alone determines no
// quadric (four neighbours, five close to a conic), and two rings where these do not either, as along boundaries.
//
// Triangles whose corners are all pinned do not bend: their area is not part of `area`, and at the edge of such a clamp
// the K of the whole neighbourhood counts for the part that can bend.
//
// A quadric has fewer coefficients than most vertices have neighbours. With its K alone, positions that alternate from
// vertex to vertex could lower the energy of a bent sheet. The misfit prevents that. It is zero for every quadric, and
// of the second order in the mesh otherwise.
struct QuadricStencil {
  int vertex = 0, cloth = 0;
  std::vector<int> nodes;
  Eigen::RowVectorXd trace, a, b;  // over nodes [1/m2]: K_uu + K_vv, (K_uu - K_vv) / 2, K_uv in the vertex's own frame
  Eigen::MatrixXd
      misfit;       // a row a point: what it has besides the quadric, as curvature over nodes [1/m2]; none at a clamp
  double area = 0;  // the vertex's own and that of vertices that measure nothing [m2]
};

// Of all cloths with BendingModel::curvature and bending > 0, in the order of their vertices. Vertices on edges of more
// than two triangles, where sheets touch in a point, and all whose neighbourhood determines no quadric have none.
std::vector<QuadricStencil> quadric_stencils(const Scene&);

}  // namespace selvedge
