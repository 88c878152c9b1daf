#include "learned/graph/elastic_motion.hpp"

namespace selvedge {

Points elastic_motion(const Elastic& elastic, const GraphScene& scene, double dt, const Points& guess,
                      AssemblyScratch& scratch) {
  Points motion;
  elastic_derivatives(elastic, guess, scratch, &motion, nullptr);
  for (Eigen::Index v = 0; v < motion.rows(); ++v) {
    const auto at = static_cast<std::size_t>(v);
    motion.row(v) *= -dt * dt / scene.mass[at];
    if (scene.types[at] == pinned_vertex || !(scene.mass[at] > 0) || !motion.row(v).allFinite())
      motion.row(v).setZero();
  }
  return motion;
}

}  // namespace selvedge
