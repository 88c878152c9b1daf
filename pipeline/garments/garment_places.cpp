#include "pipeline/garments/garment_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "collision/geometry/error.hpp"
#include "collision/geometry/surface.hpp"
#include "pipeline/config/config.hpp"

namespace selvedge {
namespace {

enum Region { trunk, left_arm, right_arm, left_leg, right_leg, region_count };

// The region of each joint, by SMPL's names; joints with other names, such as fingers, belong to their parents' region.
std::vector<Region> regions_of(const BodyModel& body) {
  std::vector<Region> regions;
  for (std::size_t j = 0; j < body.joints.size(); ++j) {
    const std::string& name = body.joints[j];
    const bool left = name.starts_with("left_");
    const std::string part = left || name.starts_with("right_") ? name.substr(name.find('_') + 1) : "";
    Region region = body.parents[j] < 0 ? trunk : regions[body.parents[j]];
    if (part == "collar" || part == "shoulder") region = left ? left_arm : right_arm;
    if (part == "hip") region = left ? left_leg : right_leg;
    regions.push_back(region);
  }
  return regions;
}

struct BodyPlaces {
  std::vector<Region> region;                                  // of each joint
  std::vector<Vec3> spine;                                     // places of the joints of the spine
  double shoulders = std::numeric_limits<double>::infinity();  // height of the shoulder joints; infinity: not known
  double chest = 0;                                            // height halfway between them and the root
};

BodyPlaces places_of(const BodyModel& body) {
  BodyPlaces places{regions_of(body), {}};
  const Points joints = joint_positions(body, {});
  for (int j = 0; j < joints.rows(); ++j)
    if (places.region[j] == trunk) places.spine.push_back(row(joints, j));
  double sum = 0;
  int count = 0;
  for (std::size_t j = 0; j < body.joints.size(); ++j)
    if (body.joints[j].ends_with("_shoulder")) sum += joints(static_cast<Eigen::Index>(j), 1), ++count;
  if (count > 0) places.shoulders = sum / count;
  places.chest = (joints(0, 1) + places.shoulders) / 2;
  return places;
}

struct Loop {
  std::vector<int> vertices;  // in order
  double height = 0;          // mean
  std::array<double, region_count> share{};
  bool central = false;  // goes round the spine
};

// The winding number of a closed line round a vertical axis.
int turns_round(const std::vector<int>& line, const Points& x, const Vec3& axis) {
  double angle = 0;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const Vec3 a = row(x, line[k]) - axis, b = row(x, line[(k + 1) % line.size()]) - axis;
    angle += std::atan2(a.z() * b.x() - a.x() * b.z(), a.x() * b.x() + a.z() * b.z());
  }
  return static_cast<int>(std::lround(angle / (2 * std::numbers::pi)));
}

Loop looked_at(std::vector<int> vertices, const SkinnedSurface& skin, const BodyPlaces& places) {
  Loop loop{std::move(vertices)};
  const double each = 1.0 / static_cast<double>(loop.vertices.size());
  for (const int v : loop.vertices) {
    loop.height += each * skin.rest(v, 1);
    for (SkinWeights::InnerIterator entry(skin.weights, v); entry; ++entry)
      loop.share[places.region[entry.col()]] += each * entry.value();
  }
  const auto nearest = std::min_element(places.spine.begin(), places.spine.end(), [&](const Vec3& a, const Vec3& b) {
    return std::abs(a.y() - loop.height) < std::abs(b.y() - loop.height);
  });
  loop.central = turns_round(loop.vertices, skin.rest, *nearest) != 0;
  return loop;
}

std::string limb_of(const Loop& loop) {
  constexpr double most = 0.5;
  if (loop.share[left_arm] > most) return "cuff_left";
  if (loop.share[right_arm] > most) return "cuff_right";
  if (loop.share[left_leg] > most) return "leg_left";
  if (loop.share[right_leg] > most) return "leg_right";
  return "opening";
}

// One name for each loop of a piece; names may still be equal.
std::vector<std::string> names_of(const std::vector<Loop>& loops, bool hangs, const BodyPlaces& places) {
  int top = -1, bottom = -1;
  for (int k = 0; k < static_cast<int>(loops.size()); ++k) {
    if (!loops[k].central) continue;
    if (top < 0 || loops[k].height > loops[top].height) top = k;
    if (bottom < 0 || loops[k].height < loops[bottom].height) bottom = k;
  }
  std::vector<std::string> names;
  for (int k = 0; k < static_cast<int>(loops.size()); ++k) {
    if (!loops[k].central)
      names.push_back(limb_of(loops[k]));
    else if (k == top && !hangs)
      names.push_back("waist");
    else if (k == top && loops[k].height > places.chest)
      names.push_back("neck");
    else
      names.push_back(k == bottom ? "hem" : "opening");
  }
  return names;
}

std::string free_name(const std::string& name, std::vector<std::string>& taken) {
  const auto is_taken = [&](const std::string& text) { return std::ranges::find(taken, text) != taken.end(); };
  std::string result = name;
  for (int k = 2; is_taken(result); ++k) result = fmt::format("{}_{}", name, k);
  taken.push_back(result);
  return result;
}

}  // namespace

std::vector<NamedLoop> named_loops(const SkinnedSurface& skin, const BodyModel& body,
                                   const std::vector<std::string>& taken) {
  const BodyPlaces places = places_of(body);
  const Surface surface = make_surface(static_cast<int>(skin.rest.rows()), skin.triangles);
  std::vector<std::vector<Loop>> pieces(static_cast<std::size_t>(surface.component_count));
  for (std::vector<int>& loop : boundary_loops(surface)) {
    const int piece = surface.component[loop[0]];
    pieces[piece].push_back(looked_at(std::move(loop), skin, places));
  }
  std::vector<char> hangs(pieces.size(), 0);  // from the shoulders
  for (int v = 0; v < surface.vertex_count; ++v)
    if (skin.rest(v, 1) > places.shoulders) hangs[surface.component[v]] = 1;
  std::vector<std::string> names = taken;
  std::vector<NamedLoop> all;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const std::vector<std::string> own = names_of(pieces[p], hangs[p], places);
    for (std::size_t k = 0; k < own.size(); ++k) {
      all.push_back({free_name(own[k], names), std::move(pieces[p][k].vertices), own[k] == "waist"});
      std::ranges::sort(all.back().vertices);
    }
  }
  return all;
}

std::vector<int> pins_of(const Garment& garment, const std::vector<std::string>& groups) {
  std::vector<int> pins;
  std::vector<std::string> known;
  for (const auto& [name, vertices] : garment.groups) known.push_back(name);
  for (const std::string& group : groups) {
    const auto found = std::ranges::find(known, group);
    if (found == known.end())
      throw Error("names the unknown group `" + group + "`", "--pin",
                  "groups: " + joined(known) + suggestion(group, known));
    const std::vector<int>& vertices = garment.groups[found - known.begin()].second;
    pins.insert(pins.end(), vertices.begin(), vertices.end());
  }
  std::ranges::sort(pins);
  pins.erase(std::unique(pins.begin(), pins.end()), pins.end());
  return pins;
}

}  // namespace selvedge
