#include "pipeline/scene/setup_sheet.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "pipeline/formats/mesh_mtl.hpp"
#include "pipeline/host/bounds.hpp"
#include "pipeline/obstacles/setup_mesh.hpp"
#include "pipeline/scene/config_scene.hpp"
#include "pipeline/shapes/generate.hpp"

namespace selvedge {
namespace {

SheetOptions options_of(const Config& shape) {
  SheetOptions options;
  read_options(sheet_options(), shape, options);
  return options;
}

void check_count(const Config& shape, double vertices) {
  if (!(vertices <= most_vertices))
    shape.fail(fmt::format("asks for {:.3g} vertices; {} are the most", vertices, most_vertices),
               "choose a lower resolution or a longer edge");
}

// Vertices along both sides, from `resolution` or the edge length.
std::array<int, 2> counts(const Config& shape, double width, double height, int least_first) {
  const Config& resolution = shape["resolution"];
  std::array<double, 2> n{};
  if (resolution.given) {
    n = {resolution.numbers[0], resolution.numbers.back()};
  } else {
    const double edge = shape["edge"].number();
    n = {std::max<double>(least_first, std::ceil(width / edge - 1e-9) + (least_first == 2)),
         std::max(2.0, std::ceil(height / edge - 1e-9) + 1)};
  }
  if (n[0] < least_first) resolution.fail(fmt::format("is {}", n[0]), fmt::format("allowed: at least {}", least_first));
  check_count(shape, n[0] * n[1]);
  return {static_cast<int>(n[0]), static_cast<int>(n[1])};
}

Mesh read_ribbon(const Config& shape) {
  std::vector<LinePoint> line;
  for (const Config& point : shape["line"].items) {
    line.push_back({point["at"].vector(), (point["normal"].given ? point : shape)["normal"].vector()});
    if (line.back().normal.norm() == 0) point.fail("has no direction as its `normal`", "give a vector of any length");
    if (line.size() > 1 && line.back().at == line[line.size() - 2].at)
      point.fail("repeats the point before", "give every point of the line once");
  }
  if (line.size() < 2) shape["line"].fail("has fewer than two points", "give at least the ends");
  if (least_normal_angle(line) < 0.1)
    shape["normal"].fail("is along the ribbon's line somewhere", "give the points there a `normal` across the line");
  const double length = line_length(line), width = shape["width"].number();
  const auto [along, across] = counts(shape, length, width, 2);
  return make_ribbon(line, width, along, across, options_of(shape));
}

Mesh read_tshirt(const Config& shape) {
  const TshirtShape cut = tshirt_options().read(shape);
  if (cut.neck >= cut.width) shape["neck"].fail("is as wide as the body", "leave room for the shoulders");
  if (cut.sleeve_width >= cut.length) shape["sleeve_width"].fail("is as long as the body", "leave room for the sides");
  check_count(shape, 2 * (cut.width * cut.length + 2 * cut.sleeve_length * cut.sleeve_width) / (cut.edge * cut.edge));
  return make_tshirt(cut);
}

}  // namespace

Mesh read_sheet(const Config& section, const std::filesystem::path& folder) {
  if (const Config& shape = section["rectangle"]; shape.given) {
    const Vec2 size(shape["size"].numbers[0], shape["size"].numbers[1]);
    const auto [columns, rows] = counts(shape, size.x(), size.y(), 2);
    const SheetOptions options = options_of(shape);
    Mesh mesh = make_rectangle(size, columns, rows, options);
    const Vec2 grading(shape["grading"].numbers[0], shape["grading"].numbers[1]);
    if (grading == Vec2(1, 1)) return mesh;
    if (options.triangulation == Triangulation::unstructured)
      shape["grading"].fail("is for structured triangulations", "choose one_diagonal or alternating");
    grade_rectangle(mesh, size, columns, rows, grading);
    return mesh;
  }
  if (const Config& shape = section["disc"]; shape.given) {
    const double radius = shape["radius"].number();
    const double rings = shape["resolution"].given ? shape["resolution"].number()
                                                   : std::max(1.0, std::ceil(radius / shape["edge"].number() - 1e-9));
    check_count(shape, 3 * rings * rings);
    return make_disc(radius, static_cast<int>(rings), options_of(shape));
  }
  if (const Config& shape = section["tube"]; shape.given) {
    const double radius = shape["radius"].number(), height = shape["height"].number();
    const auto [around, rows] = counts(shape, 2 * std::numbers::pi * radius, height, 6);
    return make_tube(radius, height, around, rows, options_of(shape));
  }
  if (const Config& shape = section["ribbon"]; shape.given) return read_ribbon(shape);
  if (const Config& shape = section["tshirt"]; shape.given) return read_tshirt(shape);
  Mesh mesh = read_mesh_section(section["mesh"], folder);
  read_materials(mesh, MissingMtl::ignore);
  return mesh;
}

}  // namespace selvedge
