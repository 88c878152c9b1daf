#include "pipeline/obstacles/setup_obstacle.hpp"

#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "collision/geometry/same_places.hpp"
#include "pipeline/formats/seam_places.hpp"
#include "pipeline/host/bounds.hpp"
#include "pipeline/obstacles/setup_mesh.hpp"
#include "pipeline/obstacles/setup_motion.hpp"
#include "pipeline/shapes/outward_mesh.hpp"
#include "pipeline/shapes/own_crossings.hpp"
#include "pipeline/shapes/primitives.hpp"

namespace selvedge {
namespace {

double checked_edge(const Config& shape, double area) {
  const double edge = shape["edge"].number();
  if (const double count = vertices_for(area, edge); !(count <= most_vertices))
    shape["edge"].fail(fmt::format("asks for about {:.3g} vertices; {} are the most", count, most_vertices),
                       "choose a longer edge");
  return edge;
}

Shape read_revolution(const Config& section) {
  const Config& list = section["profile"];
  const bool closed = section["closed"].flag();
  std::vector<Vec2> profile;
  double area = 0;
  for (std::size_t k = 0; k < list.items.size(); ++k) {
    const Config& point = list.items[k];
    const Vec2 at(point["at"].numbers[0], point["at"].numbers[1]);
    const bool end = !closed && (k == 0 || k + 1 == list.items.size());
    if (at.x() < 0 || (at.x() == 0 && !end))
      point.fail("is not beside the axis", end ? "give a distance of at least 0" : "give a distance above 0");
    if (k > 0 && at == profile.back()) point.fail("repeats the point before", "give every point once");
    if (k > 0) area += std::numbers::pi * (at.x() + profile.back().x()) * (at - profile.back()).norm();
    profile.push_back(at);
  }
  if (profile.size() < (closed ? 3u : 2u))
    list.fail("has too few points", closed ? "give at least three" : "give at least two");
  return make_revolution(profile, closed, checked_edge(section, area));
}

Shape read_primitive(const Config& section) {
  if (const Config& revolution = section["revolution"]; revolution.given) return read_revolution(revolution);
  if (const Config& plane = section["plane"]; plane.given) {
    const Vec2 size(plane["size"].numbers[0], plane["size"].numbers[1]);
    return make_plane(size, checked_edge(plane, size.prod()));
  }
  if (const Config& sphere = section["sphere"]; sphere.given) {
    const double r = sphere["radius"].number();
    return make_sphere(r, checked_edge(sphere, 4 * std::numbers::pi * r * r));
  }
  if (const Config& capsule = section["capsule"]; capsule.given) {
    const double r = capsule["radius"].number(), length = capsule["length"].number();
    return make_capsule(r, length, checked_edge(capsule, 2 * std::numbers::pi * r * (length + 2 * r)));
  }
  const Config& box = section["box"];
  const Vec3 size = box["size"].vector();
  if (!(size.minCoeff() > 0)) box["size"].fail("has a side that is not above 0", "give three positive lengths");
  const double area = 2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
  return make_box(size, checked_edge(box, area));
}

Sequence one_frame(Points x, Triangles triangles) { return {{std::move(x)}, std::move(triangles), steady(1, 1)}; }

// A body at rest is a sequence of one frame. Its closed shells face outwards.
Sequence read_body(const Config& section, const std::filesystem::path& folder, std::vector<std::string>& warnings) {
  if (section["sequence"].given) return read_sequence(section["sequence"], folder, warnings);
  if (const Config& run = section["trajectory"]; run.given) {
    Sequence recorded = read_recorded(run, folder, warnings);
    for (const Points& frame : recorded.frames) refuse_far(run, "the recorded obstacle", frame);
    const std::vector<int> places = seam_places(recorded.frames, recorded.triangles);
    turn_outward(run["file"].text(), {}, recorded.frames, places, recorded.triangles, warnings);
    warn_of_crossings(run["file"].text(), own_crossings({}, recorded.frames[0], recorded.triangles, places), warnings);
    return recorded;
  }
  if (const Config& file = section["mesh"]; file.given) {
    Mesh mesh = read_mesh_section(file, folder);
    warnings.insert(warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
    turn_outward(file["file"].text(), mesh, warnings);
    warn_of_crossings(file["file"].text(), mesh, warnings);
    return one_frame(mesh.x, mesh.triangles);
  }
  Shape shape = read_primitive(section);
  turn_outward("obstacle", {}, {&shape.x, 1}, same_places(shape.x), shape.triangles, warnings);
  return one_frame(std::move(shape.x), std::move(shape.triangles));
}

}  // namespace

std::string obstacle_name(const Config& section, std::size_t index) {
  return section["name"].given ? section["name"].text() : fmt::format("obstacle{}", index);
}

ObstaclePart read_obstacle(const Config& section, std::size_t index, const std::filesystem::path& folder,
                           std::vector<std::string>& warnings) {
  const auto body = std::make_shared<Sequence>(read_body(section, folder, warnings));
  const std::string noun = "obstacle `" + obstacle_name(section, index) + "`";
  for (Points& frame : body->frames) {
    frame = placed(section, frame);
    refuse_far(section, noun, frame);
  }
  for (const std::string kind : {"mesh", "sequence", "trajectory"})
    if (section[kind].given && !section[kind]["unit"].given)
      warn_of_extent(section, noun, largest_obstacle, true, body->frames[0], body->triangles, warnings);
  const Motion motion = read_motion(section["motion"], body->frames[0]);
  ObstaclePart part;
  part.obstacle.name = obstacle_name(section, index);
  part.obstacle.surface = closed_surface(body->frames, body->triangles).surface;
  part.obstacle.moving = body->frames.size() > 1 || !is_still(motion);
  if (body->frames.size() > 1) part.ends = body->times.last();
  part.at = [body, motion](double time) { return moved(motion, sequence_at(*body, time), time); };
  return part;
}

}  // namespace selvedge
