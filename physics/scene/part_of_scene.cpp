#include "physics/scene/part_of_scene.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "physics/scene/contact_forces.hpp"
#include "physics/scene/joint_lists.hpp"

namespace selvedge {
namespace {

// The numbers of the rows of a block that the part has; null: all.
const std::vector<int>* numbers_of(const PartOfScene& part, RowsOf rows_of) {
  return rows_of == RowsOf::vertices    ? &part.vertices
         : rows_of == RowsOf::triangles ? &part.triangles
         : rows_of == RowsOf::cloths    ? &part.cloths
                                        : nullptr;
}

Memory memory_of_part(const PartOfScene& part, const Memory& whole) {
  Memory memory;
  for (const MemoryBlock& block : whole) {
    memory.push_back(block);
    if (const std::vector<int>* numbers = numbers_of(part, block.rows_of))
      memory.back().rows = block.rows(*numbers, Eigen::all);
  }
  return memory;
}

Memory memory_of_whole(const PartOfScene& part, Memory memory, const Points& x) {
  for (MemoryBlock& block : memory) {
    const std::vector<int>* numbers = numbers_of(part, block.rows_of);
    if (!numbers) continue;
    const Eigen::Index count = block.rows_of == RowsOf::vertices    ? x.rows()
                               : block.rows_of == RowsOf::triangles ? part.whole_triangles
                                                                    : part.whole_cloths;
    MemoryRows rows = MemoryRows::Zero(count, block.rows.cols());
    if (block.positions && block.rows_of == RowsOf::vertices) rows = x;
    rows(*numbers, Eigen::all) = block.rows;
    block.rows = std::move(rows);
  }
  return memory;
}

// The part with the marked vertices and triangles of a scene. Vertices of marked triangles must be marked.
PartOfScene part_with(const Scene& whole, std::span<const char> has_vertex, std::span<const char> has_triangle) {
  PartOfScene part;
  Scene& scene = part.scene;
  part.whole_triangles = static_cast<int>(whole.surface.triangles.rows());
  part.whole_cloths = static_cast<int>(whole.cloths.size());
  std::vector<int> renumbered(static_cast<std::size_t>(whole.surface.vertex_count), -1);
  const auto take = [](int first, int count, std::span<const char> marks, std::vector<int>& numbers) {
    const std::size_t before = numbers.size();
    for (int i = first; i < first + count; ++i)
      if (marks[static_cast<std::size_t>(i)]) numbers.push_back(i);
    return static_cast<int>(numbers.size() - before);
  };
  for (int c = 0; c < part.whole_cloths; ++c) {
    const Cloth& cloth = whole.cloths[static_cast<std::size_t>(c)];
    Cloth own = cloth;
    own.first_vertex = static_cast<int>(part.vertices.size());
    own.first_triangle = static_cast<int>(part.triangles.size());
    own.vertex_count = take(cloth.first_vertex, cloth.vertex_count, has_vertex, part.vertices);
    own.triangle_count = take(cloth.first_triangle, cloth.triangle_count, has_triangle, part.triangles);
    if (own.vertex_count == 0) continue;
    scene.cloths.push_back(own);
    part.cloths.push_back(c);
  }
  for (std::size_t i = 0; i < part.vertices.size(); ++i) renumbered[part.vertices[i]] = static_cast<int>(i);
  Triangles triangles = whole.surface.triangles(part.triangles, Eigen::all);
  for (int& v : triangles.reshaped()) v = renumbered[v];
  for (const int t : part.triangles) scene.rest_triangle.push_back(whole.rest_triangle[t]);
  scene.surface = make_surface(static_cast<int>(part.vertices.size()), triangles);
  scene.rest = whole.rest(part.vertices, Eigen::all);
  scene.rest_is_flat = whole.rest_is_flat;
  for (std::size_t p = 0; p < whole.pins.size(); ++p) {
    const int pin = renumbered[whole.pins[p]];
    if (pin < 0) continue;
    scene.pins.push_back(pin);
    part.pins.push_back(static_cast<int>(p));
  }
  for_each_joint_list([&](auto list, const JointKind&) {
    for (auto joint : whole.*list) {
      auto nodes = nodes_of(joint);
      for (int& node : nodes) node = renumbered[node];
      renumber(nodes, joint);
      if (std::ranges::min(nodes) >= 0) (scene.*list).push_back(joint);
    }
  });
  scene.obstacles = whole.obstacles;
  scene.contact = whole.contact;
  scene.wind = whole.wind;
  return part;
}

}  // namespace

PartOfScene part_of(const Scene& whole, std::span<const char> cloths) {
  std::vector<char> vertices(static_cast<std::size_t>(whole.surface.vertex_count), 0);
  std::vector<char> triangles(static_cast<std::size_t>(whole.surface.triangles.rows()), 0);
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const Cloth& cloth = whole.cloths[c];
    std::fill_n(vertices.begin() + cloth.first_vertex, cloth.vertex_count, cloths[c]);
    std::fill_n(triangles.begin() + cloth.first_triangle, cloth.triangle_count, cloths[c]);
  }
  for_each_joint_list([&]([[maybe_unused]] auto list, const JointKind&) {
    assert(std::ranges::all_of(whole.*list, [&](const auto& joint) {
      return std::ranges::all_of(nodes_of(joint),
                                 [&](int node) { return vertices[node] == vertices[nodes_of(joint)[0]]; });
    }));
  });
  return part_with(whole, vertices, triangles);
}

