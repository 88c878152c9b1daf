#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/hdf5/trajectory_hdf5.hpp"

namespace selvedge {

struct ViewOptions {
  // Folder with three.min.js (r111) and examples/js/controls/OrbitControls.js; empty: what the program was built with.
  std::filesystem::path three = {};
  // Limit of the positions of all runs in the page [bytes, as text]. A run above its equal share is drawn at every k-th
  // frame, with a k that fits, and at its last; its plots keep every frame.
  std::size_t limit = 60'000'000;
};

// A number for every vertex of the cloths, by which the page colours them at every frame; NaN: grey.
struct ViewMap {
  std::string name, unit;
  double low = 0, high = 1;  // the ends of the colours
  std::vector<float> values;
};

// A table of texts, shown over the drawing.
struct ViewTable {
  std::vector<std::string> titles;
  std::vector<std::vector<std::string>> rows;
};

// One run for the page. `frame` is called for each index in ascending order, and again for those that are drawn.
struct ViewRun {
  std::string name;
  TrajectoryInfo info;
  int frame_count = 0;
  std::function<Frame(int)> frame;
  std::vector<ViewMap> maps = {};
  ViewTable table = {};
};

// One HTML page that needs no network and no other file: positions rounded to 0.05 mm or less
// (packed_positions.hpp), everything else exact. Throws Error if there is no run or no frame, or if three.js is absent.
std::string view_page(const std::vector<ViewRun>& runs, const ViewOptions& options = {});

// Writes the page to a file beside it and renames that. Throws Error as view_page does, and if it cannot be written.
void write_view_page(const std::vector<ViewRun>& runs, const std::filesystem::path& html, const ViewOptions& = {});

// Opens a trajectory file, or the folder of a run.h5. The run is named after the file; for a run.h5 after its folder.
ViewRun open_view_run(const std::filesystem::path&);

// Opens the runs with open_view_run and writes their page as write_view_page does.
void write_view(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& html,
                const ViewOptions& options = {});

// Makes the page view.html beside the run.h5 of a run's folder. Absent if it was made; else the reason, since a run
// must not fail because of its page.
std::optional<std::string> write_page(const std::filesystem::path& folder);

}  // namespace selvedge
