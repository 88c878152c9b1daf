#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"
#include "pipeline/motions/clip.hpp"

namespace selvedge::fake {

// A body and its motion as other programs export them. They are below an armature with another unit and other axes. A
// joint without vertices is above the root, bones have their own axes, and every corner of a triangle is a separate
// vertex.
struct GltfFile {
  nlohmann::ordered_json json;
  std::string bytes;                                                   // of the one buffer
  int numbers(const Eigen::MatrixXd&, const char* type);               // as floats; returns the accessor
  int whole(const Eigen::MatrixXi&, const char* type, int component);  // as unsigned shorts (5123) or ints (5125)
  std::string glb() const;
};

// `names` of the joints replace the body's. A clip without poses is left out.
GltfFile gltf_of(const BodyModel&, const Clip&, const std::vector<std::string>& names);

}  // namespace selvedge::fake
