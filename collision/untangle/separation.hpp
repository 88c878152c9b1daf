#pragma once

#include <span>
#include <vector>

#include "collision/contour/contour_regions.hpp"

namespace selvedge {

// direction . sum w_i x_i >= least over vertices of the cloth; what stands still is in `least` already.
struct Separation {
  std::array<int, 5> vertex{-1, -1, -1, -1, -1};
  std::array<double, 5> weight{};
  Vec3 direction;
  double least = 0;
  int count = 0;
};

// Of the cloth against an obstacle: its weights sum to 1 or -1, and to 0 where cloth goes against cloth.
bool is_against_obstacle(const Separation&);

struct SeparationLengths {
  double gap = 0, step = 0;  // [m]
};

// Turns regions over that an order of layers contradicts: of two components of the cloth the one with the higher number
// belongs on the side that the other's normals point to. Regions of open contours and of equal layers stay.
void order_layers(std::span<const SheetView> sheets, const Segments&, std::span<const Contour>,
                  const std::vector<int>& layers, std::vector<Region>& regions);

// What the cloth (sheets[0]) would have to do to lose its contours: vertices on the wrong side go toward the right one
// by at most a step, the two sides of contours without such vertices apart along the averaged translational gradient.
// `buried`: of each obstacle, by triangle, what does not face its outside (buried.hpp): nothing is pushed out to that.
std::vector<Separation> part_contours(std::span<const SheetView> sheets, const Segments&, std::span<const Contour>,
                                      std::span<const Region>, const SeparationLengths&,
                                      std::span<const std::vector<char>> buried = {});

// 1 at vertices of the cloth inside a closed obstacle; isolated ones count nowhere.
std::vector<char> inside_obstacles(std::span<const SheetView> sheets);

}  // namespace selvedge
