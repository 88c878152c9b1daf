#pragma once

#include <functional>
#include <optional>
#include <ostream>

#include "pipeline/drapes/drape_set.hpp"

namespace selvedge {

// One path: the garment is worn in the zero pose and goes from pose to pose, each held until the cloth rests. Poses in
// which the body passes through itself are drawn anew. Dropped and counted are drapes that are not at rest in time,
// and those that audit or FCL (where the build has it) find crossing the body or themselves; a rejected step ends the
// path. Nothing: `stop` said so. The same path for the same number, whatever else is made.
std::optional<DrapePath> make_drape_path(const DrapeWorld&, std::uint64_t number, const std::function<bool()>& stop);

struct DatasetRequest {
  std::filesystem::path config;
  std::vector<std::string> overrides;  // key=value
  std::filesystem::path out;           // folder; empty: out/data/NAME
  std::ostream* log = nullptr;         // a line a path
  std::function<bool()> stop;          // asked after every frame
};

struct DatasetSummary {
  std::filesystem::path folder;
  bool finished = false;
  int vertices = 0, body_triangles = 0;
  int training = 0, test = 0;  // drapes
  int poses_redrawn = 0;
  std::map<std::string, int> dropped;  // by reason
  double seconds = 0;                  // of all paths
};

// Makes the paths that the folder lacks and leaves a file a path, garment.h5, config.yaml and drapes.csv. The same
// command goes on where it was stopped. Throws Error, also for a folder of other options.
DatasetSummary make_dataset(const DatasetRequest&);
std::string dataset_text(const DatasetSummary&);
std::string dataset_json(const DatasetSummary&);

}  // namespace selvedge
