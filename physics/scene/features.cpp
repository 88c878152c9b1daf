#include "physics/scene/features.hpp"

#include <algorithm>
#include <cstdio>

#include "collision/geometry/counted.hpp"
#include "physics/scene/joint_lists.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

template <class Predicate>
int cloths_with(const Scene& scene, const Predicate& predicate) {
  return static_cast<int>(std::ranges::count_if(scene.cloths, [&](const Cloth& cloth) { return predicate(cloth); }));
}

bool has_membrane(const Cloth& cloth) {
  const Material& m = cloth.material;
  if (cloth.triangle_count == 0) return false;
  if (m.membrane == MembraneModel::baraff_witkin) return m.warp > 0 || m.weft > 0 || m.shear > 0;
  return m.lame_mu > 0 || m.lame_lambda > 0;
}

bool wants_bending(const Cloth& cloth, BendingModel model) {
  return cloth.material.bending_model == model && cloth.material.bending > 0;
}

// Curvature bending needs an inner vertex, hinge bending an inner edge.
struct Insides {
  std::vector<char> vertex, edge_at;  // of each vertex: is an inner one; has an inner edge
};

Insides insides(const Surface& surface) {
  Insides result;
  result.vertex.resize(surface.vertex_count);
  result.edge_at.assign(surface.vertex_count, 0);
  for (int v = 0; v < surface.vertex_count; ++v) result.vertex[v] = surface.vertex_owner[v] >= 0;
  for (int e = 0; e < surface.edges.rows(); ++e) {
    const bool inner = surface.edge_triangles[e][1] >= 0;
    for (const int v : {surface.edges(e, 0), surface.edges(e, 1)}) {
      if (inner) result.edge_at[v] = 1;
      if (!inner) result.vertex[v] = 0;
    }
  }
  return result;
}

bool any_in(const std::vector<char>& flags, const Cloth& cloth) {
  const auto begin = flags.begin() + cloth.first_vertex;
  return std::find(begin, begin + cloth.vertex_count, 1) != begin + cloth.vertex_count;
}

bool wind_acts(const Scene& scene) {
  return scene.wind.on && scene.wind.air_density > 0 && (scene.wind.drag > 0 || scene.wind.lift > 0) &&
         scene.surface.triangles.rows() > 0;
}

std::string why_bending(const Scene& scene, BendingModel model, bool in) {
  const std::string name = model == BendingModel::curvature ? "curvature form" : "hinge form";
  const int wanting = cloths_with(scene, [&](const Cloth& cloth) { return wants_bending(cloth, model); });
  if (in) return name + ", " + counted(wanting, "cloth") + " with bending > 0";
  if (wanting > 0)
    return "left out, no cloth of the " + name + " has an inner " +
           (model == BendingModel::curvature ? "vertex" : "edge");
  return "left out, no cloth uses the " + name + " with bending > 0";
}

std::string why_self(const Scene& scene, bool in) {
  if (!scene.contact.self) return "left out by the user; the file is labelled self: not audited";
  if (!in) return "left out, the scene has no triangles of cloth";
  return counted(scene.surface.triangles.rows(), "triangle") + " of cloth can meet, thickness " +
         number(scene.contact.thickness * 1e3) + " mm";
}

std::string why_friction(const Scene& scene, const Features& f) {
  if (!f.obstacles && !f.self_contact) return "left out, nothing touches";
  if (!f.friction) return "left out, its coefficients are 0";
  std::string why;
  if (f.obstacles) why += "cloth on obstacle " + number(scene.contact.friction);
  if (f.self_contact) why += (why.empty() ? "" : ", ") + ("cloth on cloth " + number(scene.contact.self_friction));
  return why;
}

std::string why_wind(const Scene& scene, bool in) {
  if (!scene.wind.on) return "left out, the scene has none";
  if (!in) return "left out, air density, or drag and lift, are 0";
  return "drag " + number(scene.wind.drag) + ", lift " + number(scene.wind.lift) + ", air " +
         number(scene.wind.air_density) + " kg/m3";
}

}  // namespace

