#pragma once

#include <functional>
#include <span>
#include <vector>

#include "collision/geometry/stop_flag.hpp"
#include "collision/untangle/remainder.hpp"

namespace selvedge {

struct UntangleProgress {
  int iteration = 0, pairs = 0;
  double length = 0;  // of all contours [m]
};

struct UntangleOptions {
  int iterations = 300;
  int rings = 3;            // of vertices round contours and enclosed regions that may move freely
  double far_limit = 0.08;  // how far any other vertex may move, in its own edges or mean ones, the shorter
  double gap = 0.02;        // between what has been parted, in mean edge lengths
  double step = 0.25;       // largest motion asked for in one iteration, in mean edge lengths
  double least_stretch = 0.52, largest_stretch = 1.92;  // of every triangle against the input
  int sweeps = 12;       // An iteration smooths displacements and meets separations in this many sweeps.
  int remembered = 8;    // A step must stay below the largest merit of this many last iterations.
  int patience = 60;     // Untangling ends after this many iterations without a better state.
  int relaxations = 8;   // A clean cloth gives stretched triangles their shape back in at most this many rounds.
  double horizon = 0.2;  // Pairs repel within this many mean edge lengths: about how far an iteration moves vertices.
  // Hint: a place for each component of the cloth, the innermost lowest; of two layers the higher one belongs on the
  // side that the other's normals point to. Empty: the smaller side of a contour is the wrong one.
  std::vector<int> layers;
  // 1 for vertices that obstacles neither meet nor hold, there or anywhere along a contour; the cloth itself does.
  // Empty: none.
  std::vector<char> let_through;
  std::vector<char> held;      // 1 for vertices that stay where they are, as pins do. Empty: none.
  bool second_opinion = true;  // of what repels near a contour, where the first gets stuck: as many iterations again
  std::function<void(const UntangleProgress&)> progress;
  StopFlag stop = {};  // asked once an iteration: true ends it with the best that was seen
};

struct UntangleResult {
  Points x;
  int pairs_before = 0, pairs_after = 0;                // triangles that share no vertex, touching included
  int vertex_pairs_before = 0, vertex_pairs_after = 0;  // triangles that share one vertex and cross
  double length_before = 0, length_after = 0;           // of all contours [m]
  int iterations = 0;
  int moved = 0;                                  // vertices moved by more than a millionth of an edge
  double mean_edge = 0;                           // of the input [m]
  double mean_move = 0, max_move = 0;             // of these, in mean edge lengths
  double far_move = 0;                            // largest among vertices that are not free to move, as far_limit
  double least_stretch = 1, largest_stretch = 1;  // singular values against the input
  std::vector<Remainder> left;
};

// Parts a cloth from itself and from obstacles that stand still. Enclosed regions are pushed through to the other side
// (Baraff, Witkin and Kass 2003); where nothing is enclosed, the two sides of a contour are moved apart along the
// translational gradient of its length, averaged over the contour (Volino and Magnenat-Thalmann 2006). Vertices inside
// a closed obstacle go to its nearest point. Displacements are kept smooth and the triangles near the shape of the
// input. Pairs that are neither on nor inside a contour repel each other. A step is taken if the total length of the
// contours (and a mean edge for each vertex inside a closed obstacle) stays below what it was at most a few steps ago,
// else a shorter one; the best state that was seen is the result. Needs no history, is deterministic.
// All vertices must be finite.
UntangleResult untangle(const Surface& cloth, const Points& x, std::span<const SheetView> obstacles,
                        const UntangleOptions& options = {});

}  // namespace selvedge
