#pragma once

#include <span>
#include <vector>

#include "collision/contact_pairs.hpp"
#include "collision/kept_shape.hpp"
#include "collision/segments.hpp"
#include "collision/separation.hpp"

namespace selvedge {

// Keeps what is apart apart while a cloth is untangled. Obstacles stand still.
class Repulsion {
 public:
  // Keeps references to all but the span itself.
  Repulsion(const Surface& cloth, std::span<const SheetView> obstacles, const KeptShape& shape);

  // Vertex-face and edge-edge pairs nearer than `horizon` [m] that are to stay `gap` apart: some vertex has reach > 0,
  // none is `tangled`. Pairs of neighbours, whose distance is the shape's own, keep 0.7 of what they have in the input.
  std::vector<Separation> find(const Points& x, const std::vector<char>& tangled, const std::vector<double>& reach,
                               double gap, double horizon);

 private:
  bool neighbours(const NodePair&) const;
  const KeptShape& shape_;
  ContactWorld world_;
  std::vector<Points> obstacle_points_;
  PairSearch search_;
  std::vector<NodePair> pairs_;
};

}  // namespace selvedge
