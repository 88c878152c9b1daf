#include "pipeline/motions/clip_procedural.hpp"

#include <cmath>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/motions/clip_procedural_moves.hpp"

namespace selvedge {
namespace {

std::vector<NamedMovement> all_movements() {
  std::vector<NamedMovement> all;
  for (const auto& some :
       {gait_movements(), exercise_movements(), everyday_movements(), dance_movements(), penetrating_movements()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace

Movement movement(const Skeleton& k, double seconds) {
  Movement m;
  m.seconds = seconds;
  for (std::size_t s = 0; s < 2; ++s) m.start[s].at = stance(k, static_cast<int>(s));
  return m;
}

void hold(Movement& m, double from, double to, const Figure& figure) {
  m.keys.push_back({from, figure});
  m.keys.push_back({to, figure});
}

Movement from_rest(const Skeleton& k, double seconds, double smoothing, double rest) {
  Movement m = movement(k, seconds);
  m.smoothing = smoothing;
  hold(m, 0, rest, standing());
  return m;
}

Movement to_rest(Movement m, double rest, const Figure& figure) {
  hold(m, rest, m.seconds, figure);
  return m;
}

Vec3 turned_left(const Vec3& place, double yaw) {
  const double c = std::cos(yaw), s = std::sin(yaw);
  return {c * place.x() + s * place.z(), 0, -s * place.x() + c * place.z()};
}

std::vector<std::string> procedural_clip_names() {
  std::vector<std::string> names;
  for (const NamedMovement& one : all_movements()) names.push_back(one.name);
  return names;
}

Clip make_clip(const std::string& name, const Points& joints, std::optional<double> floor) {
  for (const NamedMovement& one : all_movements()) {
    if (one.name != name) continue;
    const Skeleton k = measured(joints, floor);
    return {name, 30, smpl_joint_names(24), performed(one.make(k), k), {}};
  }
  const std::vector<std::string> names = procedural_clip_names();
  throw Error("is no procedural clip", "clip " + name, "clips: " + joined(names) + suggestion(name, names));
}

}  // namespace selvedge
