#include "learned/losses/volume_loss.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "collision/contour/find_contours.hpp"
#include "collision/geometry/cell_grid.hpp"
#include "collision/penetration/winding_loss.hpp"

namespace selvedge {
namespace {

// The segments between two garments, or those within one.
Segments segments_of_kind(const ClosedSurface& closed, const Segments& all, bool between) {
  Segments kept{all.crossings, {}, {}};
  for (const Segment& segment : all.segments)
    if ((closed.garment[segment.triangle[0]] != closed.garment[segment.triangle[1]]) == between)
      kept.segments.push_back(segment);
  return kept;
}

VolumeCounts counts_of(const Penetration& found) {
  VolumeCounts counts{static_cast<int>(found.contours.size()),
                      static_cast<int>(std::ranges::count(found.contours, ContourVolume::enclosed))};
  for (const PenetrationRegion& region : found.regions) counts.volume += std::abs(region.volume);
  return counts;
}

bool share_edge(const Surface& surface, int a, int b) {
  for (const int t : surface.triangles_of(a))
    for (int k = 0; k < 3; ++k)
      if (surface.triangles(t, k) == b) return true;
  return false;
}

}  // namespace

double volume_loss(const ClosedSurface& closed, const VolumeLoss& loss, const Points& x, Points* gradient,
                   VolumeCounts* counts) {
  if (!x.allFinite()) return 0;
  const Points at = closed_positions(closed, x);
  const SheetView sheet{&closed.surface, &at};
  const Segments all = penetration_segments(closed, find_segments(std::span(&sheet, 1)));
  const bool winding = loss.form == VolumeForm::winding;
  const Segments judged = winding ? segments_of_kind(closed, all, true) : all;
  const Penetration found =
      find_penetration(closed, at, judged, trace_contours(std::span(&sheet, 1), judged), loss.regions);
  Points by_closed, by_winding;
  const PenetrationLossOptions options{loss.measure, loss.crossings, 1, loss.saturation};
  double value = penetration_loss(closed, at, found, options, gradient ? &by_closed : nullptr);
  if (winding) {
    WindingOptions turns;
    turns.weight = 6;
    const Segments own = segments_of_kind(closed, all, false);
    value += winding_loss(closed, at, own, turns, gradient ? &by_winding : nullptr).value;
    if (gradient) by_closed += by_winding;
  }
  if (gradient) *gradient += by_cloth_positions(closed, by_closed);
  if (counts) *counts = counts_of(found);
  return value;
}

double force_loss(const std::vector<double>& mass, const Points& acceleration, const Points& x, Points* gradient) {
  double value = 0;
  for (int v = 0; v < x.rows(); ++v) {
    const Vec3 force = mass[v] * row(acceleration, v);
    value -= force.dot(row(x, v));
    if (gradient) gradient->row(v) -= force.transpose();
  }
  return value;
}

double vertex_repulsion_loss(const Surface& surface, double distance, int power, const Points& x, Points* gradient) {
  assert(power == 1 || power == 2);
  if (x.rows() == 0 || !x.allFinite()) return 0;
  const CellGrid cells(x, distance);
  double value = 0;
  for (int a = 0; a < x.rows(); ++a)
    cells.for_each_near(row(x, a), distance, [&](int b) {
      if (b <= a) return;
      const Vec3 apart = row(x, a) - row(x, b);
      const double length = apart.norm(), depth = distance - length;
      if (depth <= 0 || share_edge(surface, a, b)) return;
      value += power == 1 ? depth : depth * depth;
      if (!gradient || length == 0) return;
      const Vec3 push = (power == 1 ? 1 : 2 * depth) / length * apart;
      gradient->row(a) -= push.transpose();
      gradient->row(b) += push.transpose();
    });
  return value;
}

}  // namespace selvedge
