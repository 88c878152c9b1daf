#include "pipeline/run/jitter.hpp"

#include "collision/geometry/error.hpp"
#include "physics/frame/frame_audits.hpp"
#include "pipeline/shapes/random_shifts.hpp"

namespace selvedge {
namespace {

constexpr int most_halvings = 10;

bool is_clean_start(const Scene& scene, const State& start) {
  const Audit found = audit_positions(scene, start.x, start.obstacles);
  return found.intersecting_pairs() == 0 && found.vertex_pairs.empty() && found.inside_vertices == 0 &&
         found.nonfinite == 0;
}

}  // namespace

double jitter_start(const Setup& setup, double amount, std::uint64_t seed, State& start) {
  const Points x = start.x;
  if (!is_clean_start(setup.scene, start))
    throw Error("the start is not clean", setup.file.string(), "move the cloths and obstacles of the scene apart");
  Points shift = random_shifts(x.rows(), seed);
  for (const int pin : setup.scene.pins) shift.row(pin).setZero();
  shift *= mean_edge_length(setup.scene);
  for (int halvings = 0; halvings < most_halvings; ++halvings, amount /= 2) {
    start.x = x + amount * shift;
    if (is_clean_start(setup.scene, start)) return amount;
  }
  start.x = x;
  return 0;
}

}  // namespace selvedge
