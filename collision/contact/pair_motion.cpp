#include "collision/contact/pair_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace selvedge {
namespace {

int first_of_second(const NodePair& pair) { return pair.kind == PairKind::vertex_face ? 1 : 2; }

// Of arrays of which some may be the same.
double largest_of(const Points& a, const Points& b, const Points& c) {
  double largest = largest_coordinate(a);
  if (&b != &a) largest = std::max(largest, largest_coordinate(b));
  if (&c != &a && &c != &b) largest = std::max(largest, largest_coordinate(c));
  return largest;
}

}  // namespace

PairMotion::PairMotion(const Points& at, const Points& x0, const Points& x1)
    : from_(&x0 == &at || x0 == at ? Points() : Points(x0 - at)),
      to_(x1 - at),
      rounding_(64 * std::numeric_limits<double>::epsilon() * largest_of(at, x0, x1)) {}

bool PairMotion::may_come_within(const NodePair& pair, double gap, double distance) const {
  const double room = gap - distance - rounding_;
  if (!(room > 0)) return true;
  const int split = first_of_second(pair);
  const auto stays = [&](const Points& moved) {
    double most = 0;
    for (int a = 0; a < split; ++a)
      for (int b = split; b < 4; ++b)
        most = std::max(most, (moved.row(pair.nodes[a]) - moved.row(pair.nodes[b])).squaredNorm());
    return most < room * room;
  };
  return !stays(to_) || (from_.rows() > 0 && !stays(from_));
}

}  // namespace selvedge
