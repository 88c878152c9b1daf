#pragma once

#include <functional>
#include <optional>
#include <ostream>

#include "pipeline/cells/cell_list.hpp"
#include "pipeline/drapes/drape_set.hpp"

namespace selvedge {

// Makes one path. The garment starts in the zero pose and goes from pose to pose, each held until the cloth rests.
// Poses in which the body intersects itself are drawn again. Drapes are dropped and counted if they do not come to rest
// in time, or if audit or FCL (if the build has it) finds them crossing the body or themselves. A rejected step ends
// the path. Returns nothing if `stop` does. The number alone determines the path.
std::optional<DrapePath> make_drape_path(const DrapeWorld&, std::uint64_t number, const std::function<bool()>& stop);

struct DatasetRequest {
  std::filesystem::path config;
  std::vector<std::string> overrides;  // key=value
  std::filesystem::path out;           // folder; empty: out/data/NAME
  std::ostream* log = nullptr;         // gets one line per path
  std::function<bool()> stop;          // called after every frame
};

struct DatasetSummary {
  std::filesystem::path folder;
  bool finished = false;
  int vertices = 0, body_triangles = 0;
  int training = 0, test = 0;  // number of drapes
  int poses_redrawn = 0;
  std::map<std::string, int> dropped;  // number of drapes by reason
  double seconds = 0;                  // of all paths
};

// Makes the paths that the folder lacks, each as a cell, and writes a file per path, garment.h5, config.yaml and
// drapes.csv. The same command continues a stopped run. Throws Error, also for a folder of other options.
DatasetSummary make_dataset(const DatasetRequest&);

// The cells path_K. Gathering puts the paths of cells that are there into the folder, as make_dataset leaves it. `out`,
// `log` and `stop` of the request have no part in them.
CellList dataset_cells(const DatasetRequest&);
std::string dataset_text(const DatasetSummary&);
std::string dataset_json(const DatasetSummary&);

}  // namespace selvedge
