#include "collision/search/end_boxes.hpp"

namespace selvedge {

void EndLeaves::resize(std::size_t leaves) {
  start.resize(leaves);
  end.resize(leaves);
}

void set_end_boxes(const Bvh& tree, std::span<const EndBoxes> leaves, std::vector<EndBoxes>& nodes) {
  nodes.resize(tree.nodes.size());
  // Children come after their parents.
  for (int n = static_cast<int>(tree.nodes.size()) - 1; n >= 0; --n) {
    const int child = tree.nodes[n].child;
    nodes[n] = child < 0 ? leaves[~child]
                         : EndBoxes{join(nodes[child].start, nodes[child + 1].start),
                                    join(nodes[child].end, nodes[child + 1].end)};
  }
}

}  // namespace selvedge
