#include "collision/geometry/turned_alike.hpp"

namespace selvedge {
namespace {

// Do both triangles of an edge run along it in the same direction?
bool same_direction(const Surface& surface, int edge, int a, int b) {
  const int i = surface.side_of(a, edge), j = surface.side_of(b, edge);
  return surface.triangles(a, i) == surface.triangles(b, j);
}

}  // namespace

TurnedAlike turned_alike(const Surface& surface) {
  const int count = static_cast<int>(surface.triangles.rows());
  const std::vector<int> uses = face_counts(surface);
  TurnedAlike alike{std::vector<signed char>(static_cast<std::size_t>(count), 0),
                    std::vector<int>(static_cast<std::size_t>(count), -1),
                    {}};
  for (int seed = 0; seed < count; ++seed) {
    if (alike.turn[seed] != 0) continue;
    const int part = alike.parts();
    bool orientable = true;
    alike.turn[seed] = 1;
    for (std::vector<int> stack{seed}; !stack.empty();) {
      const int t = stack.back();
      stack.pop_back();
      alike.part[t] = part;
      for (int k = 0; k < 3; ++k) {
        const int edge = surface.triangle_edges(t, k);
        const int next = surface.across(edge, t);
        if (uses[edge] > 2) orientable = false;
        if (next < 0 || next == t) continue;
        const int wanted = same_direction(surface, edge, t, next) ? -alike.turn[t] : alike.turn[t];
        if (alike.turn[next] == 0) {
          alike.turn[next] = static_cast<signed char>(wanted);
          stack.push_back(next);
        } else if (alike.turn[next] != wanted) {
          orientable = false;
        }
      }
    }
    alike.orientable.push_back(orientable);
  }
  return alike;
}

}  // namespace selvedge
