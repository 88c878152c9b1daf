#include "pipeline/formats/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace selvedge {
namespace {

constexpr double least_quality = 1e-6;  // of a triangle with area: twice that over its longest edge squared
constexpr double on_edge = 1e-9;        // a corner outside by less than this quality counts as on the edge

Vec3 twice_area(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - a); }

// Twice the area along the normal, divided by the longest edge squared; 0 if that has no length.
double shape_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest > 0 ? twice_area(a, b, c).dot(normal) / longest : 0;
}

Vec3 polygon_normal(std::span<const Vec3> corners) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 2; k < corners.size(); ++k) sum += twice_area(corners[0], corners[k - 1], corners[k]);
  const double length = sum.norm();
  return length > 0 && std::isfinite(length) ? Vec3(sum / length) : Vec3::Zero();
}

std::vector<std::array<int, 3>> fan(const std::vector<int>& left) {
  std::vector<std::array<int, 3>> triangles;
  for (std::size_t k = 2; k < left.size(); ++k) triangles.push_back({left[0], left[k - 1], left[k]});
  return triangles;
}

// The rest of a polygon while its ears are cut off.
struct EarCutter {
  std::span<const Vec3> corners;
  Vec3 normal;
  std::vector<int> left;        // corners, in order
  std::vector<double> quality;  // of the ear at each of `left`
  std::vector<char> known, ear;

  EarCutter(std::span<const Vec3> all, const Vec3& along)
      : corners(all), normal(along), quality(all.size()), known(all.size(), 0), ear(all.size(), 0) {
    for (std::size_t k = 0; k < all.size(); ++k) left.push_back(static_cast<int>(k));
    for (std::size_t k = 0; k < all.size(); ++k) measure(k);
  }
  std::array<int, 3> at(std::size_t k) const {
    const std::size_t n = left.size();
    return {left[(k + n - 1) % n], left[k], left[(k + 1) % n]};
  }
  void measure(std::size_t k) {
    const auto [a, b, c] = at(k);
    quality[k] = shape_quality(corners[a], corners[b], corners[c], normal);
    known[k] = 0;
  }
  // Whether no other corner lies in the triangle or on it.
  bool is_empty(std::size_t k) const {
    const auto [a, b, c] = at(k);
    const Vec3 &A = corners[a], &B = corners[b], &C = corners[c];
    for (const int other : left) {
      const Vec3& p = corners[other];
      if (other == a || other == b || other == c || p == A || p == B || p == C) continue;
      if (shape_quality(A, B, p, normal) > -on_edge && shape_quality(B, C, p, normal) > -on_edge &&
          shape_quality(C, A, p, normal) > -on_edge)
        return false;
    }
    return true;
  }
  bool is_ear(std::size_t k) {
    if (!known[k]) {
      ear[k] = quality[k] > least_quality && is_empty(k);
      known[k] = 1;
    }
    return ear[k];
  }
  std::optional<std::size_t> best() {
    std::optional<std::size_t> found;
    for (std::size_t k = 0; k < left.size(); ++k)
      if ((!found || quality[k] > quality[*found]) && is_ear(k)) found = k;
    return found;
  }
  void cut(std::size_t k) {
    const auto erase = [k](auto& list) { list.erase(list.begin() + static_cast<std::ptrdiff_t>(k)); };
    erase(left);
    erase(quality);
    erase(known);
    erase(ear);
    const std::size_t n = left.size();
    measure((k + n - 1) % n);
    measure(k % n);
  }
};

}  // namespace

std::vector<std::array<int, 3>> polygon_triangles(std::span<const Vec3> corners) {
  std::vector<int> all(corners.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<int>(k);
  const std::vector<std::array<int, 3>> fanned = fan(all);
  const Vec3 normal = polygon_normal(corners);
  const auto sound = [&](const std::array<int, 3>& t) {
    return shape_quality(corners[t[0]], corners[t[1]], corners[t[2]], normal) > least_quality;
  };
  if (corners.size() > most_eared_corners || std::ranges::all_of(fanned, sound)) return fanned;
  EarCutter cutter(corners, normal);
  std::vector<std::array<int, 3>> triangles;
  while (cutter.left.size() > 3) {
    std::optional<std::size_t> ear = cutter.best();
    if (!ear) {  // a corner that was no ear may be one after others are cut off
      std::ranges::fill(cutter.known, 0);
      ear = cutter.best();
    }
    if (!ear) break;
    triangles.push_back(cutter.at(*ear));
    cutter.cut(*ear);
  }
  for (const std::array<int, 3>& triangle : fan(cutter.left)) triangles.push_back(triangle);
  return triangles;
}

Triangles cut_polygons(const Points& x, const std::vector<int>& corners, const std::vector<int>& begin) {
  Triangles cut(std::ssize(corners) - 2 * std::ssize(begin), 3);
  std::vector<Vec3> places;
  Eigen::Index t = 0;
  for (std::size_t p = 0; p < begin.size(); ++p) {
    const int end = p + 1 < begin.size() ? begin[p + 1] : static_cast<int>(corners.size());
    places.clear();
    for (int k = begin[p]; k < end; ++k) places.push_back(row(x, corners[k]));
    for (const auto& [a, b, c] : polygon_triangles(places)) cut.row(t++) << begin[p] + a, begin[p] + b, begin[p] + c;
  }
  return cut;
}

}  // namespace selvedge
