#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "collision/geometry/error.hpp"
#include "pipeline/garments/garment.hpp"

namespace selvedge {
namespace {

void check_vertices(const std::vector<int>& vertices, Eigen::Index count, const std::string& where) {
  const auto repeated = std::adjacent_find(vertices.begin(), vertices.end(), std::greater_equal());
  if (repeated != vertices.end())
    throw Error(fmt::format("has vertex {} before {}", repeated[0], repeated[1]), where, "give each once, ascending");
  if (!vertices.empty() && (vertices.front() < 0 || vertices.back() >= count))
    throw Error(
        fmt::format("names vertex {}, there are {}", vertices.front() < 0 ? vertices.front() : vertices.back(), count),
        where, "vertices count from 0");
}

void check_stitches(const std::vector<Stitch>& stitches, Eigen::Index count, const std::string& where) {
  for (const auto& [a, b, rest_length] : stitches) {
    if (std::min(a, b) < 0 || std::max(a, b) >= count)
      throw Error(fmt::format("join vertices {} and {}, there are {}", a, b, count), where, "vertices count from 0");
    if (a == b) throw Error(fmt::format("join vertex {} with itself", a), where, "join different vertices");
    if (!(rest_length >= 0 && std::isfinite(rest_length)))
      throw Error(fmt::format("have the rest length {}", rest_length), where, "give lengths in metres, at least 0");
  }
}

void check_flat(const Garment& garment, const std::string& where) {
  if (garment.flat.empty()) return;
  if (std::ssize(garment.flat) != garment.skin.triangles.rows())
    throw Error(fmt::format("has {} triangles, the garment {}", garment.flat.size(), garment.skin.triangles.rows()),
                where, "give the rest shape of every triangle, or leave it out");
  for (std::size_t t = 0; t < garment.flat.size(); ++t)
    if (!garment.flat[t].allFinite() || !(area(garment.flat[t]) > 0))
      throw Error(fmt::format("has no area in triangle {}", t), where, "list corners counter-clockwise, in metres");
}

}  // namespace

void check_garment(const Garment& garment, const std::string& file) {
  const Eigen::Index vertices = garment.skin.rest.rows(), joints = garment.skin.weights.cols();
  check_skin(garment.skin, joints, file);
  const BodyPose& made = garment.made_in;
  if (made.rotations.rows() != 0 && made.rotations.rows() != joints)
    throw Error(fmt::format("has {} joints, the weights have {}", made.rotations.rows(), joints), file + ": made_in",
                "give a rotation for every joint of the body, or leave it out");
  if (!made.rotations.allFinite() || !made.translation.allFinite())
    throw Error("is not finite", file + ": made_in", "repair the file where it was made");
  std::set<std::string> names;
  for (const auto& [name, members] : garment.groups) {
    if (name.empty() || !names.insert(name).second)
      throw Error(fmt::format("has the name `{}` twice or an empty one", name), file + ": groups",
                  "give every group its own name");
    check_vertices(members, vertices, file + ": groups `" + name + "`");
  }
  check_vertices(garment.pins, vertices, file + ": pins");
  check_stitches(garment.stitches, vertices, file + ": stitches");
  check_flat(garment, file + ": flat");
  check_look(garment.look, vertices, file + ": look");
}

}  // namespace selvedge
