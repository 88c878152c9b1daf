#include "collision/contour/contour_regions.hpp"

#include <algorithm>
#include <iterator>
#include <map>

#include "collision/contour/edge_parity.hpp"
#include "collision/contour/open_sides.hpp"
#include "collision/exact/inside.hpp"
#include "collision/geometry/closed_shells.hpp"

namespace selvedge {

bool ends_outside(const Contour& contour, int side) {
  if (contour.closed) return true;
  for (int end = 0; end < 2; ++end) {
    if (contour.ends[end] == ContourEnd::branch) return false;
    if (contour.ends[end] == ContourEnd::boundary && contour.end_side[end] != side) return false;
  }
  return true;
}

namespace {

// A contour's curve on one side, or on both sides where these are on one component and form one curve.
struct Trace {
  const Contour* contour;
  std::array<bool, 2> sides;
};

bool ends_at_vertex(const Contour& contour) {
  return contour.ends[0] == ContourEnd::vertex || contour.ends[1] == ContourEnd::vertex;
}

void add_traces(const Contour& contour, const LayerPair& key, std::vector<Trace>& traces) {
  const bool together = ends_at_vertex(contour) || contour.one_trace;
  std::array<bool, 2> here{};
  for (int side = 0; side < 2; ++side) here[side] = layers_of(contour, side) == key;
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

// Colours by all closed traces together, or if that fails by those that cut the component on their own.
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

std::vector<int> either_of(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> both;
  std::ranges::set_union(a, b, std::back_inserter(both));
  return both;
}

}  // namespace

std::vector<Region> enclosed_regions(std::span<const SheetView> sheets, const Segments& found,
                                     std::span<const Contour> contours) {
  const OpenSides open = open_sides(sheets, found, contours);
  std::map<LayerPair, std::vector<int>> groups;
  for (int c = 0; c < static_cast<int>(contours.size()); ++c)
    for (int side = 0; side < 2; ++side) {
      std::vector<int>& group = groups[layers_of(contours[c], side)];
      if (group.empty() || group.back() != c) group.push_back(c);
    }
  std::vector<Region> regions;
  for (const auto& [key, group] : groups) {
    Region region{key.sheet, key.component, key.partner_sheet, key.partner_component, group, {}, true};
    std::vector<Trace> traces;
    for (int c : group)
      if (!open.decided[c])
        add_traces(contours[c], key, traces);
      else
        region.cut = false;
    const Surface& surface = *sheets[key.sheet].surface;
    const std::vector<char> colours = colour_together(surface, key.component, traces, region.cut);
    const bool closed_partner = key.sheet == 0 && key.partner_sheet > 0 &&
                                closed_shells(*sheets[key.partner_sheet].surface)[key.partner_component];
    const std::vector<char> in =
        closed_partner ? inside(*sheets[key.partner_sheet].surface, *sheets[key.partner_sheet].x, *sheets[0].x)
                       : std::vector<char>();
    for (int v = 0; v < surface.vertex_count; ++v)
      if (closed_partner ? colours[v] >= 0 && in[v] : colours[v] == 1) region.vertices.push_back(v);
    if (const auto wrong = open.wrong.find(key); wrong != open.wrong.end() && !closed_partner)
      region.vertices = either_of(region.vertices, wrong->second);
    regions.push_back(std::move(region));
  }
  return regions;
}

}  // namespace selvedge
