#pragma once

#include <array>
#include <vector>

#include "collision/contact/contact_world.hpp"

namespace selvedge {

// What contact leaves alone: the mechanisms that keep a clean state clean would keep a tangled one tangled. All 1 where
// it applies; empty where nothing does.
struct Exemption {
  std::vector<char> self;  // of the cloth's vertices: on or inside a contour of the cloth with itself
  std::vector<char> body;  // of the cloth's vertices: on a contour with an obstacle, or inside a closed one
  std::vector<char>
      off;  // of all nodes: caught ones of the cloth, and the obstacle's where it crosses itself there (caught.hpp)

  bool cloth() const { return !self.empty() || !body.empty(); }
  int cloth_vertices() const;  // how many of them
  bool any() const { return cloth() || !off.empty(); }
  bool leaves_alone(const ContactWorld&, const std::array<int, 4>& nodes) const;
};

// Marks of either; empty where neither has any.
std::vector<char> either(std::vector<char> a, const std::vector<char>& b);

}  // namespace selvedge
