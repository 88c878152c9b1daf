#include "pipeline/run/run_inputs_yaml.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <set>

#include "collision/geometry/error.hpp"
#include "pipeline/host/bytes_of.hpp"
#include "pipeline/host/json_text.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/lower_extension.hpp"
#include "pipeline/obstacles/setup_paths.hpp"

namespace selvedge {
namespace {

namespace fs = std::filesystem;

// Adds all texts in a tree.
void add_texts(const YAML::Node& node, std::vector<std::string>& texts) {
  if (node.IsScalar()) texts.push_back(node.Scalar());
  if (node.IsSequence())
    for (const YAML::Node& item : node) add_texts(item, texts);
  if (node.IsMap())
    for (const auto& pair : node) add_texts(pair.second, texts);
}

// The files whose names are `name` with digits, or blanks, in place of its %d or %0Nd.
std::vector<fs::path> numbered_files(const fs::path& name) {
  const std::string text = name.filename().string();
  const std::size_t begin = text.find('%'), end = text.find('d', begin);
  std::vector<fs::path> files;
  if (begin == std::string::npos || end == std::string::npos) return files;
  const std::string before = text.substr(0, begin), after = text.substr(end + 1);
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(name.parent_path(), ignored)) {
    const std::string found = entry.path().filename().string();
    if (found.size() <= before.size() + after.size() || !found.starts_with(before) || !found.ends_with(after)) continue;
    const std::string number = found.substr(before.size(), found.size() - before.size() - after.size());
    if (number.find_first_not_of(" 0123456789") == std::string::npos) files.push_back(name.parent_path() / found);
  }
  std::ranges::sort(files);
  return files;
}

// The buffer files of a .gltf file.
std::vector<fs::path> gltf_buffers(const fs::path& file) {
  std::vector<fs::path> buffers;
  std::ifstream in(file);
  const Json json = parse_json_or_discard({std::istreambuf_iterator<char>(in), {}});
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return buffers;
  for (const Json& buffer : json["buffers"])
    if (buffer.is_object() && buffer.contains("uri") && buffer["uri"].is_string())
      if (const std::string uri = buffer["uri"]; !uri.starts_with("data:")) buffers.push_back(file.parent_path() / uri);
  return buffers;
}

// Paths that a value of the scene may name; they need not exist.
std::vector<fs::path> named_files(const std::string& text, const fs::path& folder) {
  if (text.find('.') == std::string::npos || text.size() > 4096) return {};
  fs::path path;
  try {
    path = expanded_path(Config{}, text, folder);
  } catch (const Error&) {
    return {};
  }
  if (path.filename().string().find('%') != std::string::npos) return numbered_files(path);
  std::vector<fs::path> files{path};
  if (lower_extension(path) == ".gltf")
    for (fs::path& buffer : gltf_buffers(path)) files.push_back(std::move(buffer));
  return files;
}

// Adds a tree to a hash: a value that names files stands for their bytes.
std::uint64_t hash_of_tree(const YAML::Node& node, const fs::path& folder, std::uint64_t hash) {
  if (node.IsScalar()) {
    const std::vector<InputFile> files = hashed_files({node.Scalar()}, folder);
    if (files.empty()) return hash_of(node.Scalar() + "\n", hash);
    for (const InputFile& file : files) hash = hash_of(bytes_of(std::array{file.hash}), hash);
    return hash;
  }
  if (node.IsSequence())
    for (const YAML::Node& item : node) hash = hash_of_tree(item, folder, hash_of("-", hash));
  if (node.IsMap())
    for (const auto& pair : node)
      if (const std::string key = pair.first.Scalar(); key != "folder")
        hash = hash_of_tree(pair.second, folder, hash_of(key + ":", hash));
  return hash;
}

// A hash of arrays, one after the other, with their sizes.
struct ArraysHash {
  std::uint64_t hash = hash_of("");

  template <class Numbers>
  void add(const Numbers& values) {
    const std::string_view bytes = bytes_of(values);
    hash = hash_of(bytes, hash_of(bytes_of(std::array{bytes.size()}), hash));
  }
};

// Covers what code makes or the cache holds, which no file of the scene shows.
std::uint64_t scene_hash(const Setup& setup) {
  ArraysHash all;
  all.add(setup.scene.rest);
  all.add(setup.scene.surface.triangles);
  all.add(setup.scene.rest_triangle);
  all.add(setup.scene.pins);
  for (const Spring& spring : setup.scene.springs) all.add(Eigen::Vector2d(spring.rest_length, spring.stiffness));
  for (const Obstacle& obstacle : setup.scene.obstacles) all.add(obstacle.surface.triangles);
  const Drive begin = setup.drive_at(0);
  all.add(begin.pins);
  all.add(begin.skinned_targets);
  for (const Points& obstacle : begin.obstacles) all.add(obstacle);
  return all.hash;
}

}  // namespace

std::vector<InputFile> hashed_files(const std::vector<std::string>& texts, const fs::path& folder) {
  std::set<std::string> seen;
  std::vector<InputFile> files;
  std::error_code ignored;
  for (const std::string& text : texts)
    for (const fs::path& file : named_files(text, folder)) {
      const std::string name = (folder.empty() ? file : file.lexically_proximate(folder)).string();
      if (fs::is_regular_file(file, ignored) && seen.insert(name).second) files.push_back({name, hash_of_file(file)});
    }
  return files;
}

fs::path input_folder(const Setup& setup) {
  const YAML::Node config = YAML::Load(setup.config);
  const YAML::Node folder = config.IsMap() ? config["folder"] : YAML::Node();
  return folder && folder.IsScalar() ? fs::path(folder.Scalar()) : setup.file.parent_path();
}

std::vector<InputFile> input_files(const Setup& setup) {
  const YAML::Node config = YAML::Load(setup.config);
  if (!config.IsMap()) return {};
  std::vector<std::string> texts;
  add_texts(config, texts);
  return hashed_files(texts, input_folder(setup));
}

std::uint64_t hash_anywhere(const Setup& setup) {
  return hash_of_tree(YAML::Load(setup.config), input_folder(setup), hash_of(""));
}

RunInputs run_inputs(const Setup& setup) { return {setup.config, input_files(setup), scene_hash(setup)}; }

std::uint64_t hash_of_inputs(const RunInputs& inputs) {
  ArraysHash all;
  all.add(inputs.config);
  for (const InputFile& file : inputs.files) {
    all.add(file.name);
    all.add(std::array{file.hash});
  }
  all.add(std::array{inputs.scene});
  return all.hash;
}

}  // namespace selvedge
