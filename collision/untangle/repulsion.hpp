#pragma once

#include <span>
#include <vector>

#include "collision/contact/contact_pairs.hpp"
#include "collision/contour/segments.hpp"
#include "collision/untangle/input_shape.hpp"
#include "collision/untangle/separation.hpp"

namespace selvedge {

// Keeps pairs apart that are apart, while a cloth is untangled. Obstacles stand still.
class Repulsion {
 public:
  // Keeps references to all but the span itself.
  Repulsion(const Surface& cloth, std::span<const SheetView> obstacles, const InputShape& shape);

  // Vertex-face and edge-edge pairs nearer than `horizon` [m] that must stay `gap` [m] apart. Only pairs with a vertex
  // of reach > 0 count, and with a primitive that has no `tangled` vertex (of the cloth, if the pair is with an
  // obstacle), so that the pair is not on or inside a contour. Pairs that an edge joins keep 0.7 of their distance in
  // the input. wide: neither primitive may have a tangled vertex.
  std::vector<Separation> find(const Points& x, const std::vector<char>& tangled, const std::vector<double>& reach,
                               double gap, double horizon, bool wide);

 private:
  bool neighbours(const NodePair&) const;
  bool is_movable(const NodePair&, const std::vector<double>& reach) const;
  bool is_clear(const NodePair&, const std::vector<char>& tangled, bool wide) const;
  const InputShape& shape_;
  ContactWorld world_;
  std::vector<Points> obstacle_points_;
  Points input_;  // of all nodes
  PairSearch search_;
  std::vector<NodePair> pairs_;
};

}  // namespace selvedge
