#include "pipeline/formats/trajectory_row.hpp"

#include <cstddef>
#include <numeric>

namespace selvedge {
namespace {

struct Column {
  const char* name;
  std::size_t offset;
  hid_t type;
};

// HDF5's native types are known only once the library runs, so the list is made on demand.
std::vector<Column> columns() {
  using Row = TrajectoryRow;
  const hid_t real = H5T_NATIVE_DOUBLE, whole = H5T_NATIVE_INT32;
  return {{"time", offsetof(Row, time), real},
          {"seconds", offsetof(Row, seconds), real},
          {"by", offsetof(Row, by), whole},
          {"reason", offsetof(Row, reason), whole},
          {"status", offsetof(Row, status), whole},
          {"fell_back", offsetof(Row, fell_back), whole},
          {"verdict", offsetof(Row, verdict), whole},
          {"substeps", offsetof(Row, substeps), whole},
          {"resting", offsetof(Row, resting), whole},
          {"iterations", offsetof(Row, iterations), whole},
          {"linear_iterations", offsetof(Row, linear_iterations), whole},
          {"residual", offsetof(Row, residual), real},
          {"unsolved", offsetof(Row, unsolved), real},
          {"untangling", offsetof(Row, untangling), whole},
          {"out_of_newton", offsetof(Row, out_of_newton), whole},
          {"out_of_untangling", offsetof(Row, out_of_untangling), whole},
          {"out_of_response", offsetof(Row, out_of_response), whole},
          {"out_of_proofs", offsetof(Row, out_of_proofs), whole},
          {"solve_seconds", offsetof(Row, phase.solve), real},
          {"broad_phase_seconds", offsetof(Row, phase.broad_phase), real},
          {"ccd_seconds", offsetof(Row, phase.ccd), real},
          {"response_seconds", offsetof(Row, phase.response), real},
          {"audit_seconds", offsetof(Row, phase.audit), real},
          {"graph_seconds", offsetof(Row, phase.graph), real},
          {"network_seconds", offsetof(Row, phase.network), real},
          {"guard_seconds", offsetof(Row, phase.guard), real},
          {"solves", offsetof(Row, counts.solves), whole},
          {"coarse_builds", offsetof(Row, counts.coarse_builds), whole},
          {"searches", offsetof(Row, counts.searches), whole},
          {"candidates", offsetof(Row, counts.candidates), H5T_NATIVE_INT64},
          {"audits", offsetof(Row, counts.audits), whole},
          {"contacts", offsetof(Row, collision.contacts), whole},
          {"impulses", offsetof(Row, collision.impulses), whole},
          {"zones", offsetof(Row, collision.zones), whole},
          {"halved_substeps", offsetof(Row, collision.halved_substeps), whole},
          {"shortened", offsetof(Row, collision.shortened), whole},
          {"held_vertices", offsetof(Row, collision.held_vertices), whole},
          {"passed_through", offsetof(Row, collision.passed_through), whole},
          {"left_alone", offsetof(Row, collision.left_alone), whole},
          {"cut_out", offsetof(Row, collision.cut_out), whole},
          {"switched_off", offsetof(Row, switched_off), whole},
          {"pushed_out", offsetof(Row, collision.pushed_out), whole},
          {"jumped", offsetof(Row, collision.jumped), whole},
          {"contact_gap", offsetof(Row, collision.min_gap), real},
          {"obstacle_lag", offsetof(Row, collision.obstacle_lag), real},
          {"pairs_before", offsetof(Row, collision.pairs_before), whole},
          {"pairs_after", offsetof(Row, collision.pairs_after), whole},
          {"pairs_wanted", offsetof(Row, collision.pairs_wanted), whole},
          {"depth_wanted", offsetof(Row, collision.depth_wanted), real},
          {"self_pairs", offsetof(Row, self_pairs), whole},
          {"vertex_pairs", offsetof(Row, vertex_pairs), whole},
          {"obstacle_pairs", offsetof(Row, obstacle_pairs), whole},
          {"inside_vertices", offsetof(Row, inside_vertices), whole},
          {"nonfinite", offsetof(Row, nonfinite), whole},
          {"max_stretch", offsetof(Row, max_stretch), real},
          {"min_stretch", offsetof(Row, min_stretch), real},
          {"kinetic_energy", offsetof(Row, kinetic_energy), real},
          {"gravity_energy", offsetof(Row, gravity_energy), real},
          {"membrane_energy", offsetof(Row, membrane_energy), real},
          {"bending_energy", offsetof(Row, bending_energy), real},
          {"spring_energy", offsetof(Row, spring_energy), real},
          {"bad_begin", offsetof(Row, bad_begin), H5T_NATIVE_INT64},
          {"bad_count", offsetof(Row, bad_count), whole}};
}

}  // namespace

h5::Handle row_memory_type() {
  h5::Handle type(H5Tcreate(H5T_COMPOUND, sizeof(TrajectoryRow)), H5Tclose);
  for (const Column& column : columns()) H5Tinsert(type.id(), column.name, column.offset, column.type);
  return type;
}

h5::Handle row_file_type() {
  h5::Handle type = row_memory_type();
  H5Tpack(type.id());
  return type;
}

TrajectoryRow row_of(const Frame& frame, int by, std::int64_t bad_begin) {
  const StepReport& report = frame.report;
  TrajectoryRow row{};
  row.time = frame.time;
  row.seconds = frame.seconds;
  row.by = by;
  row.reason = static_cast<int>(report.reason);
  row.status = static_cast<int>(report.status);
  row.fell_back = report.fell_back;
  row.verdict = static_cast<int>(report.verdict);
  row.substeps = report.substeps;
  row.resting = report.resting;
  row.iterations = report.iterations;
  row.linear_iterations = report.linear_iterations;
  row.residual = report.residual;
  row.phase = report.seconds;
  row.counts = report.counts;
  row.collision = report.collision;
  row.switched_off = std::accumulate(report.switched_off.begin(), report.switched_off.end(), 0);
  row.untangling = report.untangling;
  row.out_of_newton = report.out_of_newton;
  row.out_of_untangling = report.out_of_untangling;
  row.out_of_response = report.out_of_response;
  row.out_of_proofs = report.out_of_proofs;
  row.unsolved = report.unsolved;
  row.self_pairs = frame.self_pairs;
  row.vertex_pairs = frame.vertex_pairs;
  row.obstacle_pairs = frame.obstacle_pairs;
  row.inside_vertices = frame.inside_vertices;
  row.nonfinite = frame.nonfinite;
  row.max_stretch = frame.max_stretch;
  row.min_stretch = frame.min_stretch;
  row.kinetic_energy = frame.energy.kinetic;
  row.gravity_energy = frame.energy.gravity;
  row.membrane_energy = frame.energy.membrane;
  row.bending_energy = frame.energy.bending;
  row.spring_energy = frame.energy.springs;
  row.bad_begin = bad_begin;
  row.bad_count = static_cast<int>(frame.bad_triangles.size());
  return row;
}

void fill_from_row(const TrajectoryRow& row, const std::vector<std::string>& names_of_by, Frame& frame) {
  frame.time = row.time;
  frame.seconds = row.seconds;
  StepReport& report = frame.report;
  report.by = row.by >= 0 && row.by < static_cast<int>(names_of_by.size()) ? names_of_by[row.by] : "unknown";
  report.reason = static_cast<Reason>(row.reason);
  report.status = static_cast<StepStatus>(row.status);
  report.fell_back = row.fell_back != 0;
  report.verdict = static_cast<Verdict>(row.verdict);
  report.substeps = row.substeps;
  report.resting = row.resting;
  report.iterations = row.iterations;
  report.linear_iterations = row.linear_iterations;
  report.residual = row.residual;
  report.seconds = row.phase;
  report.counts = row.counts;
  report.collision = row.collision;
  report.untangling = row.untangling;
  report.out_of_newton = row.out_of_newton != 0;
  report.out_of_untangling = row.out_of_untangling != 0;
  report.out_of_response = row.out_of_response != 0;
  report.out_of_proofs = row.out_of_proofs != 0;
  report.unsolved = row.unsolved;
  frame.self_pairs = row.self_pairs;
  frame.vertex_pairs = row.vertex_pairs;
  frame.obstacle_pairs = row.obstacle_pairs;
  frame.inside_vertices = row.inside_vertices;
  frame.nonfinite = row.nonfinite;
  frame.max_stretch = row.max_stretch;
  frame.min_stretch = row.min_stretch;
  frame.energy = {row.kinetic_energy, row.gravity_energy, row.membrane_energy, row.bending_energy, row.spring_energy};
}

const std::vector<std::string>& reason_names() {
  static const std::vector<std::string> names{"none",        "not_converged", "not_finite", "penetrating",
                                              "energy_gain", "overstretched", "stopped",    "too_many_pairs"};
  return names;
}

const std::vector<std::string>& verdict_names() {
  static const std::vector<std::string> names{
      "none",     "admitted",   "refined",       "no_history",    "tangled",     "waiting",    "too_slow",
      "not_made", "not_finite", "moved_too_far", "overstretched", "energy_gain", "unbalanced", "penetrating"};
  return names;
}

const std::vector<std::string>& status_names() {
  static const std::vector<std::string> names{"not_run", "accepted", "rejected"};
  return names;
}

}  // namespace selvedge
