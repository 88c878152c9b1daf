#include <cstdlib>

#include "pipeline/tools/ccd_queries.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace selvedge;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder = [] {
    const std::filesystem::path made = fuzz::path_of("") / "edge-edge";
    std::filesystem::create_directories(made);
    return made;
  }();
  return fuzz::read_or_refuse([&] {
    const std::filesystem::path file = folder / "queries.csv";
    std::ofstream(file, std::ios::binary | std::ios::trunc) << fuzz::text_of(data, size);
    for (const CcdQuery& query : read_ccd_queries(file))
      for (const Vec3& x : query.x0)
        if (!x.allFinite()) std::abort();
  });
}
