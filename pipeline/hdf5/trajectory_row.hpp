#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/hdf5/hdf5_handles.hpp"
#include "pipeline/hdf5/trajectory.hpp"
#include "pipeline/reports/report_fields.hpp"

namespace selvedge {

// A frame's fields as the compound row of dataset frames/report: a cell of 8 bytes for each field with a column.
// Integers are stored as they are, other numbers by their bits.
struct TrajectoryRow {
  std::vector<std::int64_t> cells;
  // The last two columns: frames/bad_triangles [bad_begin, bad_begin + bad_count).
  std::int64_t bad_begin() const { return cells[cells.size() - 2]; }
  std::int64_t bad_count() const { return cells.back(); }
};

h5::Handle row_memory_type();
h5::Handle row_file_type();  // the same columns, without padding

// `number_of_text` gives the row of a text in codes/by.
TrajectoryRow row_of(const Frame&, const std::function<int(const std::string&)>& number_of_text,
                     std::int64_t bad_begin);
// A row with the values of a new frame, which columns keep that a file lacks: read into this.
TrajectoryRow empty_row();
// The name of a field with an unknown enumerator, if any; then nothing else of the row may be read.
std::optional<std::string> unknown_word(const TrajectoryRow&);
void fill_from_row(const TrajectoryRow&, const std::vector<std::string>& texts, Frame&);

// The description of the columns in docs/files.md.
std::string trajectory_reference();

// Bytes kept for a name in codes/by.
inline constexpr std::size_t by_name_bytes = 64;

}  // namespace selvedge
