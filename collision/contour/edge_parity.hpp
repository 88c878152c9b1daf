#pragma once

#include <optional>
#include <vector>

#include "collision/contour/contour.hpp"

namespace selvedge {

// Which edges of a surface are crossed by curves an odd number of times: the two ends of such an edge differ in colour.
class EdgeParity {
 public:
  explicit EdgeParity(const Surface& surface) : surface_(surface), odd_(surface.edges.rows(), 0) {}
  void add(const Contour&, int side);  // goes round loop vertices at its ends
  // Colours of the vertices of a component, 0 for the more frequent one; false if there is no colouring.
  bool colour(int component, std::vector<char>& colours) const;
  // The vertices of the rarer colour, sorted; nothing if there is no colouring, or if both colours are equally
  // frequent. `size` is the component's number of vertices. The time grows with the smaller parts, not with the
  // component.
  std::optional<std::vector<int>> smaller_part(int component, int size) const;

 private:
  void flip(int edge);
  const Surface& surface_;
  std::vector<char> odd_;
  std::vector<int> flipped_;  // every odd edge, and some that were odd before
};

// The number of vertices of each connected component.
std::vector<int> component_sizes(const Surface&);

}  // namespace selvedge
