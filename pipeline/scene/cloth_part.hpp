#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/steppers/following_stepper.hpp"
#include "pipeline/formats/mesh.hpp"
#include "pipeline/scene/setup_garment.hpp"

namespace selvedge {

struct PinPart {
  std::string name;                       // what the scene says of them: "of group top"
  std::vector<int> vertices;              // of the cloth, ascending
  std::function<Points(double time)> at;  // where they are, a row a vertex
  bool keyed = false;                     // moved by keyframes of their own, from time 0
};

// One cloth of a scene file, numbered by itself.
struct ClothPart {
  std::string name;
  Material material;
  Mesh mesh;     // x: as placed, at time 0
  Points first;  // where it is when the scene's time begins
  Points rest;
  std::vector<RestTriangle> rest_triangle;
  bool rest_is_flat = true;
  Points velocity;  // at time 0
  std::vector<PinPart> pins;
  std::vector<Follower> followers;
  std::shared_ptr<const Wearing> worn;  // null for what is no garment
  std::vector<int> sewn;  // of each vertex as read or made: its number here; empty where nothing is welded or sewn
  double sewn_apart = 0;  // how far vertices that are one now were apart [m]
  std::optional<Draping> draping;
  bool cut = false;  // its tangled triangles are cut out at the start
};

}  // namespace selvedge
