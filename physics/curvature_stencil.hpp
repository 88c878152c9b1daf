#pragma once

#include <vector>

#include "physics/scene.hpp"

namespace selvedge {

// What an interior vertex of a bending cloth measures of the second fundamental form, as weights over itself and its
// ring, and the areas on which that counts. Vector valued: the weights apply to each coordinate.
//
// Trace: the cotangent Laplacian L of the rest metric; (L x)_i is the mean curvature vector integrated over the
// vertex's Voronoi cell A_i. A_i is signed (obtuse triangles reach out of themselves): then (L x)_i / A_i is exact for
// every paraboloid of revolution on every ring, and a rolled sheet's energy is off only by the ring's anisotropy.
// Deviator: a = (K_uu - K_vv) / 2 and b = K_uv of the quadric that fits the ring best, exact for every quadric; the
// frame u, v is the vertex's own. A ring of four, or one that is close to a conic, does not determine them.
//
// What is measured counts on the area for which the vertex stands: its own cell and that of vertices without a measure
// of their own, boundary vertices above all, each given to the nearest vertex that has one. Without it a sheet would be
// soft along its edges. Triangles whose corners are all pinned do not bend: they have no part in A_i, so that the whole
// kink at the edge of a clamp counts on the half cell that gives way.
struct CurvatureStencil {
  std::vector<int> nodes;           // the vertex first, then its ring in order
  std::vector<double> laplacian;    // over nodes [1]
  std::vector<double> a, b;         // over nodes [1/m2]; empty: not determined
  double cell = 0;                  // A [m2]
  double trace_area = 0;            // on which the trace counts [m2]
  double deviator_area = 0;         // on which the deviator counts [m2]
  bool deviator_elsewhere = false;  // the deviator is measured here or at a vertex that has this one's area
  int cloth = 0;
};

// Of all cloths with BendingModel::curvature and bending > 0, in the order of their vertices. Vertices whose triangles
// are no closed fan have none, nor have those whose triangles are all pinned.
std::vector<CurvatureStencil> curvature_stencils(const Scene&);

}  // namespace selvedge
