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
  rest.seconds.resize(file.shape(file.open_dataset("rest_seconds").id()).at(0));
  if (!rest.seconds.empty()) file.read_all("rest_seconds", H5T_NATIVE_DOUBLE, rest.seconds.data());
  const Points air = read_points(file, "rest_air");
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
  if (names.size() != blocks.size())
    throw Error("memory_names has an unexpected shape", file.path().string(), "run without --resume");
  std::vector<MemoryBlock> memory;
  for (std::size_t k = 0; k < names.size(); ++k) memory.push_back({names[k], blocks[k]});
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
  state.last_clean = {read_points(file, "last_clean_x"), read_all(file, "last_clean_obstacle_")};
  file.read_all("history_h", H5T_NATIVE_DOUBLE, &state.history.h);
  state.history.x = read_points(file, "history_x");
  state.history.v = read_points(file, "history_v");
  state.rest = read_rest(file);
  state.memory = read_memory(file);
  state.cut_out.resize(file.shape(file.open_dataset("cut_out").id()).at(0));
  if (!state.cut_out.empty()) file.read_all("cut_out", H5T_NATIVE_INT32, state.cut_out.data());
  return state;
}

}  // namespace selvedge
