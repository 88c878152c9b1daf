#include "collision/end_boxes.hpp"

namespace selvedge {

void set_end_boxes(std::span<const Bvh::Leaf> leaves, std::span<const Box> start, std::span<const Box> end,
                   EndLeaves& ends) {
  ends.start.assign(leaves.begin(), leaves.end());
  ends.end = ends.start;
  ends.bounds.resize(leaves.size());
  const int count = static_cast<int>(leaves.size());
#pragma omp parallel for schedule(static)
  for (int l = 0; l < count; ++l)
    ends.bounds[l] = {set_leaf_boxes(ends.start[l], start), set_leaf_boxes(ends.end[l], end)};
}

void set_end_boxes(const Bvh& tree, const EndLeaves& leaves, std::vector<EndBoxes>& nodes) {
  nodes.resize(tree.nodes.size());
  // Children lie behind their parents.
  for (int n = static_cast<int>(tree.nodes.size()) - 1; n >= 0; --n) {
    const int child = tree.nodes[n].child;
    nodes[n] = child < 0 ? leaves.bounds[~child]
                         : EndBoxes{join(nodes[child].start, nodes[child + 1].start),
                                    join(nodes[child].end, nodes[child + 1].end)};
  }
}

}  // namespace selvedge
