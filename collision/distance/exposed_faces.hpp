#pragma once

#include <array>
#include <functional>
#include <vector>

#include "collision/search/bvh.hpp"
#include "collision/search/quiet.hpp"

namespace selvedge {

// The exposed parts of a surface that passes through itself, or has parts inside other parts: a place is exposed where
// the winding number just outside of it is below 1/2.
struct ExposedFaces {
  enum class Kind : char { whole, hidden, cut };
  using Piece = std::array<Vec3, 3>;
  std::vector<Kind> kind;        // by triangle; empty: all are whole
  std::vector<char> hidden;      // 1 where kind is hidden
  std::vector<int> cut_place;    // of a cut triangle: its place in `piece_begin`; -1 of others
  std::vector<int> piece_begin;  // its exposed parts are pieces[piece_begin[i] .. piece_begin[i + 1])
  std::vector<Piece> pieces;     // triangles
  bool all_whole() const { return kind.empty(); }
};

// For each point 1 if the surface winds round it: its winding number is over 1/2.
using WindsRound = std::function<std::vector<char>(const Points&)>;

// `tree` must be fitted to x, and `parts` marked there (quiet.hpp). A triangle that others cross is cut along their
// planes. Crossings come from exact signs (contour/segments.hpp), so that a connected piece without crossings is
// exposed or hidden as a whole.
ExposedFaces find_exposed(const Surface&, const Points& x, const Bvh& tree, const QuietParts& parts, const WindsRound&);

}  // namespace selvedge
