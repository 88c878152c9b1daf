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
  double far_limit = 0.08;  // how far any other vertex may move, in its own mean edge or the mesh's, the shorter
  double gap = 0.02;        // distance kept between parted layers, in mean edge lengths
  double step = 0.25;       // largest motion asked for in one iteration, in mean edge lengths
  double least_stretch = 0.52, largest_stretch = 1.92;  // of every triangle relative to the input
  int sweeps = 12;       // An iteration smooths displacements and meets separations in this many sweeps.
  int remembered = 8;    // A step is shortened if its merit is above the largest of this many last iterations.
  int patience = 60;     // Untangling ends after this many iterations without a better state.
  int relaxations = 8;   // A clean cloth gives stretched triangles their shape back in at most this many rounds.
  double horizon = 0.2;  // Pairs repel within this many mean edge lengths: about how far an iteration moves vertices.
  // Optional hint: the layer of each component of the cloth, the innermost lowest. Of two layers the higher one belongs
  // on the side to which the other's normals point. Empty: the smaller side of a contour is the wrong one.
  std::vector<int> layers;
  // 1 for vertices that ignore obstacles. A contour with an obstacle is ignored if it runs through one of their
  // triangles. Empty: none.
  std::vector<char> let_through;
  std::vector<char> held;   // 1 for vertices that stay where they are, as pins do. Empty: none.
  bool second_rule = true;  // if stuck, try the second rule of repulsion: as many iterations again
  std::function<void(const UntangleProgress&)> progress;
  StopFlag stop = {};  // asked in each iteration: true ends it with the best state so far
};

struct UntangleResult {
  Points x;
  int pairs_before = 0, pairs_after = 0;                // triangles that share no vertex, touching ones included
  int vertex_pairs_before = 0, vertex_pairs_after = 0;  // triangles that share one vertex and cross
  double length_before = 0, length_after = 0;           // of all contours [m]
  int iterations = 0;
  int moved = 0;                       // vertices moved by more than a millionth of an edge
  double mean_edge = 0;                // of the input [m]
  double mean_move = 0, max_move = 0;  // of moved vertices, in mean edge lengths
  double far_move = 0;                 // largest among vertices that may not move freely, in units of far_limit
  double least_stretch = 1, largest_stretch = 1;  // singular values relative to the input
  std::vector<Remainder> left;
};

// Parts a cloth from itself and from obstacles that stand still. Enclosed regions are pushed through to the other side
// (Baraff, Witkin and Kass 2003); where nothing is enclosed, the two sides of a contour are moved apart along the
// translational gradient of its length, averaged over the contour (Volino and Magnenat-Thalmann 2006). Vertices inside
// a closed obstacle go to its nearest point. Displacements are kept smooth and triangles near their shape in the input.
// Pairs that are neither on nor inside a contour repel each other. The merit of a state is the total length of its
// contours, plus a mean edge for each vertex inside a closed obstacle. A step is shortened, at most twice, while its
// merit is above the largest of the last few steps. The result is the best state that was seen. Needs no history, is
// deterministic. All vertices must be finite.
UntangleResult untangle(const Surface& cloth, const Points& x, std::span<const SheetView> obstacles,
                        const UntangleOptions& options = {});

}  // namespace selvedge
