#pragma once

#include <filesystem>
#include <ostream>

#include "pipeline/formats/carried_model_hdf5.hpp"
#include "pipeline/teach/taught_clip.hpp"

namespace selvedge {

struct TeachRequest {
  std::filesystem::path scene;
  std::vector<std::string> overrides;        // key=value, of the scene
  std::vector<std::string> clips, held_out;  // of the scene's body: fitted on, and measured on
  std::filesystem::path out;                 // file of coefficients (HDF5)
  bool own = false;                          // true: a set of coefficients for each vertex
  int rounds = 2;                            // in which the solver corrects states that the fitted stepper reaches
  std::ostream* log = nullptr;               // progress; may be null
  TeachStop stop = {};
};

// What was fitted to all frames so far, and how it rolls out on the clips that it was fitted on.
struct TeachRound {
  long frames = 0;               // that it was fitted to
  double before = 0, after = 0;  // RMS distance to them in one frame: the default set's, and the fitted one's [m]
  RollDistances rolls;
};

struct TeachRow {
  std::string stepper;
  RollDistances rolls;  // on clips that were held out
};

struct TeachReport {
  bool finished = true;  // false: stopped, and no file was written
  TaughtCarried taught;
  std::vector<TeachRound> rounds;
  int chosen = 0;              // the round whose coefficients were written: nearest after ten frames
  std::vector<TeachRow> rows;  // empty: no clip was held out
};

// Fits the coefficients of the carried guess to the solver's frames on the clips, round after round, writes those that
// roll out best, and measures the file on the clips that are held out, beside `carried` and `carried_rough`. The same
// request gives the same coefficients. Throws Error for a scene without exactly one body, for clips that cannot be had
// or that are held out too, and for a file that cannot be written.
TeachReport teach_carried(const TeachRequest&);

std::string teach_text(const TeachReport&);
std::string teach_json(const TeachReport&);

}  // namespace selvedge
