#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "physics/scene/make_scene.hpp"
#include "physics/scene/scene_numbers.hpp"
#include "pipeline/bodies/body_outward.hpp"
#include "pipeline/bodies/joint_regressor.hpp"
#include "pipeline/config/config_text.hpp"
#include "pipeline/formats/mesh_faults.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "pipeline/formats/seam_places.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/python/arrays_nanobind.hpp"
#include "pipeline/python/overrides_nanobind.hpp"
#include "pipeline/python/scene_nanobind.hpp"
#include "pipeline/scene/config_scene.hpp"
#include "pipeline/scene/massless.hpp"
#include "pipeline/scene/materials.hpp"
#include "pipeline/scene/setup_cloth.hpp"
#include "pipeline/scene/setup_garment.hpp"

namespace selvedge {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

// A dictionary with the keys of a section of scene files, checked as that is.
Config section_of(const nb::dict& values, const Section& section, const std::string& where) {
  return read_section(yaml_of(values, where), section, where);
}

// What `material` of a scene file may be: a name, or a dictionary.
nb::dict material_keys(const nb::object& material) {
  if (nb::isinstance<nb::dict>(material)) return nb::cast<nb::dict>(material);
  nb::dict keys;
  if (!material.is_none()) keys["name"] = material;
  return keys;
}

Material material_of(const nb::object& material, const std::string& where) {
  Config section = section_of(material_keys(material), table::material_section(), where);
  return read_material(section, {});
}

// Further keys of a section, which have no part of it that the arguments say.
nb::dict further_keys(const nb::kwargs& keys, const char* said, const std::string& where) {
  if (keys.contains(said)) throw Error("is what the arguments say", where + ", " + said, "leave it out");
  nb::dict all;
  for (const auto& [key, value] : keys) all[key] = value;
  return all;
}

BodyModel body_of_arrays(const std::string& name, const nb::handle& x, const nb::handle& triangles,
                         const nb::handle& joints, const nb::handle& weights, const nb::handle& parents,
                         const nb::object& joint_names, const std::string& where) {
  BodyModel body;
  body.name = name;
  body.skin.rest = points_of(x, where + ", x");
  body.skin.triangles = triangles_of(triangles, body.skin.rest.rows(), where + ", triangles");
  const Points places = points_of(joints, where + ", joints");
  const Eigen::MatrixXd all = matrix_of(weights, where + ", weights");
  if (all.rows() != body.skin.rest.rows() || all.cols() != places.rows())
    throw Error(fmt::format("is {} x {}", all.rows(), all.cols()), where + ", weights",
                fmt::format("give a row a vertex and a column a joint, {} x {}", body.skin.rest.rows(), places.rows()));
  body.skin.weights = all.sparseView();
  body.skin.shape_directions.resize(3 * body.skin.rest.rows(), 0);
  try {
    body.parents = nb::cast<std::vector<int>>(nb::module_::import_("numpy").attr("asarray")(parents).attr("tolist")());
    if (!joint_names.is_none()) body.joints = nb::cast<std::vector<std::string>>(nb::list(joint_names));
  } catch (const std::exception&) {
    throw Error("are no list", where + ", parents and joint_names", "give a whole number and a text a joint");
  }
  for (Eigen::Index j = 0; joint_names.is_none() && j < places.rows(); ++j)
    body.joints.push_back(fmt::format("joint{}", j));
  if (static_cast<Eigen::Index>(body.parents.size()) != places.rows())
    throw Error(fmt::format("has {} numbers for {} joints", body.parents.size(), places.rows()), where + ", parents",
                "give the parent of every joint, -1 for the root, which comes first");
  body.regressor = exact_regressor(body.skin.rest, places, where + ", x");
  check_body(body, where, {.rest = "x"});
  return body;
}

Clip clip_of_arrays(const BodyModel& body, const nb::object& poses, const nb::object& translations, double fps,
                    const std::string& where) {
  if (!(fps > 0) || !(fps <= 1e6))
    throw Error(fmt::format("is {:g}", fps), where + ", fps", "allowed: above 0, up to 1e6 frames a second");
  const std::vector<Points> rotations = frames_of(poses, where + ", poses");
  Points moves = Points::Zero(std::ssize(rotations), 3);
  if (!translations.is_none()) moves = points_of(translations, where + ", translations");
  if (rotations.empty() || rotations[0].rows() != std::ssize(body.joints))
    throw Error(fmt::format("has {} frames of {} joints, the body has {}", rotations.size(),
                            rotations.empty() ? 0 : rotations[0].rows(), body.joints.size()),
                where + ", poses", "give frames x joints x 3, axis times angle [rad]");
  if (moves.rows() != std::ssize(rotations))
    throw Error(fmt::format("has {} rows for {} frames", moves.rows(), rotations.size()), where + ", translations",
                "give one a frame");
  Clip clip{body.name, fps, body.joints, {}, {}};
  for (std::size_t f = 0; f < rotations.size(); ++f)
    clip.poses.push_back({rotations[f], row(moves, static_cast<int>(f))});
  return clip;
}

// Triangles that have a vertex twice are an error of their own, later.
bool has_vertex_twice(const Triangles& triangles) {
  const auto a = triangles.col(0), b = triangles.col(1), c = triangles.col(2);
  return (a.array() == b.array() || b.array() == c.array() || c.array() == a.array()).any();
}

void warn_of_faults(const std::string& where, const Points& x, const Triangles& triangles) {
  if (has_vertex_twice(triangles)) return;
  std::vector<std::string> warnings;
  for (const std::string& fault : mesh_faults(x, triangles)) warnings.push_back(where + ": " + fault);
  if (const Welding seams = weldable(x, triangles); seams.joined > 0)
    warnings.push_back(where + ": " + unwelded_text(seams, "welding them before"));
  warn(warnings);
}

// As scene files do, so that a vertex without mass does not hold the cloth.
void leave_out_slivers(const std::string& where, ClothPart& part) {
  if (has_vertex_twice(part.mesh.triangles)) return;
  part.rest_triangle = flattened(part.rest, part.mesh.triangles);
  std::vector<std::string> warnings;
  leave_out_massless(part, warnings);
  if (part.mesh.triangles.rows() == 0)
    throw Error("has no triangle with an area", where + ", triangles", "give positions that lie apart");
  warn(warnings);
}

// The name that was given, or the first that is free of `noun`, `noun_1`, ...
std::string name_of(const std::optional<std::string>& given, const std::string& noun,
                    const std::vector<std::string>& taken) {
  const auto is_taken = [&](const std::string& name) { return std::ranges::count(taken, name) > 0; };
  if (given && given->empty()) throw Error("is empty", noun + ", name", "give it a name, or leave it out");
  if (given && is_taken(*given))
    throw Error("has the name `" + *given + "` of another", noun + ", name", "give it a name of its own");
  if (given) return *given;
  std::string name = noun;
  for (int k = 1; is_taken(name); ++k) name = fmt::format("{}_{}", noun, k);
  return name;
}

}  // namespace

