#include "collision/contour/edge_parity.hpp"

#include <algorithm>
#include <array>

#include "collision/contour/lockstep_flood.hpp"

namespace selvedge {

void EdgeParity::flip(int edge) {
  odd_[edge] ^= 1;
  flipped_.push_back(edge);
}

void EdgeParity::add(const Contour& contour, int side) {
  for (int edge : contour.sides[side].edges) flip(edge);
  if (side != 0) return;  // the other side has the same loop vertices
  for (int end = 0; end < 2; ++end) {
    if (contour.ends[end] != ContourEnd::vertex) continue;
    const int at = end == 0 ? contour.points.front() : contour.points.back();
    const auto triangle = [&](int s) {
      return end == 0 ? contour.sides[s].triangles.front() : contour.sides[s].triangles.back();
    };
    auto round = edges_round(surface_, ~at, triangle(0), triangle(1), true);
    if (!round) round = edges_round(surface_, ~at, triangle(0), triangle(1), false);
    if (!round) continue;
    for (const EdgeRound& passed : *round) flip(passed.edge);
  }
}

bool EdgeParity::colour(int component, std::vector<char>& colours) const {
  colours.assign(surface_.vertex_count, -1);
  long total = 0, ones = 0;
  bool consistent = true;
  for (int seed = 0; seed < surface_.vertex_count; ++seed) {
    if (surface_.component[seed] != component || colours[seed] >= 0) continue;
    std::vector<int> stack{seed};
    colours[seed] = 0;
    while (!stack.empty()) {
      const int v = stack.back();
      stack.pop_back();
      ++total;
      ones += colours[v];
      for (int t : surface_.triangles_of(v))
        for (int k = 0; k < 3; ++k) {
          const int edge = surface_.triangle_edges(t, k);
          const int a = surface_.edges(edge, 0), b = surface_.edges(edge, 1);
          if (a != v && b != v) continue;
          const int other = a == v ? b : a;
          const char expected = static_cast<char>(colours[v] ^ odd_[edge]);
          if (colours[other] < 0) {
            colours[other] = expected;
            stack.push_back(other);
          } else if (colours[other] != expected) {
            consistent = false;
          }
        }
    }
  }
  if (2 * ones > total)
    for (char& c : colours)
      if (c >= 0) c ^= 1;
  return consistent;
}

std::optional<std::vector<int>> EdgeParity::smaller_part(int component, int size) const {
  std::vector<int> edges;
  for (const int edge : flipped_)
    if (odd_[edge] && surface_.component[surface_.edges(edge, 0)] == component) edges.push_back(edge);
  std::vector<int> inside;
  if (edges.empty()) return size > 0 ? std::optional(inside) : std::nullopt;
  std::vector<int> owner(static_cast<std::size_t>(surface_.vertex_count), -1);
  LockstepFlood parts(surface_, odd_, owner);
  for (const int edge : edges)
    for (const int v : surface_.edges.row(edge))
      if (parts.front_of(v) < 0) parts.seed(v, parts.add_front());
  const int open = parts.grow(1);
  std::vector<std::array<int, 2>> joined;
  for (const int edge : edges)
    joined.push_back({parts.front_of(surface_.edges(edge, 0)), parts.front_of(surface_.edges(edge, 1))});
  const std::vector<int> colours = two_colours(parts.count(), joined, joined.front()[0]);
  if (colours.empty()) return std::nullopt;
  std::array<int, 2> counts{};
  int others = 0;
  for (int part = 0; part < parts.count(); ++part)
    if (part != open && parts.root(part) == part) {
      counts[colours[part]] += static_cast<int>(parts.reached(part).size());
      others += static_cast<int>(parts.reached(part).size());
    }
  if (open >= 0) counts[colours[open]] += size - others;
  if (counts[0] == counts[1]) return std::nullopt;
  const int rarer = counts[0] < counts[1] ? 0 : 1;
  if (open >= 0 && colours[open] == rarer) parts.grow(0);
  for (int part = 0; part < parts.count(); ++part)
    if (parts.root(part) == part && colours[part] == rarer)
      inside.insert(inside.end(), parts.reached(part).begin(), parts.reached(part).end());
  std::sort(inside.begin(), inside.end());
  return inside;
}

std::vector<int> component_sizes(const Surface& surface) {
  std::vector<int> sizes(surface.component_count, 0);
  for (const int component : surface.component) ++sizes[component];
  return sizes;
}

}  // namespace selvedge
