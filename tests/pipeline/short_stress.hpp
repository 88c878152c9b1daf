#pragma once

#include <catch2/catch.hpp>

#include "pipeline/suites/stress.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::fake {

// The scenes of the stress suite: those that every change runs in their short form, and those that wait for `make
// long`.
inline const std::vector<std::string> stress_each_time{"spike", "impact", "tshirt", "layers", "knot"};
inline const std::vector<std::string> stress_at_length{"pinch", "spin", "funnel", "tablecloth", "hold", "twist"};

// Each of the scenes comes true once in its short form. Sanitized, the first alone: they take ten times as long.
inline void check_short_forms(std::vector<std::string> scenes) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  scenes.resize(1);
#endif
  const Folder folder("short_stress_" + scenes[0]);
  StressRequest request;
  request.configs = std::filesystem::path(SELVEDGE_SOURCE_DIR) / "configs" / "stress";
  request.scenes = scenes;
  request.out = folder.path;
  request.repeats = 1;
  request.short_form = true;
  for (const StressRow& row : stress(request)) {
    std::string why;
    for (const std::string& line : row.failures) why += "\n  " + line;
    INFO(row.scene << why);
    CHECK(row.passed());
  }
}

}  // namespace selvedge::fake
