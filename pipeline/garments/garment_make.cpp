#include "pipeline/garments/garment_make.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "collision/geometry/surface.hpp"
#include "pipeline/bodies/mannequin_skin.hpp"
#include "pipeline/garments/garment_trim.hpp"
#include "pipeline/shapes/clipped.hpp"
#include "pipeline/shapes/isosurface.hpp"
#include "pipeline/shapes/mirrored_mesh.hpp"
#include "pipeline/shapes/remesh.hpp"

namespace selvedge {
namespace {

const GarmentCut& cut_of(const std::string& name) {
  for (const GarmentCut& cut : garment_cuts())
    if (cut.name == name) return cut;
  throw Error("is the unknown garment `" + name + "`", "garment",
              "one of " + fmt::format("{}", fmt::join(garment_names(), ", ")));
}

double ease_at(const GarmentCut& cut, const Vec3& p) {
  double ease = at(cut.ease, p.y());
  const double reach = std::abs(p.x());
  if (!cut.sleeve_ease.empty())  // sleeves begin at the shoulders and only above the armpits
    ease += smooth_step(reach, 0.16, 0.24) * smooth_step(p.y(), 1.10, 1.25) * (at(cut.sleeve_ease, reach) - ease);
  if (cut.legs_apart) {  // between the legs there is little room
    constexpr double least = 0.004;
    ease += (1 - smooth_step(reach, 0.03, 0.11)) * (1 - smooth_step(p.y(), 0.78, 0.90)) * (least - ease);
  }
  return ease;
}

// The approximate distance of a point beyond the nearest opening, negative on the kept side [m].
double beyond(const GarmentCut& cut, const Vec3& p) {
  const Vec3 q(std::abs(p.x()), p.y(), p.z());
  double farthest = -1;
  for (const Opening& opening : cut.openings) farthest = std::max(farthest, opening.border.value(q));
  return farthest;
}

// A garment's surface is the zero level of `surface`. `solid` is the solid that it encloses, for garments over it;
// beyond the openings it becomes narrower slowly, so that these pass over its borders without a step.
struct Field {
  DistanceField surface, solid;
};

Field field_of(const GarmentCut& cut, const GarmentOptions& options, const std::vector<Field>& under) {
  std::vector<Limb> lofts;
  if (!cut.lofts.empty()) lofts.push_back({cut.lofts, 0.03});
  // The form has arms only at x > 0.
  const Form form = mannequin_form(cut.limbs, std::move(lofts));
  const double more = sagitta(options.edge);
  const auto surface = [&cut, form, more, gap = options.gap, under](const Vec3& p) {
    constexpr double blend = 0.02;
    double value = signed_value(form, Vec3(std::abs(p.x()), p.y(), p.z())) - ease_at(cut, p) - more;
    for (const Field& inner : under) value = merged(value, inner.solid(p) - gap - 1.5 * more, blend);
    return value;
  };
  const auto solid = [&cut, surface](const Vec3& p) {
    constexpr double slope = 0.25;
    return surface(p) + slope * std::max(0.0, beyond(cut, p));
  };
  return {surface, solid};
}

// The half at x >= 0, with boundaries at the openings.
Shape half_of(const GarmentCut& cut, const Field& field, double edge) {
  constexpr int rounds = 6;
  const double grid = std::min(0.8 * edge, 0.015);
  const auto nearby = [&](const Vec3& p) { return beyond(cut, p) > 8 * grid ? 1.0 : field.surface(p); };
  Shape shape = isosurface(nearby, Vec3(0, -0.02, -0.6), Vec3(0.9, 1.56, 0.6), grid);
  RemeshTarget target{[edge](const Vec3&) { return edge; }, [&](const Vec3& p) { return projected(field.surface, p); }};
  for (const Opening& opening : cut.openings) {
    shape = clipped(shape, opening.border, target.borders, 0.1 * grid);
    target.borders.push_back(opening.border);
  }
  return remeshed(largest_component(shape), target, rounds);
}

void add_opening_groups(const GarmentCut& cut, const Shape& shape, NamedVertices& groups) {
  const Surface surface = make_surface(static_cast<int>(shape.x.rows()), shape.triangles);
  for (const std::vector<int>& loop : boundary_loops(surface))
    for (const int v : loop) {
      const Vec3 p = row(shape.x, v), q(std::abs(p.x()), p.y(), p.z());
      for (const Opening& opening : cut.openings)
        if (std::abs(opening.border.value(q)) < 1e-6)
          group_named(groups, !opening.paired ? opening.group : opening.group + (p.x() > 0 ? "_left" : "_right"))
              .push_back(v);
    }
}

void add_place_groups(const GarmentCut& cut, const Shape& shape, double edge, NamedVertices& groups) {
  for (int v = 0; v < shape.x.rows(); ++v) {
    const Vec3 p = row(shape.x, v);
    const double reach = std::abs(p.x());
    if (p.y() > 1.38 && reach > 0.05 && reach < 0.2)
      group_named(groups, p.x() > 0 ? "shoulder_left" : "shoulder_right").push_back(v);
    if (cut.pinned != "waist" && std::abs(p.y() - 1.08) < edge) group_named(groups, "waist").push_back(v);
  }
}

void add_trimmings(const GarmentCut& cut, const Field& field, double edge, Shape& shape, NamedVertices& groups,
                   std::vector<Stitch>& stitches) {
  const int ground = static_cast<int>(shape.x.rows());
  for (const Opening& opening : cut.openings)
    if (opening.group == "neck" && cut.collar > 0)
      groups.emplace_back("collar", add_collar(shape, field.surface, opening.border, cut.collar, edge));
  for (const Pocket& pocket : cut.pockets)
    for (const int v : add_pocket(shape, field.surface, pocket, edge, ground, stitches))
      group_named(groups, "pocket").push_back(v);
}

}  // namespace

Garment make_garment(const std::string& name, const BodyModel& mannequin, const GarmentOptions& options,
                     std::span<const std::string> under) {
  if (!(options.edge >= 0.005 && options.edge <= 0.05))
    throw Error(fmt::format("is {} m", options.edge), "edge of a garment", "allowed: 0.005 to 0.05 m");
  // Over other garments the neck is thicker, and so the opening must be wider.
  std::deque<GarmentCut> cuts;
  const auto over_others = [&](const GarmentCut& cut) -> const GarmentCut& {
    const double more = static_cast<double>(cuts.size()) * (options.gap + 1.5 * sagitta(options.edge));
    cuts.push_back(cut);
    for (Opening& opening : cuts.back().openings)
      if (opening.widened) opening.border = opening.widened(more);
    return cuts.back();
  };
  std::vector<Field> fields;
  for (const std::string& inner : under)
    if (cut_of(inner).collar > 0 || !cut_of(inner).pockets.empty())
      throw Error("has a collar or pockets", "garment " + inner + " under others", "wear it over them");
  for (const std::string& inner : under) fields.push_back(field_of(over_others(cut_of(inner)), options, fields));
  const GarmentCut& cut = over_others(cut_of(name));
  const Field field = field_of(cut, options, fields);
  Shape shape = mirrored(half_of(cut, field, options.edge)).shape;
  Garment garment;
  garment.name = name;
  garment.made_for = mannequin.name;
  add_opening_groups(cut, shape, garment.groups);
  add_place_groups(cut, shape, options.edge, garment.groups);
  add_trimmings(cut, field, options.edge, shape, garment.groups, garment.stitches);
  for (auto& [group, vertices] : garment.groups) std::sort(vertices.begin(), vertices.end());
  const Points x = shape.x.rowwise() - mannequin_joints().front().position.transpose();
  garment.skin = attached(x, shape.triangles, mannequin, cut.fit);
  for (const auto& [group, vertices] : garment.groups)
    if (group == cut.pinned) garment.pins = vertices;
  return garment;
}

std::vector<std::string> garment_names() {
  std::vector<std::string> names;
  for (const GarmentCut& cut : garment_cuts()) names.push_back(cut.name);
  return names;
}

}  // namespace selvedge
