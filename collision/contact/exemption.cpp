#include "collision/contact/exemption.hpp"

#include <algorithm>

namespace selvedge {

int Exemption::tangled_vertices() const {
  int count = 0;
  for (std::size_t v = 0; v < std::max(self.size(), body.size()); ++v)
    count += (!self.empty() && self[v]) || (!body.empty() && body[v]);
  return count;
}

// A pair of cloth with cloth is left alone only if all of its vertices are tangled: pairs that are clean stay clean.
// With an obstacle one tangled vertex is enough, or one caught vertex if all of the obstacle's nodes are switched off.
bool Exemption::leaves_alone(const ContactWorld& world, const std::array<int, 4>& nodes) const {
  bool self_alone = !self.empty(), body_alone = false, all_cloth = true, all_switched_off = !switched_off.empty(),
       any_caught = false;
  for (const int node : nodes) {
    if (!world.is_cloth(node)) {
      all_cloth = false;
      all_switched_off = all_switched_off && switched_off[node];
      continue;
    }
    self_alone = self_alone && self[node];
    body_alone = body_alone || (!body.empty() && body[node]);
    any_caught = any_caught || (!switched_off.empty() && switched_off[node]);
  }
  return all_cloth ? self_alone : body_alone || (all_switched_off && any_caught);
}

std::vector<char> either(std::vector<char> a, const std::vector<char>& b) {
  if (a.empty()) return b;
  for (std::size_t v = 0; v < b.size(); ++v) a[v] = a[v] || b[v];
  return a;
}

}  // namespace selvedge
