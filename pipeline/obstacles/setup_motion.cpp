#include "pipeline/obstacles/setup_motion.hpp"

#include <fmt/format.h>

namespace selvedge {

Interpolation read_interpolation(const Config& value) {
  return value.text() == "smooth" ? Interpolation::smooth : Interpolation::linear;
}

void check_ascending_times(const Config& keyframes) {
  for (std::size_t k = 1; k < keyframes.items.size(); ++k) {
    const double before = keyframes.items[k - 1]["time"].number(), time = keyframes.items[k]["time"].number();
    if (!(time > before))
      keyframes.items[k]["time"].fail(fmt::format("is {} s after a key at {} s", time, before),
                                      "sort the keyframes, each time once");
  }
}

Motion read_motion(const Config& section, const Points& x) {
  Motion motion;
  if (!section.given) return motion;
  const Config& keyframes = section["keyframes"];
  if (keyframes.items.empty()) keyframes.fail("is empty", "give at least one keyframe, or leave `motion` out");
  check_ascending_times(keyframes);
  for (const Config& key : keyframes.items)
    motion.keys.push_back({key["time"].number(), key["translate"].vector(), key["rotate"].vector()});
  motion.interpolation = read_interpolation(section["interpolation"]);
  motion.center = section["center"].given ? section["center"].vector()
                                          : Vec3(0.5 * (x.colwise().minCoeff() + x.colwise().maxCoeff()).transpose());
  return motion;
}

Points placed(const Config& section, const Points& x) {
  const Mat3 turn = rotation_matrix(section["rotate"].vector());
  const Points turned = section["scale"].number() * x * turn.transpose();
  return turned.rowwise() + section["translate"].vector().transpose();
}

double read_unit(const Config& value) {
  if (value.words.empty()) return value.number();
  return read_quantity("1 " + value.text(), Unit::length).value;
}

}  // namespace selvedge
