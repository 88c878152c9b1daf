#pragma once

#include <optional>
#include <string>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

struct LookMaterial {
  std::string name;
  std::optional<Vec3> colour = {};  // diffuse (Kd), linear, 0 to 1
  std::string texture = {};         // file of the diffuse texture (map_Kd), relative; empty: none
  bool operator==(const LookMaterial&) const = default;
};

// What stands before a face in OBJ: the names after `o` and `g`, and the word after `s`; empty: no such line.
struct LookPart {
  std::string object = {}, groups = {}, smoothing = {};
  auto operator<=>(const LookPart&) const = default;
};

// How a mesh file shows a surface, by the vertices and faces of that file: what exports give back. Empty where vertices
// and triangles say all that the file does.
struct Look {
  std::vector<int> vertex;          // of each vertex of the file: that of the surface; several may be one
  std::vector<int> corners, begin;  // vertices (of the file) of its faces one after another, and where each face begins
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> uv;
  std::vector<int> corner_uv;      // of each corner: row of uv, -1 for none; empty: the file has no uv
  std::vector<int> corner_normal;  // corners at one vertex with one number have one normal; -1, empty: the same
  std::vector<LookMaterial> materials;
  std::vector<int> face_material;  // -1: none; empty: the file names no material
  std::vector<LookPart> parts;
  std::vector<int> face_part;  // empty: the file has no parts

  bool empty() const { return begin.empty(); }
  int faces() const { return static_cast<int>(begin.size()); }
  int begin_of(int face) const { return begin[static_cast<std::size_t>(face)]; }
  int end_of(int face) const { return face + 1 < faces() ? begin_of(face + 1) : static_cast<int>(corners.size()); }
};

// The look of a file of which vertices and faces are kept and nothing else; arguments as Look has them.
Look plain_look(std::size_t vertices, const std::vector<int>& corners, const std::vector<int>& begin);

// After vertices of the surface were joined or numbered anew: numbers[v] is the new number of v.
void renumber(const std::vector<int>& numbers, Look&);

// Throws Error, naming `where`, unless sizes match and all indices are in range. `vertices`: of the surface.
void check_look(const Look&, Eigen::Index vertices, const std::string& where);

}  // namespace selvedge
