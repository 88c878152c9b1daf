#include <cstdlib>

#include "pipeline/scene/config_scene.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace selvedge;

// What is read is written out whole and reads back to the same.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string full;
  fuzz::read_or_refuse(
      [&] { full = to_yaml(read_config(fuzz::file_of(".yaml", fuzz::text_of(data, size)), scene_section())); });
  if (full.empty()) return 0;
  if (to_yaml(read_config(fuzz::file_of(".yaml", full), scene_section())) != full) std::abort();
  return 0;
}
