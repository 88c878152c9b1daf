#include "pipeline/hdf5/checkpoint.hpp"

#include <limits>

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/error.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"
#include "pipeline/hdf5/hdf5_handles.hpp"

namespace selvedge {
namespace {

constexpr double farthest_place = 1e6, fastest = 1e9, longest_run = 1e9;  // [m], [m/s], [s]: beyond any scene

[[noreturn]] void throw_unfit(const std::filesystem::path& file, const std::string& field, const std::string& what) {
  throw Error(what, file.string() + ": " + field, "run without --resume");
}

void check_rows(const h5::File& file, const std::string& name, const Points& points, double most) {
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (!(points.row(i).cwiseAbs().maxCoeff() <= most) || !points.row(i).allFinite())
      throw_unfit(file.path(), name,
                  fmt::format("row {} is ({:g}, {:g}, {:g}), and {:g} is the most", i, points(i, 0), points(i, 1),
                              points(i, 2), most));
}

Points read_points(const h5::File& file, const std::string& name, double most) {
  const std::vector<hsize_t> shape = file.shape_of(name, 2);
  if (shape[1] != 3 || shape[0] > std::numeric_limits<std::int32_t>::max())
    throw_unfit(file.path(), name, fmt::format("is {} x {}, not rows of 3", shape[0], shape[1]));
  Points points(static_cast<Eigen::Index>(shape[0]), 3);
  file.read_all(name, H5T_NATIVE_DOUBLE, shape, points.data());
  check_rows(file, name, points, most);
  return points;
}

double read_time(const h5::File& file, bool may_be_negative) {
  double value = 0;
  file.read_all("time", H5T_NATIVE_DOUBLE, {1}, &value);
  if (!(value >= (may_be_negative ? -longest_run : 0) && value <= longest_run))
    throw_unfit(file.path(), "time", fmt::format("is {:g} s", value));
  return value;
}

int read_whole(const h5::File& file, const std::string& name, int most, int least = 0) {
  int value = 0;
  file.read_all(name, H5T_NATIVE_INT, {1}, &value);
  if (value < least || value > most)
    throw_unfit(file.path(), name, fmt::format("is {}, not from {} to {}", value, least, most));
  return value;
}

std::string numbered(const std::string& name, std::size_t k) { return name + std::to_string(k); }

std::vector<Points> read_all(const h5::File& file, const std::string& name) {
  std::vector<Points> all;
  while (file.has(numbered(name, all.size())))
    all.push_back(read_points(file, numbered(name, all.size()), farthest_place));
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
  const std::vector<hsize_t> shape = file.shape_of(name, 1);
  std::vector<int> values(shape[0]);
  if (!values.empty()) file.read_all(name, H5T_NATIVE_INT32, shape, values.data());
  return values;
}

MemoryRows read_rows(const h5::File& file, const std::string& name) {
  const std::vector<hsize_t> shape = file.shape_of(name, 2);
  MemoryRows rows(static_cast<Eigen::Index>(shape[0]), static_cast<Eigen::Index>(shape[1]));
  if (rows.size() > 0) file.read_all(name, H5T_NATIVE_DOUBLE, shape, rows.data());
  return rows;
}

Memory read_memory(const h5::File& file) {
  if (!file.has("memory_rows_of"))
    throw_unfit(file.path(), "memory_rows_of", "is missing: an earlier version of this program wrote the checkpoint");
  const std::vector<int> rows_of = read_integers(file, "memory_rows_of");
  if (rows_of.empty()) return {};
  const std::vector<std::string> names = file.read_texts("memory_names");
  const std::vector<int> positions = read_integers(file, "memory_positions");
  if (names.size() != rows_of.size() || names.size() != positions.size())
    throw_unfit(file.path(), "memory_names",
                fmt::format("has {} names for {} blocks and {} marks", names.size(), rows_of.size(), positions.size()));
  for (const int rows : rows_of)
    if (rows < 0 || rows > static_cast<int>(RowsOf::cloths))
      throw_unfit(file.path(), "memory_rows_of", fmt::format("has the unknown kind {}", rows));
  Memory memory;
  for (std::size_t k = 0; k < names.size(); ++k)
    memory.push_back(
        {names[k], read_rows(file, numbered("memory_", k)), static_cast<RowsOf>(rows_of[k]), positions[k] != 0});
  return memory;
}

std::vector<int> read_cut_out(const h5::File& file) {
  std::vector<int> triangles = read_integers(file, "cut_out");
  for (std::size_t k = 0; k < triangles.size(); ++k)
    if (triangles[k] < 0 || (k > 0 && triangles[k] <= triangles[k - 1]))
      throw_unfit(file.path(), "cut_out", fmt::format("does not ascend at its entry {}, {}", k, triangles[k]));
  return triangles;
}

void write_inputs(const h5::File& file, const RunInputs& inputs) {
  file.write_text("config", inputs.config);
  file.write_constant("scene_hash", H5T_NATIVE_UINT64, {1}, &inputs.scene);
  std::vector<std::string> names;
  std::vector<std::uint64_t> hashes;
  for (const InputFile& input : inputs.files) {
    names.push_back(input.name);
    hashes.push_back(input.hash);
  }
  if (!names.empty()) file.write_texts("input_names", names);
  file.write_constant("input_hashes", H5T_NATIVE_UINT64, {hashes.size()}, hashes.data());
}

void read_inputs(const h5::File& file, Checkpoint& read) {
  read.inputs.config = file.read_text("config");
  read.knows_files = file.has("input_hashes");
  if (!read.knows_files) return;
  file.read_all("scene_hash", H5T_NATIVE_UINT64, {1}, &read.inputs.scene);
  std::vector<std::uint64_t> hashes(file.shape_of("input_hashes", 1)[0]);
  file.read_all("input_hashes", H5T_NATIVE_UINT64, {hashes.size()}, hashes.data());
  const std::vector<std::string> names = hashes.empty() ? std::vector<std::string>{} : file.read_texts("input_names");
  if (names.size() != hashes.size())
    throw_unfit(file.path(), "input_names", fmt::format("has {} names for {} files", names.size(), hashes.size()));
  for (std::size_t k = 0; k < names.size(); ++k) read.inputs.files.push_back({names[k], hashes[k]});
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const State& state, const RunInputs& inputs) {
  h5::write_whole(path, [&](const h5::File& file) {
    write_inputs(file, inputs);
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
  });
}

Checkpoint read_checkpoint(const std::filesystem::path& path, int first_frame) {
  if (!std::filesystem::exists(path))
    throw Error(
        "there is nothing to resume: no checkpoint", path.string(),
        "run without --resume, or with --resume=auto, which also starts; a run that ended has none, nor has one "
        "that was stopped before its first frame");
  const h5::File file = h5::File::open(path);
  Checkpoint read;
  read_inputs(file, read);
  State& state = read.state;
  state.time = read_time(file, first_frame < 0);
  state.frame = read_whole(file, "frame", std::numeric_limits<int>::max(), first_frame);
  state.pinched = read_whole(file, "pinched", 1) != 0;
  state.clean = read_whole(file, "clean", 1) != 0;
  state.x = read_points(file, "x", farthest_place);
  state.v = read_points(file, "v", fastest);
  state.obstacles = read_all(file, "obstacle_");
  state.memory = read_memory(file);
  state.cut_out = read_cut_out(file);
  return read;
}

void check_fits(const std::filesystem::path& path, const State& state, const Scene& scene) {
  const auto rows = [&](const std::string& field, Eigen::Index found, Eigen::Index wanted, const std::string& of) {
    if (found != wanted) throw_unfit(path, field, fmt::format("has {} rows, {} has {} vertices", found, of, wanted));
  };
  rows("x", state.x.rows(), scene.surface.vertex_count, "the cloth of the scene");
  rows("v", state.v.rows(), scene.surface.vertex_count, "the cloth of the scene");
  if (state.obstacles.size() != scene.obstacles.size())
    throw_unfit(path, "obstacle_*",
                fmt::format("are {}, the scene has {}", counted(std::ssize(state.obstacles), "obstacle"),
                            scene.obstacles.size()));
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
    rows(numbered("obstacle_", k), state.obstacles[k].rows(), scene.obstacles[k].surface.vertex_count,
         "obstacle `" + scene.obstacles[k].name + "` of the scene");
  if (!state.cut_out.empty() && state.cut_out.back() >= scene.surface.triangles.rows())
    throw_unfit(path, "cut_out",
                fmt::format("names triangle {}, the cloth of the scene has {}", state.cut_out.back(),
                            scene.surface.triangles.rows()));
}

}  // namespace selvedge
