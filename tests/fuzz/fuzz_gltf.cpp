#include "pipeline/formats/read_point_cache.hpp"
#include "pipeline/motions/rig_gltf.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace selvedge;

// A rigged glTF file with its first animation; files that begin otherwise are tried as point caches.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = fuzz::text_of(data, size);
  if (!bytes.starts_with("glTF")) {
    for (const char* extension : {".pc2", ".pc16", ".mdd"})
      fuzz::read_or_refuse([&] { read_point_cache(fuzz::file_of(extension, bytes)); });
    return 0;
  }
  return fuzz::read_or_refuse([&] { read_gltf_clip(read_gltf_rig(fuzz::file_of(".glb", bytes)), "", 30); });
}
