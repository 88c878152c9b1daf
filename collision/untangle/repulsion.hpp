#pragma once

#include <span>
#include <vector>

#include "collision/contact/contact_pairs.hpp"
#include "collision/contour/segments.hpp"
#include "collision/untangle/kept_shape.hpp"
#include "collision/untangle/separation.hpp"

namespace selvedge {

// Keeps what is apart apart while a cloth is untangled. Obstacles stand still.
class Repulsion {
 public:
  // Keeps references to all but the span itself.
  Repulsion(const Surface& cloth, std::span<const SheetView> obstacles, const KeptShape& shape);

  // Vertex-face and edge-edge pairs nearer than `horizon` [m] that are to stay `gap` apart: some vertex has reach > 0,
  // and one of the two primitives has no `tangled` vertex, so that the pair is not on or inside a contour. Pairs of
  // neighbours, whose distance is the shape's own, keep 0.7 of what they have in the input. wide: both primitives must
  // be free of tangled vertices.
  std::vector<Separation> find(const Points& x, const std::vector<char>& tangled, const std::vector<double>& reach,
                               double gap, double horizon, bool wide);

 private:
  bool neighbours(const NodePair&) const;
  bool is_movable(const NodePair&, const std::vector<double>& reach) const;
  bool is_clear(const NodePair&, const std::vector<char>& tangled, bool wide) const;
  const KeptShape& shape_;
  ContactWorld world_;
  std::vector<Points> obstacle_points_;
  Points input_;  // of all nodes
  PairSearch search_;
  std::vector<NodePair> pairs_;
};

}  // namespace selvedge
