#pragma once

#include <optional>
#include <vector>

#include "collision/contour/contour.hpp"

namespace selvedge {

// Edges of a surface that curves cross: crossing one an odd number of times changes the colour.
class EdgeParity {
 public:
  explicit EdgeParity(const Surface& surface) : surface_(surface), odd_(surface.edges.rows(), 0) {}
  void add(const Contour&, int side);  // with a detour round loop vertices at its ends
  // Colours of the vertices of a component, 0 for the more frequent one; false if there is no colouring.
  bool colour(int component, std::vector<char>& colours) const;
  // The vertices of the rarer colour, sorted; nothing if there is no colouring, or both colours are as frequent. Takes
  // as long as the smaller parts are large, not the component, which has `size` vertices.
  std::optional<std::vector<int>> smaller_part(int component, int size) const;

 private:
  void flip(int edge);
  void add_detour(int vertex, int from_triangle, int to_triangle);
  const Surface& surface_;
  std::vector<char> odd_;
  std::vector<int> flipped_;  // every edge that is odd, and some that are no longer
};

// Of each connected component.
std::vector<int> component_sizes(const Surface&);

}  // namespace selvedge
