#include "collision/exact/polygon_signs.hpp"

namespace selvedge {
namespace {

struct Counts {
  int above = 0, below = 0;              // polynomials strictly of one sign throughout
  int never_above = 0, never_below = 0;  // of the other sign or zero
};

Counts count(const std::array<std::array<Signs, 3>, most_corners>& signs, int axis, int corners) {
  Counts c;
  for (int k = 0; k < corners; ++k) {
    c.above += signs[k][axis].lowest > 0;
    c.below += signs[k][axis].highest < 0;
    c.never_above += signs[k][axis].highest <= 0;
    c.never_below += signs[k][axis].lowest >= 0;
  }
  return c;
}

}  // namespace

bool is_free(const PolygonSigns& s) {
  if (s.volume.lowest > 0 || s.volume.highest < 0) return true;
  for (int axis = 0; axis < 3; ++axis) {
    const Counts coordinates = count(s.coordinate, axis, s.corners), turns = count(s.turn, axis, s.corners);
    if (coordinates.above == s.corners || coordinates.below == s.corners) return true;
    if (turns.above > 0 && turns.below > 0) return true;
  }
  return false;
}

bool is_certain(const PolygonSigns& s) {
  if (s.volume.first != 0 && s.volume.last != 0 && s.volume.first != -s.volume.last) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const Counts turns = count(s.turn, axis, s.corners);
    if (turns.above > 0 && turns.never_below == s.corners) return true;
    if (turns.below > 0 && turns.never_above == s.corners) return true;
  }
  return false;
}

bool touches_at_first(PolygonSigns s) {
  const auto keep_first = [](Signs& of) { of = {of.first, of.first, of.first, of.first}; };
  keep_first(s.volume);
  for (int k = 0; k < s.corners; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      keep_first(s.coordinate[k][axis]);
      keep_first(s.turn[k][axis]);
    }
  return !is_free(s);
}

}  // namespace selvedge
