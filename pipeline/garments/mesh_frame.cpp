#include "pipeline/garments/mesh_frame.hpp"

#include <algorithm>
#include <limits>

#include "collision/geometry/box_diagonal.hpp"
#include "collision/geometry/nearest_point.hpp"
#include "collision/geometry/pair_budget.hpp"
#include "collision/geometry/surface.hpp"
#include "collision/search/intersections.hpp"
#include "pipeline/config/config_units.hpp"
#include "pipeline/garments/worn_part.hpp"

namespace selvedge {
namespace {

constexpr double beyond_box = 0.25;     // beyond the body's box, of its diagonal
constexpr double least_extent = 0.1;    // extent of a garment, of that diagonal
constexpr double clearly_nearer = 1.5;  // how much farther off the second best is at least
constexpr double deep = 0.05;           // inside the body, of the garment's extent
constexpr Eigen::Index most_sampled = 256;
constexpr double crosses_much = 10;  // times as many pairs with the body as with the other axis, and as many pairs more

bool fits_box(const Points& x, const Points& body) {
  const double size = box_diagonal(body), more = beyond_box * size;
  const Eigen::RowVector3d low = x.colwise().minCoeff() - body.colwise().minCoeff();
  const Eigen::RowVector3d high = body.colwise().maxCoeff() - x.colwise().maxCoeff();
  return box_diagonal(x) >= least_extent * size && std::min(low.minCoeff(), high.minCoeff()) >= -more;
}

double off_body(const Points& x, const Points& body, const Points& normals) {
  const Eigen::Index step = 1 + (x.rows() - 1) / most_sampled;
  const double size = box_diagonal(x);
  const CellGrid grid = grid_of(body);
  double distances = 0, inside = 0, count = 0;
  for (Eigen::Index v = 0; v < x.rows(); v += step, ++count) {
    const auto [foot, squared] = nearest_point(grid, body, x.row(v).transpose());
    distances += std::sqrt(squared);
    inside += (x.row(v) - body.row(foot)).dot(normals.row(foot)) < -deep * size;
  }
  return distances / count / size + inside / count;
}

// Pairs of triangles of the garment and the body that intersect.
double crossings(const Surface& garment, const Points& x, const Surface& body, const Points& body_x) {
  IntersectionCache own, other;
  try {
    return static_cast<double>(intersecting_pairs(garment, x, own, body, body_x, other).size());
  } catch (const TooManyPairs&) {
    return std::numeric_limits<double>::infinity();
  }
}

// Of two fits with one unit, leaves out the one that crosses the body much more.
void leave_out_crossing(const Points& x, const Surface& garment, const Points& body, const Surface& body_surface,
                        std::vector<FrameFit>& fits) {
  std::vector<double> pairs(fits.size(), 0);
  std::vector<char> crossing(fits.size(), 0);
  for (std::size_t a = 0; a < fits.size(); ++a)
    for (std::size_t b = a + 1; b < fits.size(); ++b) {
      if (fits[a].frame.unit != fits[b].frame.unit) continue;
      for (const std::size_t k : {a, b}) pairs[k] = crossings(garment, in_metres(x, fits[k].frame), body_surface, body);
      crossing[a] = pairs[a] > crosses_much * (pairs[b] + 1);
      crossing[b] = pairs[b] > crosses_much * (pairs[a] + 1);
    }
  std::vector<FrameFit> kept;
  for (std::size_t k = 0; k < fits.size(); ++k)
    if (!crossing[k]) kept.push_back(fits[k]);
  fits = std::move(kept);
}

}  // namespace

Points in_metres(const Points& x, const MeshFrame& frame) {
  return metres_per_unit(frame.unit) * with_y_up(x, frame.up);
}

std::string frame_text(const MeshFrame& frame) { return frame.unit + (frame.up == Up::y ? ", y up" : ", z up"); }

Points of_triangles(const Points& x, const Triangles& triangles) {
  std::vector<int> used(triangles.reshaped().begin(), triangles.reshaped().end());
  std::ranges::sort(used);
  const auto repeated = std::ranges::unique(used);
  used.erase(repeated.begin(), repeated.end());
  return x(used, Eigen::all);
}

std::vector<FrameFit> fitting_frames(const Points& x, const Triangles& triangles, const Points& body,
                                     const Triangles& body_triangles, const std::optional<std::string>& unit,
                                     const std::optional<Up>& up) {
  const Surface body_surface = make_surface(static_cast<int>(body.rows()), body_triangles);
  const Points normals = vertex_normals(body_surface, body);
  const std::vector<std::string> units =
      unit ? std::vector{*unit} : std::vector<std::string>{"m", "dm", "cm", "mm", "in"};
  const std::vector<Up> axes = up ? std::vector{*up} : std::vector{Up::y, Up::z};
  const Points used = of_triangles(x, triangles);
  std::vector<FrameFit> fits;
  for (const std::string& one : units)
    for (const Up axis : axes) {
      const MeshFrame frame{one, axis};
      const Points there = in_metres(used, frame);
      if (fits_box(there, body) && !worn_part(there, body).places.empty())
        fits.push_back({frame, off_body(there, body, normals)});
    }
  if (fits.size() > 1) {
    const Surface garment = make_surface(static_cast<int>(x.rows()), triangles);
    leave_out_crossing(x, garment, body, body_surface, fits);
  }
  std::ranges::stable_sort(fits, {}, &FrameFit::off);
  return fits;
}

std::optional<MeshFrame> clear_frame(const std::vector<FrameFit>& fits) {
  if (fits.empty() || (fits.size() > 1 && fits[1].off <= clearly_nearer * fits[0].off)) return {};
  return fits[0].frame;
}

}  // namespace selvedge
