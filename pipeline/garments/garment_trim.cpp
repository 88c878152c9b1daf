#include "pipeline/garments/garment_trim.hpp"

#include <algorithm>
#include <cmath>

#include "collision/geometry/surface.hpp"
#include "pipeline/shapes/generate.hpp"
#include "pipeline/shapes/implicit_form.hpp"

namespace selvedge {
namespace {

// The height above the cloth below [m].
double lift(double edge) { return 0.006 + sagitta(edge); }

// The boundary vertices in a border, from one end of their run to the other.
std::vector<int> run_in(const Shape& shape, const Border& border) {
  const Surface surface = make_surface(static_cast<int>(shape.x.rows()), shape.triangles);
  const auto lies_in = [&](int v) { return std::abs(border.value(row(shape.x, v))) < 1e-6; };
  for (std::vector<int> loop : boundary_loops(surface)) {
    const auto outside = std::find_if_not(loop.begin(), loop.end(), lies_in);
    std::rotate(loop.begin(), outside, loop.end());
    const auto first = std::find_if(loop.begin(), loop.end(), lies_in);
    if (first != loop.end()) return {first, std::find_if_not(first, loop.end(), lies_in)};
  }
  return {};
}

Vec3 gradient(const DistanceField& value, const Vec3& p) {
  constexpr double step = 1e-5;
  Vec3 g;
  for (int k = 0; k < 3; ++k) g[k] = (value(p + step * Vec3::Unit(k)) - value(p - step * Vec3::Unit(k))) / (2 * step);
  return g;
}

// The point at distance `away` from the neckline along the garment's surface, reached in steps from p.
Vec3 walked(const DistanceField& field, const Border& neck, double away, Vec3 p) {
  constexpr double longest = 0.005;
  const int steps = static_cast<int>(std::ceil(away / longest));
  for (int k = 0; k < steps; ++k) {
    const Vec3 normal = gradient(field, p).normalized(), from_neck = -gradient(neck.value, p);
    p = projected(field, p + away / steps * (from_neck - from_neck.dot(normal) * normal).normalized());
  }
  return p;
}

// The profile of a collar from a point of the neckline: heights above the garment and distances along it.
struct CollarPoint {
  double height, away;
};

std::vector<CollarPoint> collar_profile(double depth, double edge) {
  constexpr double stand = 0.022, fold = 0.010;
  const std::vector<CollarPoint> corners{{0, 0}, {stand, 0}, {stand, fold}, {lift(edge), depth}};
  std::vector<CollarPoint> points;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const CollarPoint &a = corners[k - 1], &b = corners[k];
    const int parts =
        std::max(1, static_cast<int>(std::lround(std::hypot(b.height - a.height, b.away - a.away) / edge)));
    for (int i = 1; i <= parts; ++i) {
      const double t = static_cast<double>(i) / parts;
      points.push_back({(1 - t) * a.height + t * b.height, (1 - t) * a.away + t * b.away});
    }
  }
  return points;
}

void append(Shape& shape, const std::vector<Vec3>& x, const std::vector<std::array<int, 3>>& triangles) {
  const Eigen::Index n = shape.x.rows(), m = shape.triangles.rows();
  shape.x.conservativeResize(n + static_cast<Eigen::Index>(x.size()), 3);
  shape.x.bottomRows(static_cast<Eigen::Index>(x.size())) = to_points(x);
  shape.triangles.conservativeResize(m + static_cast<Eigen::Index>(triangles.size()), 3);
  shape.triangles.bottomRows(static_cast<Eigen::Index>(triangles.size())) = to_triangles(triangles);
}

// Two triangles for each square between rows of equally many vertices, cut across alternately.
void add_squares(const std::vector<int>& below, const std::vector<int>& above, bool odd,
                 std::vector<std::array<int, 3>>& triangles) {
  for (std::size_t k = 1; k < below.size(); ++k)
    add_quad(triangles, below[k - 1], below[k], above[k], above[k - 1], (k % 2 == 0) == odd);
}

// A stitch to the nearest of the points.
Stitch stitch_to(const Points& points, const Vec3& p, int vertex) {
  Eigen::Index nearest = 0;
  const double squared = (points.rowwise() - p.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
  return {vertex, static_cast<int>(nearest), std::sqrt(squared)};
}

}  // namespace

std::vector<int> add_collar(Shape& shape, const DistanceField& field, const Border& neck, double depth, double edge) {
  std::vector<int> below = run_in(shape, neck);
  std::reverse(below.begin(), below.end());  // so that normals continue those of the garment
  std::vector<Vec3> at, x;                   // the present end of each line of the collar
  for (const int v : below) at.push_back(row(shape.x, v));
  double away = 0;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> fresh;
  bool odd = false;
  for (const CollarPoint& point : collar_profile(depth, edge)) {
    std::vector<int> above;
    for (Vec3& p : at) {
      p = walked(field, neck, point.away - away, p);
      above.push_back(static_cast<int>(shape.x.rows()) + static_cast<int>(x.size()));
      x.push_back(p + point.height * gradient(field, p).normalized());
    }
    away = point.away;
    add_squares(below, above, odd, triangles);
    fresh.insert(fresh.end(), above.begin(), above.end());
    below = above;
    odd = !odd;
  }
  append(shape, x, triangles);
  return fresh;
}

std::vector<int> add_pocket(Shape& shape, const DistanceField& field, const Pocket& pocket, double edge, int ground,
                            std::vector<Stitch>& stitches) {
  const auto squares = [&](double length) { return std::max(2, static_cast<int>(std::lround(length / edge))); };
  const int columns = squares(pocket.size.x()), rows = squares(pocket.size.y());
  constexpr double before = 0.16;  // the front is behind this [m]
  std::vector<Vec3> x;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> below, fresh, stitched;
  for (int j = 0; j <= rows; ++j) {
    std::vector<int> line;
    for (int i = 0; i <= columns; ++i) {
      const double u = pocket.centre.x() + pocket.size.x() * (static_cast<double>(i) / columns - 0.5);
      const double v = pocket.centre.y() + pocket.size.y() * (static_cast<double>(j) / rows - 0.5);
      double z = before;  // moves straight back until it meets the garment
      for (int step = 0; step < 40; ++step) z -= 0.8 * field(Vec3(u, v, z));
      line.push_back(static_cast<int>(shape.x.rows()) + static_cast<int>(x.size()));
      const Vec3 on(u, v, z);
      x.push_back(on + lift(edge) * gradient(field, on).normalized());
      if (i == 0 || i == columns || j == 0) stitched.push_back(line.back());
    }
    if (j > 0) add_squares(below, line, j % 2 == 0, triangles);
    fresh.insert(fresh.end(), line.begin(), line.end());
    below = line;
  }
  append(shape, x, triangles);
  for (const int v : stitched) stitches.push_back(stitch_to(shape.x.topRows(ground), row(shape.x, v), v));
  return fresh;
}

}  // namespace selvedge
