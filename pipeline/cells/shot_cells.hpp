#pragma once

#include "pipeline/cells/cell_list.hpp"

namespace selvedge {

// A scene that is simulated as it is, or with overrides.
struct Shot {
  std::string name;  // one of all shots
  std::filesystem::path scene;
  std::vector<std::string> overrides = {};  // key=value
};

struct ShotRequest {
  std::vector<Shot> shots;
  bool pages = true;  // each run gets the page that plays it
};

// The result of one shot. It passes if its run is clean (summary.hpp).
struct ShotRow {
  std::string shot, scene;
  bool passed = false;
  int vertices = 0, frames = 0, frames_wanted = 0;
  long pairs = 0;           // intersecting pairs over all frames
  double milliseconds = 0;  // median of a frame
  double seconds = 0;       // of the whole shot
  double max_stretch = 1;
  std::string reason;          // why its last step was rejected
  std::string positions_hash;  // of all frames, as in summary.json
};

// Each shot as a cell, which leaves what `selvedge simulate` leaves. Gathering writes shots.json, .csv and .txt.
CellList shot_cells(const ShotRequest&);

std::string shot_row_json(const ShotRow&);
std::string shots_json(const std::vector<ShotRow>&);
std::string shots_csv(const std::vector<ShotRow>&);
std::string shots_table(const std::vector<ShotRow>&);  // for people
std::optional<ShotRow> read_shot_row(const std::string& json);

}  // namespace selvedge