PartOfScene part_of_triangles(const Scene& whole, std::span<const char> triangles) {
  std::vector<char> vertices(static_cast<std::size_t>(whole.surface.vertex_count), 0);
  for (int v = 0; v < whole.surface.vertex_count; ++v) {
    const std::span<const int> round = whole.surface.triangles_of(v);
    vertices[v] = round.empty() || std::ranges::any_of(round, [&](int t) { return triangles[t] != 0; });
  }
  return part_with(whole, vertices, triangles);
}

State state_of(const PartOfScene& part, const State& whole) {
  State state;
  state.time = whole.time;
  state.frame = whole.frame;
  state.x = whole.x(part.vertices, Eigen::all);
  state.v = whole.v(part.vertices, Eigen::all);
  state.obstacles = whole.obstacles;
  state.pinched = whole.pinched;
  state.clean = whole.clean;
  state.memory = memory_of_part(part, whole.memory);
  return state;
}

Drive drive_of(const PartOfScene& part, const Drive& whole) {
  return {whole.pins(part.pins, Eigen::all),
          whole.obstacles,
          whole.wind,
          whole.acceleration,
          whole.skinned_targets.rows() == 0 ? Points() : Points(whole.skinned_targets(part.vertices, Eigen::all)),
          whole.bodies};
}

void put(const PartOfScene& part, const State& state, State& whole) {
  whole.x(part.vertices, Eigen::all) = state.x;
  whole.v(part.vertices, Eigen::all) = state.v;
  whole.obstacles = state.obstacles;
  whole.pinched = state.pinched;
  whole.clean = state.clean;
  whole.memory = memory_of_whole(part, state.memory, whole.x);
}

void put(const PartOfScene& part, const ContactForces& forces, ContactForces& whole) {
  whole.normal(part.vertices, Eigen::all) = forces.normal;
  whole.friction(part.vertices, Eigen::all) = forces.friction;
  whole.pressure(part.vertices) = forces.pressure;
}

Audit whole_audit(const PartOfScene& part, Audit audit) {
  for (auto* pairs : {&audit.self_pairs, &audit.vertex_pairs})
    for (auto& [a, b] : *pairs) {
      a = part.triangles[a];
      b = part.triangles[b];
    }
  for (auto& [triangle, other] : audit.obstacle_pairs) triangle = part.triangles[triangle];
  return audit;
}

}  // namespace selvedge
