#include <cstdlib>

#include "pipeline/motions/clip_bvh.hpp"
#include "tests/fuzz/fuzzed_file.hpp"
#include "tests/pipeline/fake_skeleton.hpp"

using namespace selvedge;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Points joints = fake::skeleton();
  return fuzz::read_or_refuse([&] {
    const BvhFile file = parse_bvh(fuzz::text_of(data, size), "fuzzed.bvh");
    if (!file.motion.allFinite()) std::abort();
    const Clip clip = retargeted(file, joints, {{}, 0, -1, 0.0});
    if (static_cast<Eigen::Index>(clip.poses.size()) != file.motion.rows()) std::abort();
  });
}
