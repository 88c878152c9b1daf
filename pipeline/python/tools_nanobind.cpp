#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>

#include "collision/audit/audit.hpp"
#include "collision/contour/find_contours.hpp"
#include "collision/distance/signed_distance.hpp"
#include "collision/geometry/error.hpp"
#include "collision/untangle/untangle.hpp"
#include "pipeline/formats/read_point_cache.hpp"
#include "pipeline/python/arrays_nanobind.hpp"
#include "pipeline/python/bindings_nanobind.hpp"
#include "pipeline/python/unlocked_nanobind.hpp"
#include "pipeline/tools/animated_run.hpp"

namespace selvedge {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

struct Meshes {
  std::vector<Surface> surfaces;
  std::vector<Points> points;
};

std::vector<SheetView> sheets_of(const Meshes& meshes) {
  std::vector<SheetView> sheets;
  for (std::size_t k = 0; k < meshes.points.size(); ++k) sheets.push_back({&meshes.surfaces[k], &meshes.points[k]});
  return sheets;
}

// Arrays as a mesh of its own, at the end of the list. `body`: what it is called if its closed shells are to face
// outwards; empty: it is a cloth.
void add_mesh(const nb::handle& x, const nb::handle& triangles, const std::string& before, const std::string& body,
              Meshes& meshes) {
  meshes.points.push_back(points_of(x, before + "x"));
  const Eigen::Index n = meshes.points.back().rows();
  Triangles faces = triangles_of(triangles, n, before + "triangles");
  if (body.empty())
    meshes.surfaces.push_back(make_surface(static_cast<int>(n), faces));
  else
    meshes.surfaces.push_back(closed_outward(body, meshes.points.back(), faces).surface);
}

// The cloth, then the bodies.
Meshes meshes_of(const nb::handle& x, const nb::handle& triangles, const nb::handle& bodies) {
  Meshes meshes;
  add_mesh(x, triangles, "", "", meshes);
  for (const nb::handle body : list_of(bodies, "bodies", "give a list of (x, triangles)")) {
    const std::string where = "body " + std::to_string(meshes.points.size() - 1);
    if (!nb::isinstance<nb::sequence>(body) || nb::len(body) != 2)
      throw Error("is no pair", where, "give (x, triangles) for every body");
    add_mesh(body[0], body[1], where + ", ", where, meshes);
  }
  return meshes;
}

nb::dict check_arrays(const nb::handle& x, const nb::handle& triangles, const nb::handle& bodies) {
  const Meshes meshes = meshes_of(x, triangles, bodies);
  std::vector<AuditBody> obstacles;
  for (std::size_t k = 1; k < meshes.points.size(); ++k) obstacles.push_back({&meshes.surfaces[k], &meshes.points[k]});
  const Audit found = unlocked([&] { return audit(meshes.surfaces[0], meshes.points[0], obstacles); });
  nb::dict result;
  result["self_pairs"] = found.self_pairs.size();
  result["vertex_pairs"] = found.vertex_pairs.size();
  result["body_pairs"] = found.obstacle_pairs.size();
  result["inside_vertices"] = found.inside_vertices;
  return result;
}

nb::tuple untangle_arrays(const nb::handle& x, const nb::handle& triangles, const nb::handle& bodies, int iterations) {
  const Meshes meshes = meshes_of(x, triangles, bodies);
  const std::vector<SheetView> sheets = sheets_of(meshes);
  if (iterations < 0) throw Error("is " + std::to_string(iterations), "untangle, iterations", "give 0 or more");
  UntangleOptions options;
  options.iterations = iterations;
  const UntangleResult result =
      unlocked([&] { return untangle(meshes.surfaces[0], meshes.points[0], std::span(sheets).subspan(1), options); });
  nb::dict report;
  report["pairs_before"] = result.pairs_before;
  report["pairs_after"] = result.pairs_after;
  report["iterations"] = result.iterations;
  return nb::make_tuple(copy_of(result.x), report);
}

// Where the contours' points are, k x 3.
Points contour_points(const std::vector<SheetView>& sheets, const Segments& found, const Contour& contour) {
  Points x(static_cast<Eigen::Index>(contour.points.size()), 3);
  for (std::size_t k = 0; k < contour.points.size(); ++k) {
    const int end = contour.points[k];
    x.row(static_cast<Eigen::Index>(k)) =
        end < 0 ? sheets[0].x->row(~end)
                : point_of(sheets, found.crossings[static_cast<std::size_t>(end)]).transpose().eval();
  }
  return x;
}

nb::list contours_of_arrays(const nb::handle& x, const nb::handle& triangles, const nb::handle& bodies) {
  const Meshes meshes = meshes_of(x, triangles, bodies);
  const std::vector<SheetView> sheets = sheets_of(meshes);
  const Segments found = unlocked([&] { return find_segments(sheets); });
  nb::list all;
  for (const Contour& contour : unlocked([&] { return find_contours(sheets, found); })) {
    nb::dict one;
    one["points"] = copy_of(contour_points(sheets, found, contour));
    one["closed"] = contour.closed;
    one["length"] = contour.length;
    nb::list sides;
    for (const ContourSide& side : contour.sides) {
      nb::dict its;
      its["sheet"] = side.sheet;
      its["triangles"] = copy_of(side.triangles);
      its["inside"] = copy_of(side.inside);
      sides.append(its);
    }
    one["sides"] = sides;
    all.append(one);
  }
  return all;
}

std::array<int, 3> sorted_corners(const Triangles& triangles, Eigen::Index t, const std::vector<int>& joined) {
  std::array<int, 3> corners{};
  for (int k = 0; k < 3; ++k) corners[k] = joined.empty() ? triangles(t, k) : joined[triangles(t, k)];
  std::ranges::sort(corners);
  return corners;
}

// Of each triangle of a surface that was closed its number among those given, which are in the same order, but for some
// that were left out.
std::vector<int> given_numbers(const Triangles& given, const WeldedSurface& closed) {
  std::vector<int> numbers;
  int next = 0;
  for (Eigen::Index t = 0; t < closed.surface.triangles.rows(); ++t) {
    const std::array<int, 3> corners = sorted_corners(closed.surface.triangles, t, {});
    while (next + 1 < given.rows() && sorted_corners(given, next, closed.joined) != corners) ++next;
    numbers.push_back(next++);
  }
  return numbers;
}

nb::dict distance_of_arrays(const nb::handle& points, const nb::handle& x, const nb::handle& triangles) {
  const Points at = points_of(points, "points");
  Points of_surface = points_of(x, "x");
  const Triangles given = triangles_of(triangles, of_surface.rows(), "triangles");
  const WeldedSurface closed = closed_outward("the surface", of_surface, given);
  const std::vector<int> numbers = given_numbers(given, closed);
  const std::vector<SignedDistance> found = unlocked([&] {
    DistanceField field(closed.surface);
    field.move_to(of_surface);
    return field.ask(at);
  });
  Eigen::VectorXd value(at.rows());
  Points gradient(at.rows(), 3), closest(at.rows(), 3);
  std::vector<int> triangle;
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    const SignedDistance& one = found[static_cast<std::size_t>(i)];
    value[i] = one.value;
    gradient.row(i) = one.gradient.transpose();
    closest.row(i) = one.closest.transpose();
    triangle.push_back(one.triangle < 0 ? -1 : numbers[static_cast<std::size_t>(one.triangle)]);
  }
  nb::dict result;
  result["value"] = copy_of(value);
  result["gradient"] = copy_of(gradient);
  result["closest"] = copy_of(closest);
  result["triangle"] = copy_of(triangle);
  return result;
}

