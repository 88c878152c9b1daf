#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/formats/hdf5_handles.hpp"
#include "pipeline/formats/trajectory.hpp"

namespace selvedge {

// A frame without its arrays, as the compound row of dataset frames/report. The columns are listed once, in
// trajectory_row.cpp.
struct TrajectoryRow {
  double time, seconds;
  std::int32_t by, reason, status;  // rows of codes/by, codes/reason, codes/status
  std::int32_t fell_back, verdict, substeps, resting, iterations, linear_iterations;
  double residual;
  PhaseTimes phase;
  StepCounts counts;
  CollisionReport collision;
  std::int32_t switched_off, untangling, out_of_newton, out_of_untangling, out_of_response, out_of_proofs;
  double unsolved;
  std::int32_t self_pairs, vertex_pairs, obstacle_pairs, inside_vertices, nonfinite;
  double max_stretch, min_stretch;
  double kinetic_energy, gravity_energy, membrane_energy, bending_energy, spring_energy;
  std::int64_t bad_begin;  // frames/bad_triangles [bad_begin, bad_begin + bad_count)
  std::int32_t bad_count;
};

h5::Handle row_memory_type();
h5::Handle row_file_type();  // the same columns without padding

TrajectoryRow row_of(const Frame&, int by, std::int64_t bad_begin);
void fill_from_row(const TrajectoryRow&, const std::vector<std::string>& names_of_by, Frame&);

// Names of the enumerators, in order: the tables codes/reason, codes/status and codes/verdict.
const std::vector<std::string>& reason_names();
const std::vector<std::string>& status_names();
const std::vector<std::string>& verdict_names();

// Bytes kept for a name in codes/by.
inline constexpr std::size_t by_name_bytes = 64;

}  // namespace selvedge
