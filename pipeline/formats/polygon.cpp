#include "pipeline/formats/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace selvedge {
namespace {

constexpr double least_quality = 1e-6;   // of a triangle with area: twice that over its longest edge squared
constexpr double most_warped = 0.1;      // height of a flat quad's last corner over the others, over their distance
constexpr double edge_tolerance = 1e-9;  // a corner outside by less than this quality counts as on the edge

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
      if (shape_quality(A, B, p, normal) > -edge_tolerance && shape_quality(B, C, p, normal) > -edge_tolerance &&
          shape_quality(C, A, p, normal) > -edge_tolerance)
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

// Whether two triangles on a diagonal of a quad, a c, face opposite ways.
bool is_folded(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return twice_area(a, b, c).dot(twice_area(a, c, d)) < 0;
}

using QuadOrder = std::array<int, 4>;

bool is_crossed(std::span<const Vec3> quad, const QuadOrder& order) {
  const auto at = [&](int k) -> const Vec3& { return quad[static_cast<std::size_t>(order[k % 4])]; };
  return is_folded(at(0), at(1), at(2), at(3)) && is_folded(at(1), at(2), at(3), at(0));
}

// The order of its corners round a quad that is nearly flat and whose edges cross; absent for any other.
std::optional<QuadOrder> order_round(std::span<const Vec3> quad) {
  if (quad.size() != 4 || !is_crossed(quad, {0, 1, 2, 3})) return {};
  const double longest = std::max({(quad[1] - quad[0]).norm(), (quad[2] - quad[0]).norm(), (quad[3] - quad[0]).norm()});
  const Vec3 normal = twice_area(quad[0], quad[1], quad[2]).normalized();
  if (std::abs(normal.dot(quad[3] - quad[0])) > most_warped * longest) return {};
  for (const QuadOrder& order : {QuadOrder{0, 1, 3, 2}, QuadOrder{0, 2, 1, 3}})
    if (!is_crossed(quad, order)) return order;
  return {};
}

// The end of polygon p among the corners.
int end_of(const std::vector<int>& corners, const std::vector<int>& begin, std::size_t p) {
  return p + 1 < begin.size() ? begin[p + 1] : static_cast<int>(corners.size());
}

std::vector<Vec3> places_of(const Points& x, const std::vector<int>& corners, const std::vector<int>& begin,
                            std::size_t p) {
  std::vector<Vec3> places;
  for (int k = begin[p]; k < end_of(corners, begin, p); ++k) places.push_back(row(x, corners[k]));
  return places;
}

// A number that polygons with the same places in any order share.
double sum_of_places(std::vector<Vec3> places) {
  std::ranges::sort(places, [](const Vec3& a, const Vec3& b) { return std::ranges::lexicographical_compare(a, b); });
  double sum = 0;
  for (const Vec3& place : places) sum = sum / 2 + place.x() + 3 * place.y() + 7 * place.z();
  return sum;
}

// Of each polygon with more than three corners the first one that may have the same places; -1 if it is that one.
std::vector<int> first_alike(const Points& x, const std::vector<int>& corners, const std::vector<int>& begin) {
  std::vector<std::pair<double, int>> sums;
  for (std::size_t p = 0; p < begin.size(); ++p)
    if (end_of(corners, begin, p) - begin[p] > 3)
      sums.emplace_back(sum_of_places(places_of(x, corners, begin, p)), static_cast<int>(p));
  std::ranges::sort(sums);
  std::vector<int> first(begin.size(), -1);
  std::size_t head = 0;
  for (std::size_t i = 1; i < sums.size(); ++i) {
    if (sums[i].first == sums[head].first)
      first[sums[i].second] = sums[head].second;
    else
      head = i;
  }
  return first;
}

// The triangles of a polygon that lies on another one, corner on corner, in either direction: those of the other one,
// `cut`. Absent if it does not lie on it.
std::optional<std::vector<std::array<int, 3>>> cut_alike(std::span<const Vec3> places, std::span<const Vec3> other,
                                                         const std::vector<std::array<int, 3>>& cut) {
  const int n = static_cast<int>(places.size());
  if (std::ssize(other) != n) return {};
  for (int offset = 0; offset < n; ++offset)
    for (const int direction : {1, n - 1}) {
      const auto at = [&](int corner) { return (offset + direction * corner) % n; };
      bool same = true;
      for (int k = 0; k < n && same; ++k) same = other[k] == places[at(k)];
      if (!same) continue;
      std::vector<std::array<int, 3>> triangles;
      for (const auto& [a, b, c] : cut)
        triangles.push_back({at(a), at(direction == 1 ? b : c), at(direction == 1 ? c : b)});
      return triangles;
    }
  return {};
}

}  // namespace

std::vector<std::array<int, 3>> polygon_triangles(std::span<const Vec3> corners) {
  if (const std::optional<QuadOrder> order = order_round(corners)) {
    const auto& [a, b, c, d] = *order;
    return {{a, b, c}, {a, c, d}};
  }
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

int crossed_quads(const Points& x, const std::vector<int>& corners, const std::vector<int>& begin) {
  int count = 0;
  for (std::size_t p = 0; p < begin.size(); ++p)
    count += end_of(corners, begin, p) - begin[p] == 4 && order_round(places_of(x, corners, begin, p)).has_value();
  return count;
}

Triangles cut_polygons(const Points& x, const std::vector<int>& corners, const std::vector<int>& begin) {
  const std::vector<int> first = first_alike(x, corners, begin);
  Triangles cut(std::ssize(corners) - 2 * std::ssize(begin), 3);
  Eigen::Index t = 0;
  for (std::size_t p = 0; p < begin.size(); ++p) {
    const std::vector<Vec3> places = places_of(x, corners, begin, p);
    std::optional<std::vector<std::array<int, 3>>> triangles;
    if (first[p] >= 0) {
      const std::vector<Vec3> other = places_of(x, corners, begin, static_cast<std::size_t>(first[p]));
      triangles = cut_alike(places, other, polygon_triangles(other));
    }
    if (!triangles) triangles = polygon_triangles(places);
    for (const auto& [a, b, c] : *triangles) cut.row(t++) << begin[p] + a, begin[p] + b, begin[p] + c;
  }
  return cut;
}

}  // namespace selvedge
