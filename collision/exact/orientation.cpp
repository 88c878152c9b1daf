#include "collision/exact/orientation.hpp"

#include <algorithm>
#include <cmath>

#include "collision/exact/exact_integer.hpp"

namespace selvedge {
namespace {

// Relative error of the floating determinants (Shewchuk 1997, section 4.4, stage A), rounded up.
constexpr double error_2d = 3.4e-16, error_3d = 7.8e-16;
// A bound of all underflow in these determinants, relative to the last factors.
constexpr double underflow = 1e-300;

int sign(double value) { return (value > 0) - (value < 0); }

// Coordinate `axis` of the other points minus that of point `from`, as integers on a common power of two. The power may
// differ from axis to axis: scaling an axis keeps the sign of a determinant.
template <typename Point, int Count>
void exact_differences(const std::array<const Point*, Count>& points, int axis,
                       std::array<ExactInteger, Count - 1>& differences) {
  int exponent = lowest_exponent((*points[0])[axis]);
  for (const Point* point : points) exponent = std::min(exponent, lowest_exponent((*point)[axis]));
  const ExactInteger from((*points[0])[axis], exponent);
  for (int i = 1; i < Count; ++i) differences[i - 1] = ExactInteger((*points[i])[axis], exponent) - from;
}

int exact_orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  std::array<ExactInteger, 3> x, y, z;
  exact_differences<Vec3, 4>({&a, &b, &c, &d}, 0, x);
  exact_differences<Vec3, 4>({&a, &b, &c, &d}, 1, y);
  exact_differences<Vec3, 4>({&a, &b, &c, &d}, 2, z);
  const ExactInteger bc = x[0] * y[1] - x[1] * y[0];
  const ExactInteger cd = x[1] * y[2] - x[2] * y[1];
  const ExactInteger db = x[2] * y[0] - x[0] * y[2];
  return (bc * z[2] + cd * z[0] + db * z[1]).sign();
}

int exact_orient2d(const Vec2& a, const Vec2& b, const Vec2& c) {
  std::array<ExactInteger, 2> x, y;
  exact_differences<Vec2, 3>({&a, &b, &c}, 0, x);
  exact_differences<Vec2, 3>({&a, &b, &c}, 1, y);
  return (x[0] * y[1] - x[1] * y[0]).sign();
}

bool same_coordinate(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  for (int k = 0; k < 3; ++k)
    if (a[k] == b[k] && a[k] == c[k] && a[k] == d[k]) return true;
  return false;
}

}  // namespace

int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a;
  const double bxcy = ab.x() * ac.y(), cxby = ac.x() * ab.y();
  const double cxdy = ac.x() * ad.y(), dxcy = ad.x() * ac.y();
  const double dxby = ad.x() * ab.y(), bxdy = ab.x() * ad.y();
  const double det = (bxcy - cxby) * ad.z() + (cxdy - dxcy) * ab.z() + (dxby - bxdy) * ac.z();
  const double permanent = (std::abs(bxcy) + std::abs(cxby)) * std::abs(ad.z()) +
                           (std::abs(cxdy) + std::abs(dxcy)) * std::abs(ab.z()) +
                           (std::abs(dxby) + std::abs(bxdy)) * std::abs(ac.z());
  const double lost = underflow * (1 + std::abs(ab.z()) + std::abs(ac.z()) + std::abs(ad.z()));
  if (std::abs(det) > error_3d * permanent + lost) return sign(det);
  return same_coordinate(a, b, c, d) ? 0 : exact_orient3d(a, b, c, d);
}

int orient2d(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 ab = b - a, ac = c - a;
  const double left = ab.x() * ac.y(), right = ac.x() * ab.y();
  const double det = left - right;
  if (std::abs(det) > error_2d * (std::abs(left) + std::abs(right)) + underflow) return sign(det);
  // A difference is zero only if its terms are equal. This decides the common case of points on a line along an axis.
  if ((ab.x() == 0 || ac.y() == 0) && (ac.x() == 0 || ab.y() == 0)) return 0;
  return exact_orient2d(a, b, c);
}

int orient2d(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  return orient2d(Vec2(a[u], a[v]), Vec2(b[u], b[v]), Vec2(c[u], c[v]));
}

}  // namespace selvedge