nb::list read_surfaces(const std::filesystem::path& run, bool obstacles) {
  ExportRequest request;
  request.trajectory = trajectory_file(run);
  request.obstacles = obstacles;
  const AnimatedSurfaces made = unlocked([&] { return animated_run(request); }).surfaces;
  std::vector<nb::list> x(made.surfaces.size());
  for (int i = 0; i < made.frame_count; ++i) {
    const std::vector<PointsF> all = unlocked([&] { return made.frame(i); });
    for (std::size_t s = 0; s < x.size(); ++s)
      if (i == 0 || made.surfaces[s].moving) x[s].append(copy_of(Points(all[s].cast<double>())));
  }
  nb::list surfaces;
  for (std::size_t s = 0; s < x.size(); ++s) {
    const AnimatedSurface& surface = made.surfaces[s];
    const Look& look = surface.look;
    const Triangles& t = surface.triangles;
    std::vector<int> counts(static_cast<std::size_t>(t.rows()), 3), corners(t.data(), t.data() + t.size());
    if (!look.empty()) {
      for (int face = 0; face < look.faces(); ++face) counts[face] = look.end_of(face) - look.begin_of(face);
      counts.resize(look.begin.size());
      corners = look.corners;
    }
    nb::dict one;
    one["name"] = surface.name;
    one["cloth"] = surface.cloth;
    one["fps"] = made.fps;
    one["counts"] = copy_of(counts);
    one["corners"] = copy_of(corners);
    one["uv"] = copy_of(look.uv);
    one["corner_uv"] = copy_of(look.corner_uv);
    one["x"] = x[s];
    surfaces.append(one);
  }
  return surfaces;
}

