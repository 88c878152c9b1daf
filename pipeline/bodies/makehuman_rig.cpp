#include "pipeline/bodies/makehuman_rig.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/host/json_file.hpp"
#include "pipeline/host/read_file.hpp"

namespace selvedge {
namespace {

// A value of a file, and where in it, for messages.
struct Value {
  std::string file, path;
  const Json* json = nullptr;

  [[noreturn]] void fail(const std::string& what, const std::string& cure) const {
    throw Error(what, path.empty() ? file : file + ": " + path, cure);
  }
  Value at(const std::string& key) const {
    const std::string inner = path.empty() ? key : path + "/" + key;
    if (!json->is_object() || !json->contains(key))
      Value{file, inner, nullptr}.fail("is missing", "is it MakeHuman's file, whole and of the right kind?");
    return {file, inner, &(*json)[key]};
  }
  Value at(std::size_t index) const { return {file, fmt::format("{}[{}]", path, index), &(*json)[index]}; }

  const Json& object() const {
    if (!json->is_object()) fail("is no object", "write {\"name\": value, ...}");
    return *json;
  }
  std::size_t list_size() const {
    if (!json->is_array()) fail("is no list", "write [value, ...]");
    return json->size();
  }
  const std::string& text() const {
    if (!json->is_string()) fail("is no text", "write \"text\"");
    return json->get_ref<const std::string&>();
  }
  double number() const {
    if (!json->is_number()) fail("is no number", "write a plain number");
    return json->get<double>();
  }
  int vertex() const {
    if (!json->is_number_integer() || *json < 0 || *json > std::numeric_limits<int>::max())
      fail(json_line(*json) + " is no vertex", "vertices of the base mesh count from 0");
    return json->get<int>();
  }
};

Json parsed(const std::filesystem::path& path) { return json_of_file(read_text_file(path, "JSON"), path.string()); }

std::vector<int> vertices_of(const Value& list) {
  std::vector<int> vertices(list.list_size());
  for (std::size_t k = 0; k < vertices.size(); ++k) vertices[k] = list.at(k).vertex();
  if (vertices.empty()) list.fail("is empty", "name the vertices whose middle is the joint");
  return vertices;
}

void check_tree(const Value& bones, const std::vector<RigBone>& found) {
  for (const RigBone& bone : found) {
    std::size_t steps = 0;
    for (int above = bone.parent; above >= 0; above = found[above].parent)
      if (++steps > found.size())
        bones.at(bone.name).fail("hangs on itself by its parents", "bones must hang on each other without circles");
  }
}

}  // namespace

std::vector<RigBone> read_rig_bones(const std::filesystem::path& path) {
  const Json json = parsed(path);
  const Value file{path.string(), "", &json}, bones = file.at("bones"), joints = file.at("joints");
  std::map<std::string, int> index;
  for (const auto& [name, ignored] : bones.object().items()) index.emplace(name, 0);
  for (int next = 0; auto& [name, number] : index) number = next++;
  std::vector<RigBone> found;
  for (const auto& [name, ignored] : index) {
    const Value bone = bones.at(name), parent = bone.at("parent");
    found.push_back({name, -1, vertices_of(joints.at(bone.at("head").text()))});
    if (parent.json->is_null()) continue;
    const auto above = index.find(parent.text());
    if (above == index.end()) parent.fail("`" + parent.text() + "` is no bone", "name a bone of the file, or null");
    found.back().parent = above->second;
  }
  check_tree(bones, found);
  return found;
}

std::vector<RigWeight> read_rig_weights(const std::filesystem::path& path, const std::vector<RigBone>& bones) {
  const Json json = parsed(path);
  const Value weights = Value{path.string(), "", &json}.at("weights");
  std::vector<RigWeight> found;
  for (const auto& [name, ignored] : weights.object().items()) {
    const Value list = weights.at(name);
    const auto bone = std::ranges::find(bones, name, &RigBone::name);
    if (bone == bones.end()) list.fail("is of no bone of the skeleton", "give skeleton and weights of one rig");
    for (std::size_t k = 0; k < list.list_size(); ++k) {
      const Value entry = list.at(k);
      if (entry.list_size() != 2) entry.fail("is no pair", "write [vertex, weight]");
      const double weight = entry.at(std::size_t{1}).number();
      if (!(weight >= 0 && weight <= 1)) entry.fail(fmt::format("has the weight {}", weight), "weights are 0 to 1");
      found.push_back({static_cast<int>(bone - bones.begin()), entry.at(std::size_t{0}).vertex(), weight});
    }
  }
  std::ranges::stable_sort(found, {}, &RigWeight::bone);
  return found;
}

}  // namespace selvedge
