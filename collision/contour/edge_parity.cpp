#include "collision/contour/edge_parity.hpp"

#include <algorithm>
#include <array>

namespace selvedge {
namespace {

int corner_of(const Surface& surface, int triangle, int vertex) {
  for (int k = 0; k < 3; ++k)
    if (surface.triangles(triangle, k) == vertex) return k;
  return -1;
}

int across(const Surface& surface, int edge, int triangle) {
  const std::array<int, 2>& two = surface.edge_triangles[edge];
  return two[0] == triangle ? two[1] : two[0];
}

// Collects the edges at a vertex between two of its triangles, going round in one direction. False if a boundary or a
// branching edge comes between.
bool fan(const Surface& surface, int vertex, int from, int to, bool forward, std::vector<int>& edges) {
  edges.clear();
  int previous = -1;
  for (int t = from; t != to;) {
    const int k = corner_of(surface, t, vertex);
    if (k < 0) return false;
    const int ahead = surface.triangle_edges(t, k), behind = surface.triangle_edges(t, (k + 2) % 3);
    const int edge = previous < 0 ? (forward ? ahead : behind) : (ahead == previous ? behind : ahead);
    edges.push_back(edge);
    previous = edge;
    t = across(surface, edge, t);
    if (t < 0 || t == from || edges.size() > static_cast<std::size_t>(surface.triangles_of(vertex).size()))
      return false;
  }
  return true;
}

}  // namespace

void EdgeParity::add_detour(int vertex, int from_triangle, int to_triangle) {
  std::vector<int> edges;
  if (!fan(surface_, vertex, from_triangle, to_triangle, true, edges) &&
      !fan(surface_, vertex, from_triangle, to_triangle, false, edges))
    return;
  for (int edge : edges) flip(edge);
}

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
    add_detour(~at, triangle(0), triangle(1));
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

namespace {

// Connected parts of a component without odd edges, grown from both ends of every odd edge. All grow at the same pace,
// so that small parts are complete before the largest one.
class Parts {
 public:
  Parts(const Surface& surface, const std::vector<char>& odd)
      : surface_(surface), odd_(odd), owner_(surface.vertex_count, -1) {}

  void seed(int vertex) {
    if (owner_[vertex] >= 0) return;
    owner_[vertex] = static_cast<int>(fronts_.size());
    root_.push_back(owner_[vertex]);
    fronts_.push_back({vertex});
    reached_.push_back({vertex});
  }
  int of(int vertex) { return root(owner_[vertex]); }
  // Grows until at most `open` parts have vertices left to go on from. Returns one of these parts, or -1.
  int grow(int open) {
    for (;;) {
      int growing = 0, last = -1;
      for (int f = 0; f < static_cast<int>(fronts_.size()); ++f)
        if (!fronts_[f].empty()) {
          ++growing;
          last = f;
        }
      if (growing <= open) return last;
      for (int f = 0; f < static_cast<int>(fronts_.size()); ++f)
        if (!fronts_[f].empty()) expand(f);
    }
  }
  int count() const { return static_cast<int>(root_.size()); }
  int root(int part) {
    while (root_[part] != part) part = root_[part] = root_[root_[part]];
    return part;
  }
  const std::vector<int>& reached(int part) const { return reached_[part]; }  // part: a root

 private:
  void expand(int f) {
    const int v = fronts_[f].back();
    fronts_[f].pop_back();
    for (const int t : surface_.triangles_of(v))
      for (int k = 0; k < 3; ++k) {
        const int edge = surface_.triangle_edges(t, k), a = surface_.edges(edge, 0), b = surface_.edges(edge, 1);
        if ((a != v && b != v) || odd_[edge]) continue;
        const int other = a == v ? b : a;
        if (owner_[other] < 0) {
          owner_[other] = f;
          fronts_[f].push_back(other);
          reached_[f].push_back(other);
        } else if (const int to = root(owner_[other]); to != f) {
          root_[to] = f;
          for (auto* lists : {&fronts_, &reached_}) {
            (*lists)[f].insert((*lists)[f].end(), (*lists)[to].begin(), (*lists)[to].end());
            (*lists)[to].clear();
          }
        }
      }
  }

  const Surface& surface_;
  const std::vector<char>& odd_;
  std::vector<int> owner_, root_;
  std::vector<std::vector<int>> fronts_, reached_;
};

// Colours 0 and 1 of parts so that every odd edge joins different colours; empty if there is no such colouring.
std::vector<char> two_colours(Parts& parts, const std::vector<std::array<int, 2>>& joined) {
  std::vector<std::vector<int>> beside(parts.count());
  for (const auto& [a, b] : joined) {
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  std::vector<char> colours(parts.count(), -1);
  std::vector<int> stack{joined.front()[0]};
  colours[stack.back()] = 0;
  while (!stack.empty()) {
    const int part = stack.back();
    stack.pop_back();
    for (const int other : beside[part]) {
      if (colours[other] == colours[part]) return {};
      if (colours[other] >= 0) continue;
      colours[other] = static_cast<char>(1 - colours[part]);
      stack.push_back(other);
    }
  }
  return colours;
}

}  // namespace

std::optional<std::vector<int>> EdgeParity::smaller_part(int component, int size) const {
  Parts parts(surface_, odd_);
  std::vector<int> edges;
  for (const int edge : flipped_)
    if (odd_[edge] && surface_.component[surface_.edges(edge, 0)] == component) edges.push_back(edge);
  std::vector<int> inside;
  if (edges.empty()) return size > 0 ? std::optional(inside) : std::nullopt;
  for (const int edge : edges)
    for (int k = 0; k < 2; ++k) parts.seed(surface_.edges(edge, k));
  const int open = parts.grow(1);
  std::vector<std::array<int, 2>> joined;
  for (const int edge : edges) joined.push_back({parts.of(surface_.edges(edge, 0)), parts.of(surface_.edges(edge, 1))});
  const std::vector<char> colours = two_colours(parts, joined);
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
  const char rarer = counts[0] < counts[1] ? 0 : 1;
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