Features features_of(const Scene& scene) {
  Features f;
  f.obstacles = !scene.obstacles.empty();
  f.moving_obstacles = std::ranges::any_of(scene.obstacles, [](const Obstacle& o) { return o.moving; });
  f.self_contact = scene.contact.self && scene.surface.triangles.rows() > 0;
  f.friction = (f.obstacles && scene.contact.friction > 0) || (f.self_contact && scene.contact.self_friction > 0);
  f.membrane = cloths_with(scene, has_membrane) > 0;
  const Insides inside = insides(scene.surface);
  f.curvature_bending = cloths_with(scene, [&](const Cloth& cloth) {
                          return wants_bending(cloth, BendingModel::curvature) && any_in(inside.vertex, cloth);
                        }) > 0;
  f.hinge_bending = cloths_with(scene, [&](const Cloth& cloth) {
                      return wants_bending(cloth, BendingModel::hinge) && any_in(inside.edge_at, cloth);
                    }) > 0;
  f.curved_rest = !scene.rest_is_flat && (f.curvature_bending || f.hinge_bending);
  f.stiffness_damping = cloths_with(scene, [](const Cloth& c) { return c.material.stiffness_damping > 0; }) > 0;
  f.mass_damping = cloths_with(scene, [](const Cloth& c) { return c.material.mass_damping > 0; }) > 0;
  f.wind = wind_acts(scene);
  f.pins = !scene.pins.empty();
  f.springs = !scene.springs.empty();
  return f;
}

std::vector<PlanLine> plan_lines(const Scene& scene) {
  const Features f = features_of(scene);
  const auto damped = [&](double Material::*rate) {
    return cloths_with(scene, [rate](const Cloth& cloth) { return cloth.material.*rate > 0; });
  };
  const auto moving = std::ranges::count_if(scene.obstacles, [](const Obstacle& o) { return o.moving; });
  const int membranes = cloths_with(scene, has_membrane);
  const auto damping_why = [&](bool in, double Material::*rate) {
    return in ? counted(damped(rate), "cloth") + " with a rate > 0"
              : std::string("left out, its rate is 0 in every cloth");
  };
  std::vector<PlanLine> lines{
      {"membrane", f.membrane,
       f.membrane ? counted(membranes, "cloth") + ", " + counted(scene.surface.triangles.rows(), "triangle")
                  : "left out, no cloth has a membrane stiffness > 0"},
      {"bending (curvature)", f.curvature_bending, why_bending(scene, BendingModel::curvature, f.curvature_bending)},
      {"bending (hinge)", f.hinge_bending, why_bending(scene, BendingModel::hinge, f.hinge_bending)},
      {"curved rest shape", f.curved_rest,
       f.curved_rest        ? "bending is measured from the rest shape"
       : scene.rest_is_flat ? "left out, the rest shape is flat"
                            : "left out, the scene has no bending"},
      {"stiffness damping", f.stiffness_damping, damping_why(f.stiffness_damping, &Material::stiffness_damping)},
      {"mass damping", f.mass_damping, damping_why(f.mass_damping, &Material::mass_damping)},
      {"wind", f.wind, why_wind(scene, f.wind)},
      {"pins", f.pins,
       f.pins ? counted(static_cast<long long>(scene.pins.size()), "vertex", "vertices") + " held"
              : "left out, the scene has none"},
      {"obstacles", f.obstacles,
       f.obstacles ? counted(static_cast<long long>(scene.obstacles.size()), "obstacle")
                   : "left out, the scene has none"},
      {"moving obstacles", f.moving_obstacles,
       f.moving_obstacles ? counted(moving, "obstacle") + " moving" : "left out, no obstacle moves"},
      {"self-contact", f.self_contact, why_self(scene, f.self_contact)},
      {"friction", f.friction, why_friction(scene, f)},
  };
  for_each_joint_list([&](auto list, const JointKind& kind) {
    const auto joints = std::ssize(scene.*list);
    if (joints > 0) lines.push_back({kind.name, true, counted(joints, kind.one, kind.many)});
  });
  return lines;
}

std::vector<PlanLine> ignored_lines(const Scene& scene, const StepperTraits& traits) {
  std::vector<PlanLine> lines;
  for (const PlanLine& line : plan_lines(scene))
    if (line.in && std::ranges::find(traits.ignores, line.feature) != traits.ignores.end())
      lines.push_back({line.feature, false, line.why + ", which the stepper `" + traits.name + "` ignores"});
  return lines;
}

Scene without_ignored(Scene scene, const StepperTraits& traits) {
  const auto ignored = [&](const std::string& force) {
    return std::ranges::find(traits.ignores, force) != traits.ignores.end();
  };
  for_each_joint_list([&](auto list, const JointKind& kind) {
    if (ignored(kind.name)) (scene.*list).clear();
  });
  if (ignored("wind")) scene.wind.on = false;
  for (Cloth& cloth : scene.cloths) {
    Material& m = cloth.material;
    if (ignored("membrane")) m.lame_mu = m.lame_lambda = m.warp = m.weft = m.shear = 0;
    if (ignored(m.bending_model == BendingModel::curvature ? "bending (curvature)" : "bending (hinge)")) m.bending = 0;
    if (ignored("stiffness damping")) m.stiffness_damping = 0;
    if (ignored("mass damping")) m.mass_damping = 0;
  }
  return scene;
}

}  // namespace selvedge