std::vector<std::string> SceneObject::names_of_cloths() const {
  std::vector<std::string> names;
  for (const ClothPart& part : cloths_) names.push_back(part.name);
  return names;
}

std::vector<std::string> SceneObject::names_of_obstacles() const {
  std::vector<std::string> names;
  for (const Obstacle& obstacle : setup_.scene.obstacles) names.push_back(obstacle.name);
  return names;
}

// Appends the cloth to the scene, with its pins and what follows others.
void SceneObject::add_part(ClothPart part) {
  Scene& scene = setup_.scene;
  const int number = add_cloth(scene, part.rest, part.mesh.triangles, part.material, part.name, part.rest_triangle);
  std::vector<int> pinned;
  for (const PinPart& pin : part.pins) pinned.insert(pinned.end(), pin.vertices.begin(), pin.vertices.end());
  for (const Follower& one : part.followers) pinned.push_back(one.vertex);
  std::ranges::sort(pinned);
  pinned.erase(std::unique(pinned.begin(), pinned.end()), pinned.end());
  for (const int v : pinned) scene.pins.push_back(scene.cloths[static_cast<std::size_t>(number)].first_vertex + v);
  cloths_.push_back(std::move(part));
}

int SceneObject::add_cloth_arrays(const nb::handle& x, const nb::handle& triangles,
                                  const std::optional<std::string>& given_name, std::optional<double> density,
                                  std::optional<double> youngs_modulus, std::optional<double> poisson,
                                  std::optional<double> bending, const nb::object& material, const nb::object& pins) {
  must_be_open();
  const std::string name = name_of(given_name, "cloth", names_of_cloths());
  const std::string where = "cloth `" + name + "`";
  ClothPart part;
  part.name = name;
  part.rest = part.first = part.mesh.x = points_of(x, where + ", x");
  part.velocity = Points::Zero(part.rest.rows(), 3);
  part.mesh.triangles = triangles_of(triangles, part.rest.rows(), where + ", triangles");
  if (part.mesh.triangles.rows() == 0) throw Error("has no rows", where + ", triangles", "give three vertices a row");
  warn_of_faults(where, part.rest, part.mesh.triangles);
  leave_out_slivers(where, part);
  if (!material.is_none()) {
    if (density || youngs_modulus || poisson || bending)
      throw Error("is given beside numbers of it", where + ", material", "put the numbers into `material`");
    part.material = material_of(material, where + ", material");
  } else {
    part.material.density = density.value_or(0.2);
    part.material.bending = bending.value_or(1e-5);
    set_elasticity({youngs_modulus.value_or(1000), poisson.value_or(0.3)}, where + ", material", part.material);
  }
  if (!pins.is_none()) {
    PinPart held{"pinned", vertices_of(pins, part.rest.rows(), where + ", pins"), {}};
    held.at = [places = Points(part.first(held.vertices, Eigen::all))](double) { return places; };
    part.pins.push_back(std::move(held));
  }
  add_part(std::move(part));
  return static_cast<int>(cloths_.size()) - 1;
}

