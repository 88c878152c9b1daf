#include "pipeline/formats/checkpoint.hpp"

#include <cmath>
#include <limits>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/hdf5_fields.hpp"
#include "pipeline/formats/hdf5_handles.hpp"

namespace selvedge {
namespace {

[[noreturn]] void throw_unfit(const h5::File& file, const std::string& what) {
  throw Error(what, file.path().string(), "the checkpoint is damaged; run without --resume");
}

Points read_points(const h5::File& file, const std::string& name) {
  const std::vector<hsize_t> shape = file.shape_of(name, 2);
  if (shape[1] != 3 || shape[0] > std::numeric_limits<std::int32_t>::max())
    throw_unfit(file, name + " has an unexpected shape");
  Points points(static_cast<Eigen::Index>(shape[0]), 3);
  file.read_all(name, H5T_NATIVE_DOUBLE, shape, points.data());
  return points;
}

double read_value(const h5::File& file, const std::string& name) {
  double value = 0;
  file.read_all(name, H5T_NATIVE_DOUBLE, {1}, &value);
  if (!std::isfinite(value)) throw_unfit(file, name + " is not finite");
  return value;
}

int read_whole(const h5::File& file, const std::string& name) {
  int value = 0;
  file.read_all(name, H5T_NATIVE_INT, {1}, &value);
  return value;
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
    throw Error("the checkpoint is of an earlier version of this program", file.path().string(),
                "run without --resume");
  const std::vector<int> rows_of = read_integers(file, "memory_rows_of");
  if (rows_of.empty()) return {};
  const std::vector<std::string> names = file.read_texts("memory_names");
  const std::vector<int> positions = read_integers(file, "memory_positions");
  if (names.size() != rows_of.size() || names.size() != positions.size())
    throw_unfit(file, "memory_names has an unexpected shape");
  for (const int rows : rows_of)
    if (rows < 0 || rows > static_cast<int>(RowsOf::cloths)) throw_unfit(file, "memory_rows_of has an unknown kind");
  Memory memory;
  for (std::size_t k = 0; k < names.size(); ++k)
    memory.push_back(
        {names[k], read_rows(file, numbered("memory_", k)), static_cast<RowsOf>(rows_of[k]), positions[k] != 0});
  return memory;
}

// Arrays of vertices are of as many as there are, and what a step goes on from is finite.
void check_whole(const h5::File& file, const State& state) {
  bool same = state.v.rows() == state.x.rows(), finite = state.x.allFinite() && state.v.allFinite();
  for (const MemoryBlock& block : state.memory) {
    same = same && (block.rows_of != RowsOf::vertices || block.rows.rows() == state.x.rows());
    finite = finite && block.rows.allFinite();
  }
  if (!same) throw_unfit(file, "has arrays of different numbers of vertices");
  for (const Points& x : state.obstacles) finite = finite && x.allFinite();
  if (!finite) throw_unfit(file, "has values that are not finite");
  for (std::size_t k = 0; k < state.cut_out.size(); ++k)
    if (state.cut_out[k] < 0 || (k > 0 && state.cut_out[k] <= state.cut_out[k - 1]))
      throw_unfit(file, "cut_out does not ascend");
}

// How many rows a block has in this scene; -1 where any number will do.
Eigen::Index rows_in(const Scene& scene, RowsOf rows_of) {
  switch (rows_of) {
    case RowsOf::vertices:
      return scene.surface.vertex_count;
    case RowsOf::triangles:
      return scene.surface.triangles.rows();
    case RowsOf::cloths:
      return static_cast<Eigen::Index>(scene.cloths.size());
    case RowsOf::obstacle_vertices: {
      Eigen::Index count = 0;
      for (const Obstacle& obstacle : scene.obstacles) count += obstacle.surface.vertex_count;
      return count;
    }
    case RowsOf::none:
      break;
  }
  return -1;
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
                "resume with the same scene file, weights and --set, or run without --resume");
  State state;
  state.time = read_value(file, "time");
  state.frame = read_whole(file, "frame");
  state.pinched = read_whole(file, "pinched") != 0;
  state.clean = read_whole(file, "clean") != 0;
  state.x = read_points(file, "x");
  state.v = read_points(file, "v");
  state.obstacles = read_all(file, "obstacle_");
  state.memory = read_memory(file);
  state.cut_out = read_integers(file, "cut_out");
  check_whole(file, state);
  return state;
}

void check_fits(const std::filesystem::path& path, const State& state, const Scene& scene) {
  bool fits = state.x.rows() == scene.surface.vertex_count && state.obstacles.size() == scene.obstacles.size();
  for (std::size_t k = 0; fits && k < scene.obstacles.size(); ++k)
    fits = state.obstacles[k].rows() == scene.obstacles[k].surface.vertex_count;
  for (const MemoryBlock& block : state.memory) {
    const Eigen::Index rows = rows_in(scene, block.rows_of);
    fits = fits && (rows < 0 || block.rows.rows() == rows);
  }
  if (!state.cut_out.empty()) fits = fits && state.cut_out.back() < scene.surface.triangles.rows();
  if (!fits)
    throw Error("the checkpoint is of another scene", path.string(),
                "a mesh or body that the scene names has changed: run without --resume");
}

}  // namespace selvedge
