#include "collision/search/end_boxes.hpp"

namespace selvedge {

void EndLeaves::resize(std::size_t leaves) {
  start.resize(leaves);
  end.resize(leaves);
  bounds.resize(leaves);
}

void set_end_boxes(const Bvh::Leaf& leaf, std::span<const Box> start, std::span<const Box> end, int place,
                   EndLeaves& ends) {
  ends.start[place] = ends.end[place] = leaf;
  ends.bounds[place] = {set_leaf_boxes(ends.start[place], start), set_leaf_boxes(ends.end[place], end)};
}

void set_end_boxes(const Bvh& tree, const EndLeaves& leaves, std::vector<EndBoxes>& nodes) {
  nodes.resize(tree.nodes.size());
  // Children come after their parents.
  for (int n = static_cast<int>(tree.nodes.size()) - 1; n >= 0; --n) {
    const int child = tree.nodes[n].child;
    nodes[n] = child < 0 ? leaves.bounds[~child]
                         : EndBoxes{join(nodes[child].start, nodes[child + 1].start),
                                    join(nodes[child].end, nodes[child + 1].end)};
  }
}

}  // namespace selvedge
