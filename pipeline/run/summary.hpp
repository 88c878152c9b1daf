#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "physics/scene/features.hpp"
#include "pipeline/garments/worn_part.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/reports/field_total.hpp"
#include "pipeline/scene/outcome.hpp"

namespace selvedge {

enum class RunEnd { running, finished, interrupted, rejected };

// The results of a run. Frame 0 counts for findings in frames, but not for times.
struct RunSummary {
  std::string program_version, scene, stepper;
  std::string prepared;  // what was done to prepare the start; empty: nothing
  int vertices = 0, triangles = 0;
  int frames_wanted = 0, frames = 0;  // frames simulated
  RunEnd end = RunEnd::running;
  std::string reason;  // why the last step was rejected
  std::vector<double> frame_seconds;
  PhaseTimes seconds;                // sums
  FieldTotals fields = no_totals();  // totals of the reports' fields: total_of(summary.fields, "impulses").sum
  std::int64_t peak_memory = 0;      // [bytes]
  double max_stretch = 1, min_stretch = 1;
  int max_stretch_frame = 0;
  bool self_audited = true;
  long pairs = 0, vertex_pairs = 0;  // over all frames
  int worst_pairs = 0, worst_frame = 0, worst_inside = 0;
  std::vector<WornWatch> slid_off;  // garments that have left their bodies at the end
  long nonfinite = 0;
  // Triangles of an obstacle that contact left alone.
  struct SwitchedOff {
    std::string obstacle;
    int most = 0, frames = 0, first_frame = -1;  // triangles in the worst frame; number of frames; -1: none
  };
  std::vector<SwitchedOff> switched_off;   // of each obstacle
  std::vector<OutcomeResult> outcomes;     // of what the scene states
  std::vector<std::string> outcome_lines;  // the same for people
  std::uint64_t positions_hash = 0;        // of the cloth's positions as written, all frames so far
  std::uint64_t inputs_hash = 0;           // of all that the run was made of
  std::vector<PlanLine> left_out;
  std::vector<std::string> warnings;
};

void add_frame(RunSummary&, int index, const Frame&);

// The share of vertices times substeps that shortened motion held back: frozen cloth is not clean cloth.
double held_fraction(const RunSummary&);

double median(std::vector<double>);  // 0 of none
double mean_milliseconds(const RunSummary&);
double median_milliseconds(const RunSummary&);
double worst_milliseconds(const RunSummary&);

// True if the run reached its end, every frame is finite, no triangles intersect, no vertices are inside obstacles,
// nothing passed through in any motion, no obstacle jumped, no triangles are still cut out, no garment has left its
// body, and every outcome that the scene states has come true.
bool is_clean(const RunSummary&);

std::string summary_json(const RunSummary&);
std::string summary_text(const RunSummary&);  // for people, a dozen lines

}  // namespace selvedge
