#pragma once

#include "pipeline/scene/setup.hpp"
#include "pipeline/scene/setup_garment.hpp"
#include "pipeline/scene/setup_start.hpp"

namespace selvedge {

struct PinPart {
  std::vector<int> vertices;              // of the cloth, ascending
  std::function<Points(double time)> at;  // where they are, a row a vertex
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
  std::shared_ptr<const Wearing> worn;  // null for what is no garment
  std::vector<int> sewn;                // of each vertex as read or made: its number here; empty where nothing is sewn
  double sewn_apart = 0;                // how far vertices that are one now were apart [m]
  std::optional<Draping> draping;
  bool cut = false;  // what of it is tangled is cut out at the start
};

// The cloth of a section, or its copies. `folder` is the scene file's; warnings are added. The material's values are
// written back into the section.
std::vector<ClothPart> read_cloths(Config& section, const std::string& default_name,
                                   const std::filesystem::path& folder, const Performances&,
                                   std::vector<std::string>& warnings);

// The vertices that `vertices`, `box` or `group` of a section name; all where it names none. Vertices that are listed
// keep their order and have the numbers that they were read or made with; those that come back have the part's own.
std::vector<int> read_vertices(const Config& section, const ClothPart&);
std::vector<int> read_selection(const Config& section, const ClothPart&);  // the same, ascending, each once

// The flat metric of every triangle, v along the part of `weft` in the triangle's plane.
std::vector<RestTriangle> flattened(const Points& x, const Triangles&, const Vec3& weft);

}  // namespace selvedge
