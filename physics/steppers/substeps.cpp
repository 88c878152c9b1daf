#include "physics/steppers/substeps.hpp"

#include <algorithm>
#include <cmath>

#include "collision/geometry/box_diagonal.hpp"

namespace selvedge {
namespace {

// Parts of a distance, none of them longer than `longest`.
int parts(double distance, double longest, int least, int most) {
  return longest > 0 ? static_cast<int>(std::clamp<double>(std::ceil(distance / longest), std::min(least, most), most))
                     : least;
}

}  // namespace

int least_substeps(double dt, const SubstepOptions& options) {
  constexpr double slightly = 0.05;  // longer than the longest is allowed: film has 23.976 frames a second
  return static_cast<int>(std::clamp(std::ceil(dt / options.longest - slightly), 1.0, 1e6));
}

int substeps_for_speed(const State& from, const Drive& drive, double dt, double edge_length, int max_substeps,
                       const SubstepOptions& options) {
  double speed = drive.acceleration.norm() * dt;
  if (from.v.rows() > 0) speed += from.v.rowwise().norm().maxCoeff();
  for (std::size_t k = 0; k < from.obstacles.size(); ++k)
    speed = std::max(speed, (drive.obstacles[k] - from.obstacles[k]).rowwise().norm().maxCoeff() / dt);
  return parts(dt * speed, options.max_motion * edge_length, least_substeps(dt, options), max_substeps);
}

int parts_for_slide(double slide, double edge_length, int most, const SubstepOptions& options) {
  return parts(slide, options.max_slide * edge_length, 1, most);
}

int parts_for_impact(double distance, double edge_length, int most, const SubstepOptions& options) {
  return parts(distance, options.max_motion * edge_length, 1, most);
}

double farthest_slide(std::span<const ContactTerm> terms, const Points& x0, const Points& coasting, const Points& x1) {
  double farthest = 0;
  for (const ContactTerm& term : terms)
    if (term.normal_force > 0)
      farthest =
          std::max(farthest, std::min(contact_slip(term, x0, coasting).norm(), contact_slip(term, x0, x1).norm()));
  return farthest;
}

double farthest_past(std::span<const Impact> impacts, const Points& nodes0, const Points& nodes1) {
  double farthest = 0;
  for (const Impact& impact : impacts) {
    Vec3 motion = Vec3::Zero();
    for (int i = 0; i < 4; ++i)
      motion += impact.weights[i] * (row(nodes1, impact.pair.nodes[i]) - row(nodes0, impact.pair.nodes[i]));
    farthest = std::max(farthest, (1 - impact.time) * motion.norm());
  }
  return farthest;
}

double deepest(std::span<const Impact> impacts, const Points& nodes1) {
  double depth = 0;
  for (const Impact& impact : impacts) depth = std::max(depth, impact.target - impact_gap(impact, nodes1));
  return depth;
}

double deep_impact(const Scene& scene, const SubstepOptions& options) {
  const double deep = options.deep_impact * mean_edge_length(scene), thickness = scene.contact.thickness;
  const bool narrow = std::any_of(scene.rest_triangle.begin(), scene.rest_triangle.end(),
                                  [&](const RestTriangle& t) { return smallest_altitude(t) < thickness; });
  return narrow ? std::min(deep, thickness) : deep;
}

std::optional<Restart> restart_of(const State& from, const Drive& drive, int max_substeps) {
  std::optional<Restart> restart;
  if (from.pinched) return restart;
  for (std::size_t k = 0; k < from.obstacles.size(); ++k) {
    const Points& at = from.obstacles[k];
    if (at.rows() == 0) continue;
    const double size = box_diagonal(at);
    const double way = (drive.obstacles[k] - at).colwise().mean().norm();
    if (!(way > max_substeps * size)) continue;
    if (!restart) restart = Restart{from};
    restart->state.obstacles[k] = drive.obstacles[k];
    restart->state.clean = false;
    restart->state.memory.clear();
    ++restart->jumped;
  }
  return restart;
}

}  // namespace selvedge
