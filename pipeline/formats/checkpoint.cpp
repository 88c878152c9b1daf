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

void write_rest(const h5::File& file, const Rest& rest) {
  file.write_constant("rest_seconds", H5T_NATIVE_DOUBLE, {static_cast<hsize_t>(rest.seconds.size())},
                      rest.seconds.data());
  Points air(2, 3);
  air << rest.wind.transpose(), rest.acceleration.transpose();
  h5::write_points(file, "rest_air", air);
  h5::write_points(file, "rest_place", rest.place);
}

Rest read_rest(const h5::File& file) {
  Rest rest;
  const std::vector<hsize_t> shape = file.shape_of("rest_seconds", 1);
  rest.seconds.resize(shape[0]);
  file.read_all("rest_seconds", H5T_NATIVE_DOUBLE, shape, rest.seconds.data());
  const Points air = read_points(file, "rest_air");
  if (air.rows() != 2) throw_unfit(file, "rest_air has an unexpected shape");
  rest.place = read_points(file, "rest_place");
  rest.wind = row(air, 0);
  rest.acceleration = row(air, 1);
  return rest;
}

void write_memory(const h5::File& file, const std::vector<MemoryBlock>& memory) {
  if (memory.empty()) return;
  std::vector<std::string> names;
  std::vector<Points> blocks;
  for (const MemoryBlock& block : memory) {
    names.push_back(block.name);
    blocks.push_back(block.rows);
  }
  file.write_texts("memory_names", names);
  write_all(file, "memory_", blocks);
}

std::vector<MemoryBlock> read_memory(const h5::File& file) {
  if (!file.has("memory_names")) return {};
  const std::vector<std::string> names = file.read_texts("memory_names");
  const std::vector<Points> blocks = read_all(file, "memory_");
  if (names.size() != blocks.size()) throw_unfit(file, "memory_names has an unexpected shape");
  std::vector<MemoryBlock> memory;
  for (std::size_t k = 0; k < names.size(); ++k) memory.push_back({names[k], blocks[k]});
  return memory;
}

// All arrays of the cloth are of as many vertices or empty, and what a step goes on from is finite.
void check_whole(const h5::File& file, const State& state) {
  const Eigen::Index n = state.x.rows();
  const auto of_cloth = [n](const Points& rows) { return rows.rows() == n || rows.rows() == 0; };
  if (state.v.rows() != n || !of_cloth(state.last_clean.x) || !of_cloth(state.history.x) ||
      state.history.v.rows() != state.history.x.rows() || !of_cloth(state.rest.place))
    throw_unfit(file, "has arrays of different numbers of vertices");
  if (state.history.h < 0 || (state.history.h > 0 && state.history.x.rows() != n))
    throw_unfit(file, "history_h is given without a history");
  bool finite = state.x.allFinite() && state.v.allFinite() && state.last_clean.x.allFinite();
  for (const Points& x : state.obstacles) finite = finite && x.allFinite();
  if (!finite) throw_unfit(file, "has positions or velocities that are not finite");
  for (std::size_t k = 0; k < state.cut_out.size(); ++k)
    if (state.cut_out[k] < 0 || (k > 0 && state.cut_out[k] <= state.cut_out[k - 1]))
      throw_unfit(file, "cut_out does not ascend");
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
    h5::write_points(file, "last_clean_x", state.last_clean.x);
    write_all(file, "last_clean_obstacle_", state.last_clean.obstacles);
    file.write_constant("history_h", H5T_NATIVE_DOUBLE, {1}, &state.history.h);
    h5::write_points(file, "history_x", state.history.x);
    h5::write_points(file, "history_v", state.history.v);
    write_rest(file, state.rest);
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
  state.time = read_value(file, "time");
  state.frame = read_whole(file, "frame");
  state.pinched = read_whole(file, "pinched") != 0;
  state.clean = read_whole(file, "clean") != 0;
  state.x = read_points(file, "x");
  state.v = read_points(file, "v");
  state.obstacles = read_all(file, "obstacle_");
  state.last_clean = {read_points(file, "last_clean_x"), read_all(file, "last_clean_obstacle_")};
  state.history.h = read_value(file, "history_h");
  state.history.x = read_points(file, "history_x");
  state.history.v = read_points(file, "history_v");
  state.rest = read_rest(file);
  state.memory = read_memory(file);
  const std::vector<hsize_t> cut = file.shape_of("cut_out", 1);
  state.cut_out.resize(cut[0]);
  file.read_all("cut_out", H5T_NATIVE_INT32, cut, state.cut_out.data());
  check_whole(file, state);
  return state;
}

void check_fits(const std::filesystem::path& path, const State& state, const Scene& scene) {
  const Eigen::Index n = scene.surface.vertex_count;
  bool fits = state.x.rows() == n && state.obstacles.size() == scene.obstacles.size() &&
              (state.rest.seconds.empty() || state.rest.seconds.size() == scene.cloths.size()) &&
              (state.last_clean.x.rows() == 0 || state.last_clean.obstacles.size() == scene.obstacles.size());
  for (std::size_t k = 0; fits && k < scene.obstacles.size(); ++k) {
    const Eigen::Index rows = scene.obstacles[k].surface.vertex_count;
    fits = state.obstacles[k].rows() == rows &&
           (state.last_clean.x.rows() == 0 || state.last_clean.obstacles[k].rows() == rows);
  }
  if (!state.cut_out.empty()) fits = fits && state.cut_out.back() < scene.surface.triangles.rows();
  if (!fits)
    throw Error("the checkpoint is of another scene", path.string(),
                "a mesh or body that the scene names has changed: run without --resume");
}

}  // namespace selvedge
