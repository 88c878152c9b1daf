#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/formats/trajectory_hdf5.hpp"

namespace selvedge {

struct ViewOptions {
  // Folder with three.min.js (r111) and examples/js/controls/OrbitControls.js; empty: as found when the program was
  // built.
  std::filesystem::path three;
  // Geometry of all runs in the page [bytes, as text]. A run above its equal share is drawn at every k-th frame, k the
  // smallest that fits, and at its last; its plots keep every frame.
  std::size_t limit = 60'000'000;
};

// A number at every vertex of the cloths, by which the page colours them at every frame; not a number: grey.
struct ViewMap {
  std::string name, unit;
  double low = 0, high = 1;  // the ends of the colours
  std::vector<float> values;
};

// A table over the drawing, texts in rows.
struct ViewTable {
  std::vector<std::string> titles;
  std::vector<std::vector<std::string>> rows;
};

// One run as the page needs it: `frame` is called once an index, in ascending order.
struct ViewRun {
  std::string name;
  TrajectoryInfo info;
  int frame_count = 0;
  std::function<Frame(int)> frame;
  std::vector<ViewMap> maps = {};
  ViewTable table = {};
};

// One HTML page that needs no network and no other file: positions rounded to 16 bits of each frame's bounding box,
// everything else exact. Throws Error when there is no run or no frame, or when three.js is absent.
std::string view_page(const std::vector<ViewRun>& runs, const ViewOptions& options = {});

// The page, written beside and renamed. Throws Error as view_page does, and where it cannot be written.
void write_view_page(const std::vector<ViewRun>& runs, const std::filesystem::path& html, const ViewOptions& = {});

// A trajectory file or the folder of a run.h5, named after the file, a run.h5 after its folder.
ViewRun open_view_run(const std::filesystem::path&);

// Reads trajectories and writes the page beside and renamed. A run is a trajectory file or the folder of a run.h5; it
// is named after the file, a run.h5 after its folder.
void write_view(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& html,
                const ViewOptions& options);
void write_view(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& html);

// The page view.html beside the run.h5 of a run's folder. It is an extra, and no run is lost because it cannot be made:
// says why not. Absent: it was made.
std::optional<std::string> write_page(const std::filesystem::path& folder);

}  // namespace selvedge
