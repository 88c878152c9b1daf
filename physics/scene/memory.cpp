#include "physics/scene/memory.hpp"

#include <algorithm>
#include <iterator>

#include "collision/contact/contact_world.hpp"

namespace selvedge {

const MemoryRows* find_rows(const Memory& memory, std::string_view name, Eigen::Index rows) {
  const auto block = std::ranges::find(memory, name, &MemoryBlock::name);
  return block != memory.end() && block->rows.rows() == rows ? &block->rows : nullptr;
}

void replace_blocks(std::string_view owner, Memory blocks, Memory& memory) {
  std::erase_if(memory, [owner](const MemoryBlock& block) {
    return std::string_view(block.name).substr(0, block.name.find('.')) == owner;
  });
  std::ranges::move(blocks, std::back_inserter(memory));
}

void forget_motion(Memory& memory) {
  std::erase_if(memory, [](const MemoryBlock& block) {
    return !block.positions && (block.rows_of == RowsOf::vertices || block.rows_of == RowsOf::triangles);
  });
}

Points joined_rows(const std::vector<Points>& parts) { return gather_nodes(Points(0, 3), parts); }

std::vector<Points> split_rows(const MemoryRows& joined, const std::vector<Points>& like) {
  std::vector<Points> parts;
  Eigen::Index first = 0;
  for (const Points& part : like) {
    parts.push_back(joined.middleRows(first, part.rows()));
    first += part.rows();
  }
  return parts;
}

}  // namespace selvedge
