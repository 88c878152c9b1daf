#include <cstdlib>

#include "pipeline/bodies/makehuman_rig.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace selvedge;

// A skeleton, and weights behind the character 0x1E. What is read names bones that are there.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::read_or_refuse([&] {
    const std::string_view bytes = fuzz::text_of(data, size), skeleton = bytes.substr(0, bytes.find('\x1e'));
    const std::vector<RigBone> bones = read_rig_bones(fuzz::file_of(".mhskel", skeleton));
    if (skeleton.size() == bytes.size()) return;
    const auto count = static_cast<int>(bones.size());
    for (const RigWeight& w : read_rig_weights(fuzz::file_of(".mhw", bytes.substr(skeleton.size() + 1)), bones))
      if (w.bone < 0 || w.bone >= count || w.vertex < 0) std::abort();
  });
}
