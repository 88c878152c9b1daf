#include "pipeline/formats/checkpoint.hpp"

#include "collision/geometry/error.hpp"
#include "pipeline/formats/hdf5_fields.hpp"
#include "pipeline/formats/hdf5_handles.hpp"

namespace selvedge {
namespace {

Points read_points(const h5::File& file, const std::string& name) {
  const std::vector<hsize_t> shape = file.shape(file.open_dataset(name).id());
  if (shape.size() != 2 || shape[1] != 3)
    throw Error(name + " has an unexpected shape", file.path().string(), "run without --resume");
  Points points(static_cast<Eigen::Index>(shape[0]), 3);
  if (points.size() > 0) file.read_all(name, H5T_NATIVE_DOUBLE, points.data());
  return points;
}

std::string numbered(const std::string& name, std::size_t k) { return name + std::to_string(k); }

std::vector<Points> read_all(const h5::File& file, const std::string& name) {
  std::vector<Points> all;
  while (file.has(numbered(name, all.size()))) all.push_back(read_points(file, numbered(name, all.size())));
  return all;
}

void write_all(const h5::File& file, const std::string& name, const std::vector<Points>& all) {
  for (std::size_t k = 0; k < all.size(); ++k) h5::write_points(file, numbered(name, k), all[k]);
}

void write_memory(const h5::File& file, const Memory& memory) {
  std::vector<std::string> names;
  std::vector<int> rows_of, positions;
  for (const MemoryBlock& block : memory) {
    file.write_constant(numbered("memory_", names.size()), H5T_NATIVE_DOUBLE,
                        {static_cast<hsize_t>(block.rows.rows()), static_cast<hsize_t>(block.rows.cols())},
                        block.rows.data());
    names.push_back(block.name);
    rows_of.push_back(static_cast<int>(block.rows_of));
    positions.push_back(block.positions);
  }
  if (!names.empty()) file.write_texts("memory_names", names);
  h5::write_integers(file, "memory_rows_of", rows_of);
  h5::write_integers(file, "memory_positions", positions);
}

std::vector<int> read_integers(const h5::File& file, const std::string& name) {
  std::vector<int> values(file.shape(file.open_dataset(name).id()).at(0));
  if (!values.empty()) file.read_all(name, H5T_NATIVE_INT32, values.data());
  return values;
}

MemoryRows read_rows(const h5::File& file, const std::string& name) {
  const std::vector<hsize_t> shape = file.shape(file.open_dataset(name).id());
  if (shape.size() != 2) throw Error(name + " has an unexpected shape", file.path().string(), "run without --resume");
  MemoryRows rows(static_cast<Eigen::Index>(shape[0]), static_cast<Eigen::Index>(shape[1]));
  if (rows.size() > 0) file.read_all(name, H5T_NATIVE_DOUBLE, rows.data());
  return rows;
}

Memory read_memory(const h5::File& file) {
  if (!file.has("memory_rows_of"))
    throw Error("the checkpoint is of an earlier version of this program", file.path().string(),
                "run without --resume");
  const std::vector<int> rows_of = read_integers(file, "memory_rows_of");
  if (rows_of.empty()) return {};
  const std::vector<std::string> names = file.read_texts("memory_names");
  const std::vector<int> positions = read_integers(file, "memory_positions");
  if (names.size() != rows_of.size() || names.size() != positions.size())
    throw Error("memory_names has an unexpected shape", file.path().string(), "run without --resume");
  Memory memory;
  for (std::size_t k = 0; k < names.size(); ++k)
    memory.push_back(
        {names[k], read_rows(file, numbered("memory_", k)), static_cast<RowsOf>(rows_of[k]), positions[k] != 0});
  return memory;
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const State& state, const std::string& config) {
  std::filesystem::path beside = path;
  beside += ".part";
  h5::File file = h5::File::create(beside);
  try {
    file.write_text("config", config);
    file.write_constant("time", H5T_NATIVE_DOUBLE, {1}, &state.time);
    file.write_constant("frame", H5T_NATIVE_INT, {1}, &state.frame);
    const int pinched = state.pinched, clean = state.clean;
    file.write_constant("pinched", H5T_NATIVE_INT, {1}, &pinched);
    file.write_constant("clean", H5T_NATIVE_INT, {1}, &clean);
    h5::write_points(file, "x", state.x);
    h5::write_points(file, "v", state.v);
    write_all(file, "obstacle_", state.obstacles);
    h5::write_integers(file, "cut_out", state.cut_out);
    write_memory(file, state.memory);
    file.close();
  } catch (const Error&) {
    file.abandon();
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw;
  }
  std::filesystem::rename(beside, path);
}

State read_checkpoint(const std::filesystem::path& path, const std::string& config) {
  if (!std::filesystem::exists(path))
    throw Error("there is nothing to resume: no checkpoint", path.string(),
                "run without --resume; a run that ended has none, one that was stopped early may not yet have one");
  const h5::File file = h5::File::open(path);
  if (file.read_text("config") != config)
    throw Error("the checkpoint was made under another configuration", path.string(),
                "resume with the same scene file and --set, or run without --resume");
  State state;
  file.read_all("time", H5T_NATIVE_DOUBLE, &state.time);
  file.read_all("frame", H5T_NATIVE_INT, &state.frame);
  int pinched = 0, clean = 0;
  file.read_all("pinched", H5T_NATIVE_INT, &pinched);
  file.read_all("clean", H5T_NATIVE_INT, &clean);
  state.pinched = pinched != 0;
  state.clean = clean != 0;
  state.x = read_points(file, "x");
  state.v = read_points(file, "v");
  state.obstacles = read_all(file, "obstacle_");
  state.memory = read_memory(file);
  state.cut_out = read_integers(file, "cut_out");
  return state;
}

}  // namespace selvedge
