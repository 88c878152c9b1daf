#pragma once

#include <array>
#include <vector>

#include "collision/contact/contact_world.hpp"

namespace selvedge {

// What contact leaves alone: contact that keeps a clean state clean would keep a tangled one tangled. Each list has 1
// for vertices or nodes to which it applies, and is empty if there is none.
struct Exemption {
  std::vector<char> self;  // of the cloth's vertices: on or inside a contour of the cloth with itself
  std::vector<char> body;  // of the cloth's vertices: on a contour with an obstacle, or inside a closed one
  // Of all nodes: caught vertices of the cloth, and vertices of obstacles where faces are switched off (caught.hpp).
  std::vector<char> switched_off;

  bool tangled() const { return !self.empty() || !body.empty(); }
  int tangled_vertices() const;  // with self or body
  bool any() const { return tangled() || !switched_off.empty(); }
  bool leaves_alone(const ContactWorld&, const std::array<int, 4>& nodes) const;
};

// 1 where a or b has 1; empty if both are empty.
std::vector<char> either(std::vector<char> a, const std::vector<char>& b);

}  // namespace selvedge
