#pragma once

#include <optional>
#include <string>
#include <vector>

#include "collision/distance/signed_distance.hpp"
#include "physics/scene/scene.hpp"
#include "pipeline/measures/fit_regions.hpp"

namespace selvedge {

// The fit of one cloth in one region of a body. A value is absent if no vertex or no section gives it.
struct FitRow {
  std::string region, cloth;
  int vertices = 0;                        // of the cloth, with their nearest point of the body in the region
  double area = 0;                         // of the cloth as it is worn there [m2]
  std::optional<double> ease, least_ease;  // girth of the cloth at rest minus girth of the body: mean and least [m]
  double gap = 0;                          // mean distance from the skin [m]
  double strain = 0, strain_99 = 0;        // largest principal strain: mean by area, 99th percentile
  double contact = 0;                      // share of the vertices that touch the skin
  std::optional<double> pressure, pressure_99;  // on the skin where it is touched: mean by area, 99th percentile [Pa]
};

struct FitMeasures {
  std::vector<FitRow> rows;               // region by region, cloth by cloth; none without vertices
  Eigen::VectorXd gap, strain, pressure;  // of each vertex [m], 1, [Pa]; pressure 0 without touch
  std::vector<int> row;                   // of each vertex: its index in `rows`, -1: nearest to no region
};

// Measures the fit of cloths that rest on a body, in one frame.
// * Ease: seven planes across the axis of a region cut the body and the cloth. The girth of the body is that of the
// convex hull of its section, as a tape measures it; that of the cloth is the rest length of its section. A plane in
// which the cloth does not go round the body gives no ease.
// * Pressure: the unbalanced part of the cloth's elastic forces and weight, along the outward normal, divided by the
// area of a vertex. In a state at rest it is the contact force, whichever stepper made the state. Inertia, damping and
// pinned vertices are left out. Vertices nearer than `reach` [m] touch.
//
// Throws Error for positions that are not finite.
FitMeasures measure_fit(const Scene&, const Points& x, const Vec3& gravity, const Surface& body, const Points& body_x,
                        const FitRegions&, double reach);

}  // namespace selvedge
