#pragma once

#include <array>
#include <functional>
#include <vector>

#include "collision/search/bvh.hpp"
#include "collision/search/quiet.hpp"

namespace selvedge {

// What of a surface that passes through itself, or holds parts inside other parts, is on the outside of the whole:
// where the winding number just outside is under 1/2.
struct ExposedFaces {
  enum class Kind : char { whole, hidden, cut };
  using Piece = std::array<Vec3, 3>;
  std::vector<Kind> kind;        // by triangle; empty: all are whole
  std::vector<char> hidden;      // the same as flags
  std::vector<int> cut_place;    // of a cut triangle: its place in `piece_begin`; -1 of others
  std::vector<int> piece_begin;  // its exposed parts are pieces[piece_begin[i] .. piece_begin[i + 1])
  std::vector<Piece> pieces;     // triangles
  bool all_whole() const { return kind.empty(); }
};

// Whether the surface winds round each point: its winding number is over 1/2.
using WindsRound = std::function<std::vector<char>(const Points&)>;

// `tree` is fitted to x, and `parts` are its quiet ones there. Triangles that others cross are cut along the planes of
// these; crossings come from exact signs (contour/segments.hpp), so that what hangs together without a crossing is
// exposed or hidden as a whole.
ExposedFaces find_exposed(const Surface&, const Points& x, const Bvh& tree, const QuietParts& parts, const WindsRound&);

}  // namespace selvedge
