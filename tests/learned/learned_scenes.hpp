#pragma once

#include "learned/steppers/learned_scene.hpp"
#include "learned/steppers/learned_stepper.hpp"
#include "physics/scene/make_scene.hpp"
#include "tests/learned/graph_scenes.hpp"

// Scenes for tests of learned steppers.
namespace selvedge::fake {

struct LearnedCase {
  Scene scene;
  State state;
  std::vector<Drive> drives;  // one per frame
};

// A cloth at rest whose first vertex is pinned, above a body that moves by `way` per frame.
inline LearnedCase learned_case(const Mesh& cloth, const Mesh& body, const Eigen::RowVector3d& way, int frames) {
  LearnedCase made;
  Scene& scene = made.scene;
  Material material;
  material.lame_mu = 12;
  material.lame_lambda = 20;
  add_cloth(scene, cloth.x, cloth.triangles, material, "sheet");
  scene.pins = {0};
  made.state.x = cloth.x;
  made.state.v = Points::Zero(cloth.x.rows(), 3);
  if (body.x.rows() > 0) {
    scene.obstacles.push_back({"body", surface_of(body), true});
    made.state.obstacles = {body.x};
  }
  for (int frame = 1; frame <= frames; ++frame) {
    Drive drive;
    drive.pins = cloth.x.topRows(1).rowwise() + Eigen::RowVector3d(0, 0.002 * frame, 0);
    if (body.x.rows() > 0) drive.obstacles = {body.x.rowwise() + frame * way};
    drive.acceleration = {0, -9.81, 0};
    made.drives.push_back(std::move(drive));
  }
  return made;
}

// A network of a published kind with narrow latents and random weights, whose output moves vertices by `reach` per
// frame.
struct NarrowNetwork {
  Architecture architecture;
  NetworkWeights weights;
};
inline NarrowNetwork narrow_network(const std::string& preset, double reach = 1e-3) {
  NarrowNetwork made{architecture_preset(preset), {}};
  made.architecture.width = 16;
  made.weights = random_weights(made.architecture, 7);
  for (float& deviation : made.weights.tables.output.deviation) deviation = static_cast<float>(reach);
  return made;
}

inline bool same_points(const Points& a, const Points& b) {
  return a.rows() == b.rows() && (a.array() == b.array()).all();
}

inline bool same_state(const State& a, const State& b) {
  bool same = a.time == b.time && a.frame == b.frame && same_points(a.x, b.x) && same_points(a.v, b.v) &&
              a.obstacles.size() == b.obstacles.size() && a.memory.size() == b.memory.size() && a.clean == b.clean;
  for (std::size_t k = 0; same && k < a.obstacles.size(); ++k) same = same_points(a.obstacles[k], b.obstacles[k]);
  for (std::size_t k = 0; same && k < a.memory.size(); ++k) {
    const MemoryRows &one = a.memory[k].rows, &other = b.memory[k].rows;
    same = a.memory[k].name == b.memory[k].name && one.rows() == other.rows() && one.cols() == other.cols() &&
           (one.array() == other.array()).all();
  }
  return same;
}

}  // namespace selvedge::fake
