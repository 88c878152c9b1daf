#include "pipeline/hdf5/trajectory_row.hpp"

#include <bit>
#include <cstddef>

namespace selvedge {

using namespace report_table;

namespace {

BoundFields<Energies> energy_fields() {
  using E = Energies;
  const std::string ignored =
      "; not a number where the stepper [ignores that force](learned.md#from-output-to-state-learnedsteppers)";
  return {field("kinetic_energy", &E::kinetic, "J", "of motion", {}, Page::yes),
          field("gravity_energy", &E::gravity, "J", "of height", {}, Page::yes),
          field("membrane_energy", &E::membrane, "J", "of stretch and shear" + ignored, {}, Page::yes),
          field("bending_energy", &E::bending, "J", "of bending" + ignored, {}, Page::yes),
          field("spring_energy", &E::springs, "J", "of springs" + ignored, {}, Page::yes)};
}

BoundFields<Frame> clock_fields() {
  using F = Frame;
  return {field("time", &F::time, "s", "of the state", {}, Page::yes),
          field("seconds", &F::seconds, "s",
                "the frame without writing it; what was done beside another frame's step counts as the time that this "
                "frame waited for it ([decision 31](decisions/0031-beside-a-step.md))",
                {}, Page::yes)};
}

// Fields that are measured on the written positions, rounded to float.
BoundFields<Frame> measured_fields() {
  using F = Frame;
  return {field("self_pairs", &F::self_pairs, "",
                "the audit of the positions **as written**, rounded to float: pairs of triangles of cloth that cross",
                {}, Page::yes),
          field("vertex_pairs", &F::vertex_pairs, "", "of the same audit: pairs that share a vertex and cross", {},
                Page::yes),
          field("obstacle_pairs", &F::obstacle_pairs, "", "of the same audit: pairs of cloth with obstacles", {},
                Page::yes),
          field("inside_vertices", &F::inside_vertices, "", "of the same audit: cloth vertices in closed obstacles", {},
                Page::yes),
          field("nonfinite", &F::nonfinite, "", "of the same audit: vertices that are not finite", {}, Page::yes),
          field("max_stretch", &F::max_stretch, "", "largest principal stretch", {}, Page::yes),
          field("min_stretch", &F::min_stretch, "", "smallest principal stretch", {}, Page::yes)};
}

struct Column {
  std::string name;
  ColumnType type;
};

std::vector<Column> columns() {
  std::vector<Column> all;
  for (const BoundField<Frame>& one : frame_fields())
    if (one.type != ColumnType::none) all.push_back({one.name, one.type});
  all.push_back({"bad_begin", ColumnType::large});
  all.push_back({"bad_count", ColumnType::whole});
  return all;
}

hid_t file_type_of(ColumnType type) {
  if (type == ColumnType::real) return H5T_NATIVE_DOUBLE;
  return type == ColumnType::large ? H5T_NATIVE_INT64 : H5T_NATIVE_INT32;
}

// The value of a cell; an enumerator must exist for it.
FieldValue value_of_cell(const BoundField<Frame>& one, std::int64_t cell, const std::vector<std::string>& texts) {
  if (one.type == ColumnType::real) return std::bit_cast<double>(cell);
  if (one.type == ColumnType::word) return one.words.at(static_cast<std::size_t>(cell));
  if (one.type == ColumnType::flag) return cell != 0;
  if (one.type == ColumnType::text)
    return cell >= 0 && cell < std::ssize(texts) ? texts[static_cast<std::size_t>(cell)] : std::string("unknown");
  return cell;
}

// In files of older versions the reason of an accepted step is a doubt.
void read_old_reason(StepReport& report) {
  if (report.status != StepStatus::accepted || report.reason == Reason::none) return;
  for (const BoundField<Doubts>& doubt : doubt_fields())
    if (doubt.name == reason_names()[static_cast<std::size_t>(report.reason)]) doubt.set(true, report.doubts);
  report.reason = Reason::none;
}

}  // namespace

const BoundFields<Frame>& frame_fields() {
  using F = Frame;
  static const BoundFields<F> all =
      clock_fields() + inside(&F::report, report_fields()) + measured_fields() + inside(&F::energy, energy_fields());
  return all;
}

// HDF5's native types are known only once the library runs, so both types are made on demand.
h5::Handle row_memory_type() {
  const std::vector<Column> all = columns();
  h5::Handle type(H5Tcreate(H5T_COMPOUND, all.size() * sizeof(std::int64_t)), H5Tclose);
  for (std::size_t k = 0; k < all.size(); ++k)
    H5Tinsert(type.id(), all[k].name.c_str(), k * sizeof(std::int64_t),
              all[k].type == ColumnType::real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64);
  return type;
}

h5::Handle row_file_type() {
  std::size_t bytes = 0;
  for (const Column& one : columns()) bytes += H5Tget_size(file_type_of(one.type));
  h5::Handle type(H5Tcreate(H5T_COMPOUND, bytes), H5Tclose);
  std::size_t at = 0;
  for (const Column& one : columns()) {
    H5Tinsert(type.id(), one.name.c_str(), at, file_type_of(one.type));
    at += H5Tget_size(file_type_of(one.type));
  }
  return type;
}

TrajectoryRow row_of(const Frame& frame, const std::function<int(const std::string&)>& number_of_text,
                     std::int64_t bad_begin) {
  TrajectoryRow row;
  for (const BoundField<Frame>& one : frame_fields()) {
    if (one.type == ColumnType::none) continue;
    const FieldValue value = one.get(frame);
    if (one.type == ColumnType::text)
      row.cells.push_back(number_of_text(std::get<std::string>(value)));
    else if (one.type == ColumnType::real)
      row.cells.push_back(std::bit_cast<std::int64_t>(std::get<double>(value)));
    else
      row.cells.push_back(static_cast<std::int64_t>(number_of(value, one.words)));
  }
  row.cells.push_back(bad_begin);
  row.cells.push_back(std::ssize(frame.bad_triangles));
  return row;
}

TrajectoryRow empty_row() {
  return row_of(
      {}, [](const std::string&) { return -1; }, 0);
}

std::optional<std::string> unknown_word(const TrajectoryRow& row) {
  std::size_t at = 0;
  for (const BoundField<Frame>& one : frame_fields()) {
    if (one.type == ColumnType::none) continue;
    const std::int64_t cell = row.cells[at++];
    if (one.type == ColumnType::word && (cell < 0 || cell >= std::ssize(one.words))) return one.name;
  }
  return {};
}

void fill_from_row(const TrajectoryRow& row, const std::vector<std::string>& texts, Frame& frame) {
  std::size_t at = 0;
  for (const BoundField<Frame>& one : frame_fields()) {
    if (one.type == ColumnType::none) continue;
    const std::int64_t cell = row.cells[at++];
    if (one.type != ColumnType::list) one.set(value_of_cell(one, cell, texts), frame);
  }
  read_old_reason(frame.report);
}

std::string trajectory_reference() {
  std::vector<FieldLine> lines = field_lines(frame_fields());
  lines.push_back({"bad_begin", "", "first row of `frames/bad_triangles` that is this frame's", {}});
  lines.push_back({"bad_count", "", "how many rows are", {}});
  return fields_markdown(lines);
}

}  // namespace selvedge
