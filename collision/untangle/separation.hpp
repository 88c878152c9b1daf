#pragma once

#include <span>
#include <vector>

#include "collision/contour/contour_regions.hpp"

namespace selvedge {

// The demand direction . sum w_i x_i >= least over vertices i of the cloth. Points that stand still are included in
// `least`.
struct Separation {
  std::array<int, 5> vertex{-1, -1, -1, -1, -1};
  std::array<double, 5> weight{};
  Vec3 direction;
  double least = 0;
  int count = 0;
};

// True for cloth against an obstacle: the weights sum to 1 or -1. For cloth against cloth they sum to 0.
bool is_against_obstacle(const Separation&);

struct SeparationLengths {
  double gap = 0, step = 0;  // [m]
};

// Replaces regions by their complement where they contradict an order of layers: of two components of the cloth, the
// one with the higher number in `layers` belongs on the side to which the other's normals point. Regions of open
// contours and of equal layers stay.
void order_layers(std::span<const SheetView> sheets, const Segments&, std::span<const Contour>,
                  const std::vector<int>& layers, std::vector<Region>& regions);

// The demands on the cloth (sheets[0]) that remove its contours. Vertices on the wrong side move toward the right one,
// by at most `step`. Where a contour has no such vertices, its two sides move apart along the averaged translational
// gradient. `buried`: of each obstacle, by triangle, 1 if it faces no outside (buried.hpp); vertices are not pushed out
// toward these.
std::vector<Separation> part_contours(std::span<const SheetView> sheets, const Segments&, std::span<const Contour>,
                                      std::span<const Region>, const SeparationLengths&,
                                      std::span<const std::vector<char>> buried = {});

// 1 for vertices of the cloth inside a closed obstacle; 0 for isolated vertices.
std::vector<char> inside_obstacles(std::span<const SheetView> sheets);

}  // namespace selvedge
