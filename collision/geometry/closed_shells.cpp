#include "collision/geometry/closed_shells.hpp"

namespace selvedge {

std::vector<char> closed_shells(const Surface& s) {
  std::vector<char> closed(static_cast<std::size_t>(s.component_count), 0);
  for (const int v : s.triangles.reshaped()) closed[s.component[v]] = 1;
  const std::vector<int> faces = face_counts(s);
  for (Eigen::Index e = 0; e < s.edges.rows(); ++e)
    if (faces[e] != 2) closed[s.component[s.edges(e, 0)]] = 0;
  return closed;
}

}  // namespace selvedge
