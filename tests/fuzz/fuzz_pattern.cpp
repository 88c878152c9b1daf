#include <algorithm>
#include <cstdlib>

#include "pipeline/patterns/pattern_mesh.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

using namespace selvedge;

// What is read is cut into triangles that hold together.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::read_or_refuse([&] {
    const Pattern pattern = pattern_of(std::string(fuzz::text_of(data, size)), "fuzzed.json");
    double longest = 0;
    for (const Panel& panel : pattern.panels)
      for (int e = 0; e < static_cast<int>(panel.edges.size()); ++e) longest = std::max(longest, edge_length(panel, e));
    const PatternMesh mesh = pattern_mesh(pattern, longest / 4);
    if (!mesh.placed.allFinite() || mesh.triangles.minCoeff() < 0 || mesh.triangles.maxCoeff() >= mesh.placed.rows())
      std::abort();
    for (const auto& [a, b] : mesh.sewn)
      if (std::min(a, b) < 0 || std::max(a, b) >= mesh.placed.rows()) std::abort();
  });
}
