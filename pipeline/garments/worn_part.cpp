#include "pipeline/garments/worn_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "collision/geometry/box_diagonal.hpp"
#include "collision/geometry/nearest_point.hpp"

namespace selvedge {
namespace {

constexpr Eigen::Index most_places = 512;
constexpr double fewest_near = 0.05;  // least share of near vertices, if it is on the body
constexpr double least_share = 0.5, least_highest = 1.0 / 3;

bool is_covered(const WornPart::Place& place, const Points& x, const Points& body) {
  const auto foot = body.row(place.foot);
  const double squared = place.reach * place.reach;
  if ((x.row(place.vertex) - foot).squaredNorm() <= squared) return true;  // the usual case
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    if ((x.row(v) - foot).squaredNorm() <= squared) return true;
  return false;
}

}  // namespace

WornPart worn_part(const Points& x, const Points& body, double near) {
  assert(x.rows() > 0 && body.rows() > 0);
  const double reach = near * box_diagonal(x);
  const Eigen::Index step = 1 + (x.rows() - 1) / most_places, sampled = 1 + (x.rows() - 1) / step;
  const CellGrid grid = grid_of(body);
  WornPart part;
  for (Eigen::Index v = 0; v < x.rows(); v += step) {
    const auto [foot, squared] = nearest_point(grid, body, x.row(v).transpose());
    const double distance = std::sqrt(squared);
    if (distance <= reach) part.places.push_back({foot, distance + reach, static_cast<int>(v)});
  }
  std::ranges::stable_sort(part.places, [&](const WornPart::Place& a, const WornPart::Place& b) {
    return body(a.foot, 1) > body(b.foot, 1);
  });
  if (static_cast<double>(part.places.size()) < fewest_near * static_cast<double>(sampled)) part.places.clear();
  return part;
}

ShareWorn share_worn(const WornPart& part, const Points& x, const Points& body) {
  const std::size_t all = part.places.size(), quarter = (all + 3) / 4;
  if (all == 0) return {};
  std::size_t covered = 0, highest = 0;
  for (std::size_t k = 0; k < all; ++k) {
    covered += is_covered(part.places[k], x, body);
    if (k + 1 == quarter) highest = covered;
  }
  return {static_cast<double>(covered) / static_cast<double>(all),
          static_cast<double>(highest) / static_cast<double>(quarter)};
}

bool has_left(const WornPart& part, const Points& x, const Points& body) {
  const ShareWorn share = share_worn(part, x, body);
  return share.all < least_share && share.highest < least_highest;
}

void WornWatch::see(int frame, const Points& x, const Points& body_now) {
  if (!has_left(part, x, body_now))
    left_in = -1;
  else if (left_in < 0)
    left_in = frame;
}

std::string slid_off_text(const WornWatch& watch) {
  return fmt::format("garment `{}` has slid off its body `{}`, in frame {}", watch.garment, watch.body, watch.left_in);
}

}  // namespace selvedge
