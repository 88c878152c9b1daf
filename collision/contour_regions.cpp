#include "collision/contour_regions.hpp"

#include <algorithm>
#include <map>

#include "collision/inside.hpp"

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

// Edges at a vertex passed on the way from one triangle of it to another, turning one way; false if a boundary or a
// branch comes between.
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
  for (int edge : edges) odd_[edge] ^= 1;
}

void EdgeParity::add(const Contour& contour, int side) {
  for (int edge : contour.sides[side].edges) odd_[edge] ^= 1;
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

bool ends_outside(const Contour& contour, int side) {
  if (contour.closed) return true;
  for (int end = 0; end < 2; ++end) {
    if (contour.ends[end] == ContourEnd::branch) return false;
    if (contour.ends[end] == ContourEnd::boundary && contour.end_side[end] != side) return false;
  }
  return true;
}

namespace {

struct Key {
  int sheet, component, partner_sheet, partner_component;
  auto operator<=>(const Key&) const = default;
};

Key key_of(const Contour& contour, int side) {
  const ContourSide &own = contour.sides[side], &other = contour.sides[1 - side];
  return {own.sheet, own.component, other.sheet, other.component};
}

// A contour on one of its sides, or on both where both lie on the same component and belong together.
struct Trace {
  const Contour* contour;
  std::array<bool, 2> sides;
};

bool ends_at_vertex(const Contour& contour) {
  return contour.ends[0] == ContourEnd::vertex || contour.ends[1] == ContourEnd::vertex;
}

void add_traces(const Contour& contour, const Key& key, std::vector<Trace>& traces) {
  const bool together = ends_at_vertex(contour) || contour.one_trace;
  std::array<bool, 2> here{};
  for (int side = 0; side < 2; ++side) here[side] = key_of(contour, side) == key;
  if (here[0] && here[1] && together) {
    traces.push_back({&contour, {true, true}});
    return;
  }
  for (int side = 0; side < 2; ++side)
    if (here[side]) traces.push_back({&contour, {side == 0, side == 1}});
}

bool is_cycle(const Trace& trace) {
  return (!trace.sides[0] || ends_outside(*trace.contour, 0)) && (!trace.sides[1] || ends_outside(*trace.contour, 1));
}

void add(EdgeParity& parity, const Trace& trace) {
  for (int side = 0; side < 2; ++side)
    if (trace.sides[side]) parity.add(*trace.contour, side);
}

// All cycles together, or those that part the component on their own.
std::vector<char> colour_together(const Surface& surface, int component, const std::vector<Trace>& traces, bool& cut) {
  std::vector<char> colours;
  EdgeParity all(surface);
  for (const Trace& trace : traces)
    if (is_cycle(trace))
      add(all, trace);
    else
      cut = false;
  if (all.colour(component, colours)) return colours;
  cut = false;
  EdgeParity some(surface);
  for (const Trace& trace : traces) {
    EdgeParity alone(surface);
    add(alone, trace);
    if (is_cycle(trace) && alone.colour(component, colours)) add(some, trace);
  }
  some.colour(component, colours);
  return colours;
}

}  // namespace

std::vector<Region> enclosed_regions(std::span<const SheetView> sheets, std::span<const Contour> contours) {
  std::map<Key, std::vector<int>> groups;
  for (int c = 0; c < static_cast<int>(contours.size()); ++c)
    for (int side = 0; side < 2; ++side) {
      std::vector<int>& group = groups[key_of(contours[c], side)];
      if (group.empty() || group.back() != c) group.push_back(c);
    }
  std::vector<Region> regions;
  for (const auto& [key, group] : groups) {
    Region region{key.sheet, key.component, key.partner_sheet, key.partner_component, group, {}, true};
    std::vector<Trace> traces;
    for (int c : group) add_traces(contours[c], key, traces);
    const Surface& surface = *sheets[key.sheet].surface;
    const std::vector<char> colours = colour_together(surface, key.component, traces, region.cut);
    const bool closed_partner =
        key.sheet == 0 && key.partner_sheet > 0 && is_closed(*sheets[key.partner_sheet].surface);
    const std::vector<char> in =
        closed_partner ? inside(*sheets[key.partner_sheet].surface, *sheets[key.partner_sheet].x, *sheets[0].x)
                       : std::vector<char>();
    for (int v = 0; v < surface.vertex_count; ++v)
      if (closed_partner ? colours[v] >= 0 && in[v] : colours[v] == 1) region.vertices.push_back(v);
    regions.push_back(std::move(region));
  }
  return regions;
}

}  // namespace selvedge
