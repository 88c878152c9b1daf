#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// What the rows of a block of memory belong to: a part of a scene takes its own of them (part_of_scene.hpp).
enum class RowsOf { none, vertices, triangles, obstacle_vertices, cloths };

using MemoryRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Something that one stepper alone reads in its next step. A checkpoint writes it, a part of a scene slices it, and a
// vertex without mass takes its place along (following_stepper.hpp), without knowing it.
struct MemoryBlock {
  std::string name;  // "stepper.quantity"
  MemoryRows rows;
  RowsOf rows_of = RowsOf::none;
  bool positions = false;  // the rows are places [m]: cloth that a step leaves out has its own, zeros otherwise
};
using Memory = std::vector<MemoryBlock>;

// The rows of a block; null where there is none of that name with so many rows.
const MemoryRows* find_rows(const Memory&, std::string_view name, Eigen::Index rows);

// Puts blocks in the place of all those that have the same owner, the part of a name before the dot.
void replace_blocks(std::string_view owner, Memory blocks, Memory&);

// Takes away what tells how the cloth moved: blocks of vertices or triangles that are no positions.
void forget_motion(Memory&);

// All obstacles' rows, one behind the other, and back.
Points joined_rows(const std::vector<Points>&);
std::vector<Points> split_rows(const MemoryRows& joined, const std::vector<Points>& like);

}  // namespace selvedge