int SceneObject::add_garment_arrays(const nb::handle& x, const nb::handle& triangles,
                                    const std::optional<std::string>& given_name, const nb::object& on,
                                    const nb::object& material, const std::string& fit, const nb::object& pins,
                                    const nb::kwargs& keys) {
  must_be_open();
  const std::string name = name_of(given_name, "garment", names_of_cloths());
  const std::string where = "garment `" + name + "`";
  Mesh mesh;
  mesh.x = points_of(x, where + ", x");
  mesh.triangles = triangles_of(triangles, mesh.x.rows(), where + ", triangles");
  nb::dict worn, all = further_keys(keys, "garment", where);
  worn["file"] = "arrays";
  worn["fit"] = fit;
  if (!on.is_none()) worn["on"] = on;
  all["name"] = name;
  all["garment"] = worn;
  all["material"] = material_keys(material);
  Config section = section_of(all, table::cloth_section(), where);
  std::optional<std::vector<int>> held;
  if (!pins.is_none()) held = vertices_of(pins, mesh.x.rows(), where + ", pins");
  std::vector<std::string> warnings;
  ClothPart part = worn_cloth(section, name, wear_mesh(section, name, mesh, held, bodies_), {}, warnings);
  warn(warnings);
  const bool flat = cloths_.empty() ? part.rest_is_flat : setup_.scene.rest_is_flat;
  const auto other = std::ranges::find_if(cloths_, [](const ClothPart& one) { return one.worn != nullptr; });
  if (part.rest_is_flat != flat)
    throw Error("differs from the first cloth's", where + ", rest.flat", "let all rest alike");
  if (other != cloths_.end() && (other->draping != part.draping || other->cut != part.cut))
    throw Error("starts otherwise than the first garment", where + ", start", "give all garments the same `start`");
  if (!part.followers.empty())
    throw Error(fmt::format("has {} vertices without mass, whose triangles have no area", part.followers.size()), where,
                "leave these vertices out");
  add_part(std::move(part));
  setup_.scene.rest_is_flat = flat;
  return static_cast<int>(cloths_.size()) - 1;
}

