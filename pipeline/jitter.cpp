#include "pipeline/jitter.hpp"

#include "collision/audit.hpp"
#include "collision/error.hpp"

namespace selvedge {
namespace {

constexpr int most_halvings = 10;

// The generator of Steele, Lea and Flood 2014 (SplitMix): the same numbers everywhere.
double uniform(std::uint64_t& state) {  // in [-1, 1)
  state += 0x9e3779b97f4a7c15u;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-52 - 1;
}

double mean_rest_edge(const Scene& scene) {
  double sum = 0;
  for (const RestTriangle& t : scene.rest_triangle)
    for (int k = 0; k < 3; ++k) sum += (t.col(k) - t.col((k + 1) % 3)).norm();
  return scene.rest_triangle.empty() ? 0 : sum / (3 * static_cast<double>(scene.rest_triangle.size()));
}

// As a trajectory stores it.
bool is_clean_start(const Scene& scene, const Points& x, const std::vector<Points>& obstacles) {
  std::vector<Points> rounded;
  for (const Points& obstacle : obstacles) rounded.push_back(obstacle.cast<float>().cast<double>());
  std::vector<AuditBody> bodies;
  for (std::size_t k = 0; k < rounded.size(); ++k) bodies.push_back({&scene.obstacles[k].surface, &rounded[k]});
  const Audit found = audit(scene.surface, x.cast<float>().cast<double>(), bodies, scene.contact.self);
  return found.intersecting_pairs() == 0 && found.vertex_pairs.empty() && found.inside_vertices == 0 &&
         found.nonfinite == 0;
}

}  // namespace

double jitter_start(Setup& setup, double amount, std::uint64_t seed) {
  const Points start = setup.initial.x;
  if (!is_clean_start(setup.scene, start, setup.initial.obstacles))
    throw Error("the start is not clean", setup.file.string(), "move the cloths and obstacles of the scene apart");
  Points shift(start.rows(), 3);
  std::uint64_t state = seed;
  for (Eigen::Index i = 0; i < shift.size(); ++i) shift.data()[i] = uniform(state);
  for (const int pin : setup.scene.pins) shift.row(pin).setZero();
  shift *= mean_rest_edge(setup.scene);
  for (int halvings = 0; halvings < most_halvings; ++halvings, amount /= 2) {
    setup.initial.x = start + amount * shift;
    if (is_clean_start(setup.scene, setup.initial.x, setup.initial.obstacles)) return amount;
  }
  setup.initial.x = start;
  return 0;
}

}  // namespace selvedge
