#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "pipeline/cells/cell_list.hpp"

namespace selvedge {

struct WardrobeRequest {
  std::filesystem::path configs = "configs";  // holds clips.yaml, outfits.yaml, wardrobe/garment.yaml and outfit.yaml
  std::vector<std::string> wear;              // garments and outfits; empty: all
  std::vector<std::string> clips;             // empty: all
  int most_frames = 0;                        // of a clip; 0: all
  std::filesystem::path out = "out/wardrobe";
  std::ostream* log = nullptr;  // a line as each row ends
  std::function<bool()> stop;   // asked after every frame; true ends the command, an unfinished row is not kept
};

// One garment or outfit through one clip.
struct WardrobeRow {
  std::string wear, clip;
  bool validation = false;  // of the clip, garment or outfit
  int vertices = 0, frames = 0, frames_wanted = 0;
  int excused_frames = 0;   // the body passes through itself, or did so up to ten frames before
  long cloth_pairs = 0;     // over all frames
  long body_pairs = 0;      // over the frames that are not excused, as are those below
  double lag = 0;           // of the body, largest [m]
  double depth = 0;         // of a cloth vertex in the body where it was wanted, largest [m]
  double milliseconds = 0;  // median of a frame
  double seconds = 0;       // of the whole row
  double max_stretch = 1;
  std::vector<std::string> failures;
  bool kept = false;  // from an earlier call
  bool passed() const { return failures.empty(); }
};

// Dresses the mannequin in each garment and small outfit by code and takes it through each procedural clip, from its
// zero pose on. Passes: to the end without a rejected step, every garment still on the body (worn_part.hpp); no
// intersecting pair of cloth in any frame; and, in frames
// that are not excused, none with the body, no obstacle lag, and no vertex deeper than 1 mm. A row is a cell, and one
// that finished is not run again by the same program and settings. Leaves in `out` wardrobe.json, .csv and .txt, the
// cells, and as WEAR/CLIP the trajectory and page of each row that failed and of each garment's first clip.
std::vector<WardrobeRow> wardrobe(const WardrobeRequest&);

// The cells WEAR.CLIP, clip by clip: rows of a clip in one process share its bodies. `out`, `log` and `stop` of the
// request have no part in them.
CellList wardrobe_cells(const WardrobeRequest&);

std::string wardrobe_row_json(const WardrobeRow&);
std::optional<WardrobeRow> read_wardrobe_row(const std::string& json);
std::string wardrobe_json(const std::vector<WardrobeRow>&);
std::string wardrobe_csv(const std::vector<WardrobeRow>&);
std::string wardrobe_table(const std::vector<WardrobeRow>&);  // a row a garment or outfit, and the sum, for people

}  // namespace selvedge
