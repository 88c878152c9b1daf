#include "learned/steppers/learned_state.hpp"

#include "collision/geometry/turned_frames.hpp"
#include "physics/energies/external.hpp"
#include "physics/steppers/carried_guess.hpp"

namespace selvedge {
namespace {

constexpr const char* carried_block = "learned.velocity";    // [m/frame], one row per vertex of the cloth
constexpr const char* previous_block = "learned.previous";   // [m], one row per vertex of the cloth
constexpr const char* body_block = "learned.body_previous";  // [m], one row per vertex of all obstacles

Eigen::Index obstacle_rows(const State& state) {
  Eigen::Index rows = 0;
  for (const Points& obstacle : state.obstacles) rows += obstacle.rows();
  return rows;
}

}  // namespace

Points free_acceleration(const Scene& scene, const Points& x, const Points& v, const Drive& drive) {
  Points acceleration = drive.acceleration.transpose().replicate(x.rows(), 1);
  if (!scene.wind.on) return acceleration;
  const Points forces = wind_forces(scene, x, v, drive.wind);
  const Eigen::VectorXd mass = lumped_masses(scene);
  for (Eigen::Index i = 0; i < mass.size(); ++i)
    if (mass[i] > 0) acceleration.row(i) += forces.row(i) / mass[i];
  return acceleration;
}

bool sees_cloth_edges(const Scene& scene) { return scene.contact.self || scene.cloths.size() > 1; }

bool begins_rollout(const State& state) {
  return !find_rows(state.memory, carried_block, state.x.rows()) ||
         !find_rows(state.memory, previous_block, state.x.rows()) ||
         !find_rows(state.memory, body_block, obstacle_rows(state));
}

GraphState graph_state(const Scene& scene, const State& from, const Drive& drive) {
  GraphState state;
  state.x = state.target = from.x;
  for (std::size_t k = 0; k < scene.pins.size(); ++k)
    state.target.row(scene.pins[k]) = drive.pins.row(static_cast<Eigen::Index>(k));
  state.body = joined_rows(from.obstacles);
  state.body_target = joined_rows(drive.obstacles);
  state.timestep = learned_dt;
  state.acceleration = free_acceleration(scene, from.x, from.v, drive);
  state.no_cloth_edges = state.no_space_edges = !sees_cloth_edges(scene);
  if (begins_rollout(from)) {
    state.velocity = from.v * learned_dt;
    state.previous = from.x - state.velocity;
    state.body_previous = state.body;
  } else {
    state.velocity = *find_rows(from.memory, carried_block, from.x.rows());
    state.previous = *find_rows(from.memory, previous_block, from.x.rows());
    state.body_previous = *find_rows(from.memory, body_block, state.body.rows());
  }
  return state;
}

void set_carried_base(const Scene& scene, const State& from, const Drive& drive, double dt, GraphState& state) {
  state.guess = carried_guess(scene, from, drive, dt);
  state.heading.setIdentity();
  state.frames.clear();
  state.worn_motion.resize(0, 3);
  state.worn_offset.resize(0, 3);
  const MemoryRows* before = carried_targets(from);
  if (!before || drive.skinned_targets.rows() == 0) return;
  state.heading = turn_about_vertical(scene.rest, drive.skinned_targets);
  state.frames = turned_frames(scene.surface, *before, drive.skinned_targets);
  for (Mat3& frame : state.frames) frame *= state.heading;
  state.worn_motion = drive.skinned_targets - *before;
  state.worn_offset = from.x - *before;
  for (Eigen::Index v = 0; v < from.x.rows(); ++v)
    if (!drive.skinned_targets.row(v).allFinite()) {
      state.worn_motion.row(v).setZero();
      state.worn_offset.row(v).setZero();
    }
}

void carry_frame(const FeatureOptions& features, const State& from, const Drive& drive, State& to) {
  carry_frame(from, to);
  if (features.base == OutputBase::carried) replace_blocks("carried", carried_memory(from, drive, to.x), to.memory);
}

void carry_frame(const State& from, State& to) {
  replace_blocks("learned",
                 {{carried_block, to.x - from.x, RowsOf::vertices},
                  {previous_block, from.x, RowsOf::vertices, true},
                  {body_block, joined_rows(from.obstacles), RowsOf::obstacle_vertices, true}},
                 to.memory);
}

StepEnd learned_end(const Scene& scene, const FeatureOptions& features, const State& from, const Drive& drive,
                    const GraphState& state, const Points& seen, const NextCloth& next) {
  StepEnd end{next.x, next.velocity / learned_dt, drive.obstacles};
  for (const int pin : scene.pins) end.v.row(pin) = (next.x.row(pin) - from.x.row(pin)) / learned_dt;
  end.memory = {{carried_block, next.velocity, RowsOf::vertices},
                {previous_block, seen, RowsOf::vertices, true},
                {body_block, state.body, RowsOf::obstacle_vertices, true}};
  if (features.base == OutputBase::carried)
    for (MemoryBlock& block : carried_memory(from, drive, next.x)) end.memory.push_back(std::move(block));
  return end;
}

void carry_velocities(std::span<const int> vertices, State& state) {
  const auto block = std::ranges::find(state.memory, carried_block, &MemoryBlock::name);
  if (block == state.memory.end() || block->rows.rows() != state.v.rows()) return;
  for (const int v : vertices) block->rows.row(v) = state.v.row(v) * learned_dt;
}

}  // namespace selvedge