nb::dict read_cache(const std::filesystem::path& file) {
  const PointCache cache = unlocked([&] { return read_point_cache(file); });
  nb::list x;
  for (const Points& frame : cache.frames) x.append(copy_of(frame));
  nb::dict result;
  result["fps"] = cache.fps;
  result["at"] = cache.at;
  result["x"] = x;
  return result;
}

}  // namespace

void bind_tools(nb::module_& module) {
  module.def("check", &check_arrays, "x"_a, "triangles"_a, "bodies"_a = nb::tuple(),
             "Audits a cloth, with itself and with bodies that stand still. x: positions, n x 3 [m]; triangles: m x 3; "
             "bodies: list of (x, triangles). Returns counts: self_pairs (triangles that share no vertex and "
             "intersect), vertex_pairs (that share one and cross), body_pairs, inside_vertices (of the cloth, in "
             "closed bodies).");
  module.def("contours", &contours_of_arrays, "x"_a, "triangles"_a, "bodies"_a = nb::tuple(),
             "The curves along which a cloth crosses itself or bodies, arguments as for check. Returns for each: "
             "points, k x 3 [m]; closed; length [m]; sides, two of sheet (0: the cloth, k: body k - 1), triangles (one "
             "a segment) and inside (vertices of the smaller part that the curve cuts off).");
  module.def("distance", &distance_of_arrays, "points"_a, "x"_a, "triangles"_a,
             "Signed distances of points, p x 3 [m], from a surface. Returns value, p [m], below 0 inside; gradient, "
             "p x 3, of unit length; closest, p x 3 [m]; triangle, p.");
  module.def("untangle", &untangle_arrays, "x"_a, "triangles"_a, "bodies"_a = nb::tuple(), "iterations"_a = 300,
             "Parts a cloth from itself and from bodies, arguments as for check. Returns positions, n x 3 [m], and a "
             "report: pairs_before, pairs_after, iterations.");
  module.def("read_surfaces", &read_surfaces, "run"_a, "obstacles"_a = false,
             "The cloths of a run (its run.h5 or folder), each by itself, and its obstacles, as exports have them: by "
             "the vertices and faces of the cloth's own file. A list of dicts: name; cloth, whether it is one; fps; "
             "counts, the corners of each face; corners, their vertices, one face after another; uv, k x 2; corner_uv, "
             "the row of uv of each corner, -1 for none, or empty; x, a list of n x 3 [m], one a frame, or one where "
             "the surface never moves.");
  module.def(
      "read_cache", &read_cache, "file"_a,
      "A point cache, .pc2, .pc16 (half floats, as CLOTH3D has them) or .mdd: fps, 0 where it does not say; at, when "
      "each sample is, in frames of that rate; x, a list of n x 3 in the file's unit, one a sample.");
}

}  // namespace selvedge
