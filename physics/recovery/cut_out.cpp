#include "physics/recovery/cut_out.hpp"

#include <algorithm>
#include <map>

#include "collision/untangle/crossing_triangles.hpp"
#include "physics/energies/joints.hpp"

namespace selvedge {
namespace {

using Marks = std::vector<char>;  // one per triangle

Marks tangled(const Scene& scene, const State& state) {
  const ContactWorld world = make_contact_world(scene.surface, obstacle_surfaces(scene), scene.contact.self);
  const Points nodes = gather_nodes(state.x, state.obstacles);
  if (!nodes.allFinite()) return Marks(static_cast<std::size_t>(scene.surface.triangles.rows()), 1);
  Marks marks = crossing_triangles(world, nodes);
  const Marks rounded = crossing_triangles(world, nodes.cast<float>().cast<double>());
  for (std::size_t t = 0; t < marks.size(); ++t) marks[t] = marks[t] || rounded[t];
  return marks;
}

// The part of the cloth to which each vertex belongs, if only the triangles `there` exist, with the springs between
// their vertices.
std::vector<int> parts_of(const Scene& scene, const Marks& there) {
  const Triangles& all = scene.surface.triangles;
  Triangles triangles(std::ranges::count(there, 1), 3);
  Marks has(static_cast<std::size_t>(scene.surface.vertex_count), 0);
  Eigen::Index next = 0;
  for (Eigen::Index t = 0; t < all.rows(); ++t) {
    if (!there[static_cast<std::size_t>(t)]) continue;
    triangles.row(next++) = all.row(t);
    for (const int v : all.row(t)) has[v] = 1;
  }
  const Surface surface = make_surface(scene.surface.vertex_count, triangles);
  std::vector<int> parts = surface.component;
  const std::vector<int> joined = joined_parts(scene, parts, surface.component_count, has);
  for (int& part : parts) part = joined[part];
  return parts;
}

std::vector<int> cloth_of_triangles(const Scene& scene) {
  std::vector<int> cloths;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c)
    cloths.insert(cloths.end(), static_cast<std::size_t>(scene.cloths[c].triangle_count), static_cast<int>(c));
  return cloths;
}

// The triangles to cut out. `stay` are in the simulation already. Others without `out` come in if their part is held:
// it has triangles that stay or pins, or it is the largest part of a piece of cloth of which nothing stays.
std::vector<int> cut_out(const Scene& scene, const Marks& stay, const Marks& out) {
  const Triangles& triangles = scene.surface.triangles;
  const int count = static_cast<int>(triangles.rows());
  Marks there(out.size());
  std::ranges::transform(out, there.begin(), [](char marked) { return !marked; });
  const std::vector<int> part = parts_of(scene, there), whole = parts_of(scene, Marks(out.size(), 1));
  const std::vector<int> cloth = cloth_of_triangles(scene);
  Marks held(static_cast<std::size_t>(scene.surface.vertex_count), 0);  // one per part
  struct Piece {
    bool stays = false;
    std::map<int, int> sizes;  // numbers of triangles of its parts
  };
  std::map<std::pair<int, int>, Piece> pieces;  // by uncut part and cloth
  for (int t = 0; t < count; ++t) {
    Piece& piece = pieces[{whole[triangles(t, 0)], cloth[t]}];
    piece.stays = piece.stays || stay[t];
    if (there[t]) ++piece.sizes[part[triangles(t, 0)]];
    if (stay[t]) held[part[triangles(t, 0)]] = 1;
  }
  for (const auto& [key, piece] : pieces)
    if (!piece.stays && !piece.sizes.empty())
      held[std::ranges::max_element(piece.sizes, {}, [](const auto& size) { return size.second; })->first] = 1;
  for (const int pin : scene.pins) held[part[pin]] = 1;
  std::vector<int> cut;
  for (int t = 0; t < count; ++t)
    if (!there[t] || !held[part[triangles(t, 0)]]) cut.push_back(t);
  return cut;
}

}  // namespace

std::vector<char> all_but(const Scene& scene, const std::vector<int>& cut_out) {
  Marks marks(static_cast<std::size_t>(scene.surface.triangles.rows()), 1);
  for (const int t : cut_out) marks[t] = 0;
  return marks;
}

std::vector<int> cut_out_at_start(const Scene& scene, const State& state, const std::vector<char>& may) {
  Marks out = tangled(scene, state), stay(may.size());
  for (std::size_t t = 0; t < may.size(); ++t) {
    out[t] = out[t] && may[t];
    stay[t] = !may[t];
  }
  return cut_out(scene, stay, out);
}

std::vector<int> still_cut_out(const Scene& scene, const State& state) {
  const Marks stay = all_but(scene, state.cut_out);
  Marks out = tangled(scene, state);
  for (std::size_t t = 0; t < out.size(); ++t) out[t] = out[t] && !stay[t];
  return cut_out(scene, stay, out);
}

}  // namespace selvedge