int SceneObject::add_body_arrays(const nb::handle& x, const nb::handle& triangles, const nb::handle& joints,
                                 const nb::handle& weights, const nb::handle& parents, const nb::object& poses,
                                 const nb::object& translations, double fps, const nb::object& joint_names,
                                 const std::optional<std::string>& given_name, const nb::object& room,
                                 const nb::kwargs& keys) {
  must_be_open();
  const std::string name = name_of(given_name, "body", names_of_obstacles());
  const std::string where = "body `" + name + "`";
  nb::dict model, all = further_keys(keys, "body", where);
  model["model"] = "arrays";
  if (!room.is_none()) model["room"] = room;
  all["name"] = name;
  all["body"] = model;
  const Config section = section_of(all, table::obstacle_section(), where);
  const auto who = std::make_shared<Performance>(
      figure_of(body_of_arrays(name, x, triangles, joints, weights, parents, joint_names, where), where));
  warn_of_crossings(where, own_crossings(who->body, who->shape), who->warnings);
  if (!poses.is_none())
    perform_clip(clip_of_arrays(who->body, poses, translations, fps, where), section["body"], section["body"], *who);
  else if (!translations.is_none())
    throw Error("is given without poses", where + ", translations", "give poses, or place the body with `translate`");
  place_performance(section, name, *who);
  warn(who->warnings);
  const ObstaclePart part = obstacle_of(who);
  Points first = part.at(0);
  check_positions(first, where);
  setup_.scene.obstacles.push_back(part.obstacle);
  obstacles_.push_back(std::move(first));
  joined_.emplace_back();
  bodies_.push_back(who);
  body_frames_.push_back(part.body);
  return static_cast<int>(obstacles_.size()) - 1;
}

int SceneObject::add_obstacle_arrays(const nb::handle& x, const nb::handle& triangles,
                                     const std::optional<std::string>& given_name) {
  must_be_open();
  const std::string name = name_of(given_name, "obstacle", names_of_obstacles());
  const std::string noun = "obstacle `" + name + "`";
  Points first = points_of(x, noun + ", x");
  const Triangles faces = triangles_of(triangles, first.rows(), noun + ", triangles");
  WeldedSurface closed = closed_outward(noun, first, faces);
  const int number = add_obstacle(setup_.scene, static_cast<int>(first.rows()), faces, true, name);
  setup_.scene.obstacles.back().surface = std::move(closed.surface);
  obstacles_.push_back(std::move(first));
  joined_.push_back(std::move(closed.joined));
  bodies_.emplace_back();
  body_frames_.emplace_back();
  return number;
}

void SceneObject::move_obstacle(int number, const nb::handle& x) {
  must_rest();
  ensure_begun();
  const std::string where = "obstacle " + std::to_string(number);
  if (number < 0 || number >= std::ssize(obstacles_)) throw Error("is not there", where, "number obstacles from 0");
  if (bodies_[static_cast<std::size_t>(number)])
    throw Error("is a body, which its clip moves", where, "give `poses` to add_body");
  Points to = points_of(x, where);
  if (to.rows() != obstacles_[static_cast<std::size_t>(number)].rows())
    throw Error("has " + std::to_string(to.rows()) + " rows, not as many as before", where, "give every vertex");
  const std::vector<int>& joined = joined_[static_cast<std::size_t>(number)];
  const double width = seam_width(to, setup_.scene.obstacles[static_cast<std::size_t>(number)].surface);
  for (std::size_t v = 0; v < joined.size(); ++v)
    if (!((row(to, static_cast<int>(v)) - row(to, joined[v])).norm() <= width))
      throw Error("opens a seam: vertex " + std::to_string(v) + " leaves vertex " + std::to_string(joined[v]) +
                      ", where it lay when the obstacle was added",
                  where, "add parts that come apart as obstacles of their own");
  hold_together(joined, to);
  obstacles_[static_cast<std::size_t>(number)] = std::move(to);
}

}  // namespace selvedge
