#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "physics/scene/features.hpp"
#include "pipeline/formats/trajectory_hdf5.hpp"
#include "pipeline/garments/worn_part.hpp"
#include "pipeline/reports/field_total.hpp"

namespace selvedge {

enum class RunEnd { running, finished, interrupted, rejected };

// What a run came to. Frame 0 counts for what was found in the frames, not for time.
struct RunSummary {
  std::string program_version, scene, stepper;
  std::string prepared;  // what was done for the start; empty: nothing
  int vertices = 0, triangles = 0;
  int frames_wanted = 0, frames = 0;  // frames simulated
  RunEnd end = RunEnd::running;
  std::string reason;  // why the last step was rejected
  std::vector<double> frame_seconds;
  PhaseTimes seconds;                // sums
  FieldTotals fields = no_totals();  // of what the reports said: total_of(summary.fields, "impulses").sum
  std::int64_t peak_memory = 0;      // [bytes]
  double max_stretch = 1, min_stretch = 1;
  int max_stretch_frame = 0;
  bool self_audited = true;
  long pairs = 0, vertex_pairs = 0;  // over all frames
  int worst_pairs = 0, worst_frame = 0, worst_inside = 0;
  std::vector<WornWatch> slid_off;  // garments that have left their bodies by the end
  long nonfinite = 0;
  // What contact left alone of an obstacle.
  struct SwitchedOff {
    std::string obstacle;
    int most = 0, frames = 0, first_frame = -1;  // triangles in the worst frame; in how many frames; -1: in none
  };
  std::vector<SwitchedOff> switched_off;  // of each obstacle
  std::vector<PlanLine> left_out;
  std::vector<std::string> warnings;
};

void add_frame(RunSummary&, int index, const Frame&);

// Vertices times substeps that motion shortened held back, over all: frozen cloth is not clean cloth.
double held_fraction(const RunSummary&);

double median(std::vector<double>);  // 0 of none
double mean_milliseconds(const RunSummary&);
double median_milliseconds(const RunSummary&);
double worst_milliseconds(const RunSummary&);

// Ran to its end, and every frame finite, without intersecting pairs, without vertices inside obstacles, reached by a
// motion in which nothing passed through and no obstacle jumped, with nothing left that is cut out, and no garment that
// has left its body.
bool is_clean(const RunSummary&);

std::string summary_json(const RunSummary&);
std::string summary_text(const RunSummary&);  // for people, a dozen lines

}  // namespace selvedge
