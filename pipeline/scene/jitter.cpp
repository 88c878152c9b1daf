#include "pipeline/scene/jitter.hpp"

#include "collision/geometry/error.hpp"
#include "physics/steppers/step_audit.hpp"

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

bool is_clean_start(const Scene& scene, const State& start) {
  const Audit found = audit_positions(scene, start.x, start.obstacles);
  return found.intersecting_pairs() == 0 && found.vertex_pairs.empty() && found.inside_vertices == 0 &&
         found.nonfinite == 0;
}

}  // namespace

Points random_shifts(Eigen::Index rows, std::uint64_t seed) {
  Points shifts(rows, 3);
  for (Eigen::Index i = 0; i < shifts.size(); ++i) shifts.data()[i] = uniform(seed);
  return shifts;
}

double jitter_start(Setup& setup, double amount, std::uint64_t seed) {
  const Points start = setup.initial.x;
  if (!is_clean_start(setup.scene, setup.initial))
    throw Error("the start is not clean", setup.file.string(), "move the cloths and obstacles of the scene apart");
  Points shift = random_shifts(start.rows(), seed);
  for (const int pin : setup.scene.pins) shift.row(pin).setZero();
  shift *= mean_edge_length(setup.scene);
  for (int halvings = 0; halvings < most_halvings; ++halvings, amount /= 2) {
    setup.initial.x = start + amount * shift;
    if (is_clean_start(setup.scene, setup.initial)) return amount;
  }
  setup.initial.x = start;
  return 0;
}

}  // namespace selvedge
