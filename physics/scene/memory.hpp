#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// What the rows of a block of memory belong to. A part of a scene takes the rows that belong to it (part_of_scene.hpp).
enum class RowsOf { none, vertices, triangles, obstacle_vertices, cloths };

using MemoryRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Data that one stepper alone reads in its next step. Checkpoints write it, parts of a scene slice it, and followers
// (following_stepper.hpp) update places in it, all without knowing its meaning.
struct MemoryBlock {
  std::string name;  // "stepper.quantity"
  MemoryRows rows;
  RowsOf rows_of = RowsOf::none;
  bool positions = false;  // the rows are positions [m]: cloth that a step leaves out has its own; in other blocks 0
};
using Memory = std::vector<MemoryBlock>;

// The rows of a block; null if there is no block of that name with so many rows.
const MemoryRows* find_rows(const Memory&, std::string_view name, Eigen::Index rows);

// Replaces all blocks of an owner. The owner is the part of a name before the dot.
void replace_blocks(std::string_view owner, Memory blocks, Memory&);

// Removes blocks that describe the cloth's motion: those of vertices or triangles that are not positions.
void forget_motion(Memory&);

// The rows of all obstacles, one after the other, and back. `like` gives the numbers of rows.
Points joined_rows(const std::vector<Points>&);
std::vector<Points> split_rows(const MemoryRows& joined, const std::vector<Points>& like);

}  // namespace selvedge
