#pragma once

#include <catch2/catch.hpp>

#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/suites/stress.hpp"
#include "pipeline/tools/check.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

namespace selvedge::fake {

// The scenes of the stress suite: those that every change runs in their short form, and those that wait for `make
// long`.
inline const std::vector<std::string> stress_each_time{"spike", "impact", "tshirt", "layers", "knot"};
inline const std::vector<std::string> stress_at_length{"pinch", "spin", "funnel", "tablecloth", "hold", "twist"};

// Whether the stored frames have the run's findings.
inline void check_audits_agree(const std::filesystem::path& file) {
  CheckRequest request;
  request.file = file;
  request.horizon = 0;
  const CheckReport report = check(request);
  const TrajectoryReader reader(file);
  REQUIRE(report.frames() == reader.frame_count());
  for (int i = 0; i < reader.frame_count(); ++i) {
    const Frame frame = reader.frame(i);
    if (frame.report.collision.cut_out > 0) continue;  // for which the run counts no pairs
    INFO(file << " frame " << i);
    CHECK(report.pairs_by_frame[static_cast<std::size_t>(i)] == frame.self_pairs + frame.obstacle_pairs);
    CHECK(report.vertex_pairs_by_frame[static_cast<std::size_t>(i)] == frame.vertex_pairs);
  }
}

// Runs each of the scenes once in its short form. Sanitized, only the first one runs, because they take ten times as
// long.
inline void check_short_forms(std::vector<std::string> scenes) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  scenes.resize(1);
#endif
  const Folder folder("short_stress_" + scenes[0]);
  StressRequest request;
  request.configs = source_root() / "configs" / "stress";
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
  std::size_t runs = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path)) {
    if (entry.path().filename() != "run.h5") continue;
    check_audits_agree(entry.path());
    ++runs;
  }
  CHECK(runs == scenes.size());
}

}  // namespace selvedge::fake
