#include "pipeline/formats/look.hpp"

#include <numeric>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw Error(what, where, "the file is damaged; make it again from the mesh");
}

// Indices from `least` to below `end`; as many as `size`, or none where they may be left out.
void check_indices(const std::vector<int>& indices, int least, Eigen::Index end, std::size_t size, bool optional,
                   const std::string& where) {
  if (indices.size() != size && !(optional && indices.empty()))
    refuse(where, fmt::format("has {} entries, not {}", indices.size(), size));
  for (const int index : indices)
    if (index < least || index >= end) refuse(where, fmt::format("names {}, which is not there", index));
}

}  // namespace

Look plain_look(std::size_t vertices, const std::vector<int>& corners, const std::vector<int>& begin) {
  Look look;
  look.vertex.resize(vertices);
  std::iota(look.vertex.begin(), look.vertex.end(), 0);
  look.corners = corners;
  look.begin = begin;
  return look;
}

void renumber(const std::vector<int>& numbers, Look& look) {
  for (int& v : look.vertex) v = numbers[static_cast<std::size_t>(v)];
}

void check_look(const Look& look, Eigen::Index vertices, const std::string& where) {
  const std::size_t corners = look.corners.size(), faces = look.begin.size();
  check_indices(look.vertex, 0, vertices, look.vertex.size(), false, where + "/vertex");
  check_indices(look.corners, 0, std::ssize(look.vertex), corners, false, where + "/corners");
  for (int face = 0; face < look.faces(); ++face)
    if ((face == 0 && look.begin[0] != 0) || look.end_of(face) - look.begin_of(face) < 3)
      refuse(where + "/begin", fmt::format("gives face {} fewer than three corners", face));
  check_indices(look.corner_uv, -1, look.uv.rows(), corners, true, where + "/corner_uv");
  if (!look.uv.allFinite()) refuse(where + "/uv", "is not finite");
  check_indices(look.corner_normal, -1, std::ssize(look.corners), corners, true, where + "/corner_normal");
  check_indices(look.face_material, -1, std::ssize(look.materials), faces, true, where + "/face_material");
  check_indices(look.face_part, 0, std::ssize(look.parts), faces, true, where + "/face_part");
}

}  // namespace selvedge
