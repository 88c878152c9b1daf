#include "pipeline/measures/fit_regions.hpp"

#include <map>

#include "collision/geometry/error.hpp"
#include "collision/geometry/factorisations.hpp"
#include "pipeline/host/json_file.hpp"
#include "pipeline/host/read_file.hpp"

namespace selvedge {
namespace {

std::string tailors_word(const std::string& joint) {
  static const std::map<std::string, std::string> words = {
      {"pelvis", "hips"},     {"spine1", "waist"},       {"spine2", "midriff"}, {"spine3", "chest"},
      {"collar", "shoulder"}, {"shoulder", "upper arm"}, {"elbow", "forearm"},  {"wrist", "hand"},
      {"hand", "fingers"},    {"hip", "thigh"},          {"knee", "calf"},      {"ankle", "foot"},
      {"foot", "toes"}};
  for (const std::string side : {"left", "right"})
    if (joint.starts_with(side + "_")) {
      const auto found = words.find(joint.substr(side.size() + 1));
      return found == words.end() ? joint : side + " " + found->second;
    }
  const auto found = words.find(joint);
  return found == words.end() ? joint : found->second;
}

Vec3 unit_or_up(const Vec3& direction) {
  const double length = direction.norm();
  return length > 1e-9 ? Vec3(direction / length) : Vec3::UnitY();
}

// From the joint to the mean of its children, or from its parent if it has none. Zero for collars, which have no girth.
Vec3 limb_axis(const BodyModel& body, const Points& joints, std::size_t joint) {
  if (body.joints[joint].ends_with("collar")) return Vec3::Zero();
  Vec3 sum = Vec3::Zero();
  int children = 0;
  for (std::size_t k = 0; k < body.parents.size(); ++k)
    if (body.parents[k] == static_cast<int>(joint)) sum += row(joints, static_cast<int>(k)), ++children;
  const Vec3 here = row(joints, static_cast<int>(joint));
  // The root's children point in three directions: hips are measured across the one up the back.
  if (body.parents[joint] < 0) return Vec3::UnitY();
  if (children > 0) return unit_or_up(sum / children - here);
  return unit_or_up(here - row(joints, body.parents[joint]));
}

// The direction of largest extent of points (first principal axis).
Vec3 longest_direction(const Points& x, const std::vector<int>& vertices) {
  if (vertices.size() < 2) return Vec3::UnitY();
  const Points own = x(vertices, Eigen::all);
  const Points centred = own.rowwise() - own.colwise().mean();
  return symmetric_spectrum3(centred.transpose() * centred).vectors.col(2);
}

Json parsed_regions(const std::filesystem::path& file) {
  const Json all = json_of_file(read_text_file(file, "segmentation"), file.string());
  if (!all.is_object() || all.empty())
    throw Error("is no segmentation of a body", file.string(), "give a JSON object of lists of vertices by name");
  return all;
}

}  // namespace

FitRegions regions_by_weights(const BodyModel& body, const Points& joints) {
  FitRegions found;
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    found.regions.push_back({tailors_word(body.joints[j]), limb_axis(body, joints, j)});
  for (Eigen::Index v = 0; v < body.skin.weights.rows(); ++v) {
    int best = -1;
    double largest = 0;
    for (SkinWeights::InnerIterator entry(body.skin.weights, v); entry; ++entry)
      if (entry.value() > largest) largest = entry.value(), best = static_cast<int>(entry.col());
    found.of_vertex.push_back(best);
  }
  return found;
}

FitRegions regions_of_file(const std::filesystem::path& file, const Points& body) {
  const auto count = static_cast<std::int64_t>(body.rows());
  FitRegions found;
  found.of_vertex.assign(static_cast<std::size_t>(count), -1);
  const Json all = parsed_regions(file);
  for (const auto& [name, list] : all.items()) {
    if (!list.is_array()) throw Error("`" + name + "` is no list of vertices", file.string(), "give whole numbers");
    std::vector<int> own;
    for (const auto& entry : list) {
      const std::int64_t vertex = entry.is_number_integer() ? entry.get<std::int64_t>() : -1;
      if (vertex < 0 || vertex >= count)
        throw Error("`" + name + "` names " + json_line(entry) + ", which is no vertex of the body", file.string(),
                    "the body has " + std::to_string(count) + " vertices, counted from 0");
      own.push_back(static_cast<int>(vertex));
      int& region = found.of_vertex[static_cast<std::size_t>(vertex)];
      if (region < 0) region = static_cast<int>(found.regions.size());
    }
    found.regions.push_back({name, longest_direction(body, own)});
  }
  return found;
}

FitRegions whole_body(const Points& body) {
  std::vector<int> all(static_cast<std::size_t>(body.rows()));
  for (std::size_t v = 0; v < all.size(); ++v) all[v] = static_cast<int>(v);
  return {{{"body", longest_direction(body, all)}}, std::vector<int>(all.size(), 0)};
}

}  // namespace selvedge
