#include "physics/scene/make_scene.hpp"

#include <algorithm>
#include <iterator>

#include "collision/geometry/error.hpp"
#include "physics/scene/scene_numbers.hpp"

namespace selvedge {
namespace {

void require(bool fits, const std::string& what, const std::string& where, const std::string& cure) {
  if (!fits) throw Error(what, where, cure);
}

void check_triangles(int vertex_count, const Triangles& triangles, const std::string& where) {
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const int a = triangles(t, 0), b = triangles(t, 1), c = triangles(t, 2);
    const std::string row = "triangle " + std::to_string(t);
    require(std::min({a, b, c}) >= 0 && std::max({a, b, c}) < vertex_count,
            row + " has a vertex that is not there: there are " + std::to_string(vertex_count), where,
            "number vertices from 0");
    require(a != b && b != c && c != a, row + " has a vertex twice", where, "leave the triangle out");
  }
}

// What has no mass would hold the cloth that it is joined to.
void check_masses(const Scene& scene) {
  const Eigen::VectorXd masses = lumped_masses(scene);
  std::vector<char> pinned(static_cast<std::size_t>(masses.size()), 0);
  for (const int pin : scene.pins) pinned[static_cast<std::size_t>(pin)] = 1;
  for (const Cloth& cloth : scene.cloths)
    for (const auto& triangle :
         scene.surface.triangles.middleRows(cloth.first_triangle, cloth.triangle_count).rowwise())
      for (const int v : triangle)
        if (!(masses[v] > 0) && !pinned[static_cast<std::size_t>(v)])
          throw Error(
              "vertex " + std::to_string(v - cloth.first_vertex) + " has no mass: no triangle at it has an area",
              "cloth `" + cloth.name + "`", "leave these triangles out, or pin the vertex");
}

std::string named(const std::string& name, const char* kind, std::size_t number) {
  return name.empty() ? kind + std::to_string(number) : name;
}

}  // namespace

std::vector<RestTriangle> flattened(const Points& rest, const Triangles& triangles) {
  std::vector<RestTriangle> flat;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    flat.push_back(flatten(row(rest, triangles(t, 0)), row(rest, triangles(t, 1)), row(rest, triangles(t, 2))));
  return flat;
}

void add_cloths(Scene& scene, const std::vector<NewCloth>& added) {
  std::vector<std::string> names;
  for (const NewCloth& one : added) {
    const std::string& name = names.emplace_back(named(one.name, "cloth", scene.cloths.size() + names.size()));
    check_triangles(static_cast<int>(one.rest.rows()), one.triangles, name);
    check_positions(one.rest, "cloth `" + name + "`, x");
    check_numbers(one.material, "cloth `" + name + "`, material");
    require(one.metric.empty() || std::ssize(one.metric) == one.triangles.rows(),
            "there are not as many rest shapes as triangles", name, "give one a triangle, or none");
  }
  Eigen::Index vertices = scene.rest.rows(), triangles = scene.surface.triangles.rows();
  Points rest = std::move(scene.rest);
  Triangles joined = std::move(scene.surface.triangles);
  for (const NewCloth& one : added) vertices += one.rest.rows(), triangles += one.triangles.rows();
  Eigen::Index vertex = rest.rows(), triangle = joined.rows();
  rest.conservativeResize(vertices, 3);
  joined.conservativeResize(triangles, 3);
  for (std::size_t k = 0; k < added.size(); ++k) {
    const NewCloth& one = added[k];
    scene.cloths.push_back({names[k], one.material, static_cast<int>(vertex), static_cast<int>(one.rest.rows()),
                            static_cast<int>(triangle), static_cast<int>(one.triangles.rows())});
    const std::vector<RestTriangle> own = one.metric.empty() ? flattened(one.rest, one.triangles) : one.metric;
    scene.rest_triangle.insert(scene.rest_triangle.end(), own.begin(), own.end());
    rest.middleRows(vertex, one.rest.rows()) = one.rest;
    joined.middleRows(triangle, one.triangles.rows()) = (one.triangles.array() + static_cast<int>(vertex)).matrix();
    vertex += one.rest.rows();
    triangle += one.triangles.rows();
  }
  scene.rest = std::move(rest);
  scene.surface = make_surface(static_cast<int>(vertices), joined);
}

int add_cloth(Scene& scene, const Points& rest, const Triangles& triangles, const Material& material,
              const std::string& name, const std::vector<RestTriangle>& metric) {
  add_cloths(scene, {{rest, triangles, material, name, metric}});
  return static_cast<int>(scene.cloths.size()) - 1;
}

int add_obstacle(Scene& scene, int vertex_count, const Triangles& triangles, bool moving, const std::string& name) {
  const std::string called = named(name, "obstacle", scene.obstacles.size());
  check_triangles(vertex_count, triangles, called);
  scene.obstacles.push_back({called, make_surface(vertex_count, triangles), moving});
  return static_cast<int>(scene.obstacles.size()) - 1;
}

State first_state(const Scene& scene, const Points& x, const std::vector<Points>& obstacles) {
  require(x.rows() == scene.surface.vertex_count,
          "there are positions of " + std::to_string(x.rows()) + " vertices, the cloths have " +
              std::to_string(scene.surface.vertex_count),
          "first state", "give all cloths on end");
  require(obstacles.size() == scene.obstacles.size(), "there are not as many positions as obstacles", "first state",
          "give those of every obstacle, in its order");
  for (std::size_t k = 0; k < obstacles.size(); ++k)
    require(obstacles[k].rows() == scene.obstacles[k].surface.vertex_count,
            "the obstacle " + scene.obstacles[k].name + " has another number of vertices", "first state", "");
  check_scene(scene);
  check_masses(scene);
  State state;
  state.x = x;
  state.v = Points::Zero(x.rows(), 3);
  state.obstacles = obstacles;
  check_state(scene, state);
  return state;
}

Drive at_rest(const Scene& scene, const State& state) {
  Drive drive;
  drive.pins = state.x(scene.pins, Eigen::all);
  drive.obstacles = state.obstacles;
  drive.acceleration = {0, -9.81, 0};
  return drive;
}

}  // namespace selvedge
