#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "physics/scene/features.hpp"
#include "pipeline/formats/trajectory_hdf5.hpp"
#include "pipeline/garments/worn_part.hpp"

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
  PhaseTimes seconds;  // sums
  int substeps = 0, iterations = 0, linear_iterations = 0;
  StepCounts counts;             // sums
  std::int64_t peak_memory = 0;  // [bytes]
  std::vector<int> verdicts;     // frames by Verdict, of a hybrid stepper; empty: it is none
  double max_stretch = 1, min_stretch = 1;
  int max_stretch_frame = 0;
  bool self_audited = true;
  long pairs = 0, vertex_pairs = 0;  // over all frames
  int worst_pairs = 0, worst_frame = 0, worst_inside = 0;
  int cut_out_at_start = 0, cut_out_at_end = 0, last_cut_frame = -1;  // triangles; -1: none is ever
  std::vector<WornWatch> slid_off;                                    // garments that have left their bodies by the end
  long nonfinite = 0;
  int max_contacts = 0;
  long impulses = 0, zones = 0, halved_substeps = 0, shortened = 0, held_vertices = 0, passed_through = 0;
  long jumped = 0;            // obstacles that were put where they were wanted without a sweep, over all frames
  int first_jump_frame = -1;  // -1: none ever was
  long energy_gains = 0;      // frames whose energy grew by more than what gave some (energy_balance.hpp)
  int first_gain_frame = -1;  // -1: none did
  double max_obstacle_lag = 0, max_depth_wanted = 0, max_residual = 0;
  int worst_pairs_wanted = 0;  // against obstacles where they were wanted
  double min_contact_gap = std::numeric_limits<double>::infinity();
  // What contact left alone of an obstacle.
  struct SwitchedOff {
    std::string obstacle;
    int most = 0, frames = 0, first_frame = -1;  // triangles in the worst frame; in how many frames; -1: in none
  };
  std::vector<SwitchedOff> switched_off;  // of each obstacle
  long pushed_out = 0, untangling = 0;    // vertices and passes, over all frames
  int out_of_newton = 0, out_of_untangling = 0, out_of_response = 0, out_of_proofs = 0;  // frames
  double max_unsolved = 0;                                                               // [m]
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
