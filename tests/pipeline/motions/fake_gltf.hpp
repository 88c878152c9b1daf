#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"
#include "pipeline/motions/clip.hpp"

namespace selvedge::fake {

// A body and a motion of it as other programs' exporters write them: below an armature that has another unit and other
// axes, with a joint above the root that nothing hangs on, bones with axes of their own, and every corner of a triangle
// a vertex of its own.
struct GltfFile {
  nlohmann::ordered_json json;
  std::string bytes;                                                   // of the one buffer
  int numbers(const Eigen::MatrixXd&, const char* type);               // as floats; returns the accessor
  int whole(const Eigen::MatrixXi&, const char* type, int component);  // as unsigned shorts (5123) or ints (5125)
  std::string glb() const;
};

// `names`: of the joints, in place of the body's. A clip without poses is left out.
GltfFile gltf_of(const BodyModel&, const Clip&, const std::vector<std::string>& names);

}  // namespace selvedge::fake
