#include "learned/steppers/learned_state.hpp"

#include <algorithm>

#include "learned/steppers/learned_scene.hpp"

namespace selvedge {
namespace {

constexpr const char* carried_block = "learned.velocity";    // [m/frame], a row a vertex of the cloth
constexpr const char* previous_block = "learned.previous";   // [m], a row a vertex of the cloth
constexpr const char* body_block = "learned.body_previous";  // [m], a row a vertex of the obstacles, on end

const Points* memory_of(const State& state, const char* name, Eigen::Index rows) {
  const auto block = std::ranges::find(state.memory, name, &MemoryBlock::name);
  return block != state.memory.end() && block->rows.rows() == rows ? &block->rows : nullptr;
}

Eigen::Index obstacle_rows(const State& state) {
  Eigen::Index rows = 0;
  for (const Points& obstacle : state.obstacles) rows += obstacle.rows();
  return rows;
}

}  // namespace

bool sees_cloth_edges(const Scene& scene) { return scene.contact.self || scene.cloths.size() > 1; }

bool begins_rollout(const State& state) {
  return !memory_of(state, carried_block, state.x.rows()) || !memory_of(state, previous_block, state.x.rows()) ||
         !memory_of(state, body_block, obstacle_rows(state));
}

GraphState graph_state(const Scene& scene, const State& from, const Drive& drive) {
  GraphState state;
  state.x = state.target = from.x;
  for (std::size_t k = 0; k < scene.pins.size(); ++k)
    state.target.row(scene.pins[k]) = drive.pins.row(static_cast<Eigen::Index>(k));
  state.body = joined_obstacles(from.obstacles);
  state.body_target = joined_obstacles(drive.obstacles);
  state.timestep = learned_dt;
  state.no_cloth_edges = !sees_cloth_edges(scene);
  if (begins_rollout(from)) {
    state.velocity = from.v * learned_dt;
    state.previous = from.x - state.velocity;
    state.body_previous = state.body;
  } else {
    state.velocity = *memory_of(from, carried_block, from.x.rows());
    state.previous = *memory_of(from, previous_block, from.x.rows());
    state.body_previous = *memory_of(from, body_block, state.body.rows());
  }
  return state;
}

void learned_arrival(const Scene& scene, const State& from, const Drive& drive, const GraphState& state,
                     const Points& seen, const NextCloth& next, State& to) {
  to = {};
  to.time = from.time + learned_dt;
  to.frame = from.frame + 1;
  to.x = next.x;
  to.v = next.velocity / learned_dt;
  for (const int pin : scene.pins) to.v.row(pin) = (next.x.row(pin) - from.x.row(pin)) / learned_dt;
  to.obstacles = drive.obstacles;
  to.memory = {{carried_block, next.velocity}, {previous_block, seen}, {body_block, state.body}};
}

void carry_velocities(std::span<const int> vertices, State& state) {
  const auto block = std::ranges::find(state.memory, carried_block, &MemoryBlock::name);
  if (block == state.memory.end() || block->rows.rows() != state.v.rows()) return;
  for (const int v : vertices) block->rows.row(v) = state.v.row(v) * learned_dt;
}

}  // namespace selvedge
