#include "pipeline/formats/mesh_weld.hpp"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "collision/geometry/box_diagonal.hpp"
#include "collision/geometry/counted.hpp"
#include "collision/geometry/disjoint_sets.hpp"
#include "collision/geometry/error.hpp"
#include "collision/geometry/same_places.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/seam_places.hpp"

namespace selvedge {
namespace {

void renumber(const std::vector<int>& numbers, int count, Mesh& mesh) {
  Points x(count, 3);
  for (std::size_t v = numbers.size(); v-- > 0;)  // the lowest comes last and stays
    x.row(numbers[v]) = mesh.x.row(static_cast<Eigen::Index>(v));
  mesh.x = std::move(x);
  for (int& v : mesh.triangles.reshaped()) v = numbers[v];
  for (int& corner : mesh.corners) corner = numbers[corner];
  for (auto& [name, vertices] : mesh.groups) {
    for (int& v : vertices) v = numbers[v];
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }
}

int lower_elsewhere(const std::vector<int>& stands_for) {
  int count = 0;
  for (std::size_t v = 0; v < stands_for.size(); ++v) count += stands_for[v] != static_cast<int>(v);
  return count;
}

// Of each vertex the one that it is joined into, and what that comes to.
struct Joining {
  std::vector<int> stands_for;
  Welding count;
};

Joining joining_of(const Points& x, const Surface& surface, double distance) {
  const std::vector<int> places = same_places(x, distance);
  Joining result;
  if (std::optional<WeldedSurface> welded = welded_surface(surface, places)) {
    result.stands_for = std::move(welded->joined);
  } else {
    result.stands_for.resize(places.size());
    for (std::size_t v = 0; v < places.size(); ++v) result.stands_for[v] = static_cast<int>(v);
  }
  result.count.joined = lower_elsewhere(result.stands_for);
  result.count.apart = lower_elsewhere(places) - result.count.joined;
  return result;
}

// The direction from an edge to the third corner of its triangle, at a right angle to the edge.
Vec3 away(const Points& x, int a, int b, int corner) {
  const Vec3 along = (row(x, b) - row(x, a)).normalized(), to = row(x, corner) - row(x, a);
  return (to - along.dot(to) * along).normalized();
}

// Whether the two faces lie within 60 degrees of each other along most of the edges at which borders were joined.
bool is_layered(const Points& x, const Triangles& triangles, const std::vector<int>& stands_for) {
  struct Side {
    std::pair<int, int> vertices;
    Vec3 away;
  };
  std::map<std::pair<int, int>, std::vector<Side>> sides;
  for (int t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(t, k), b = triangles(t, (k + 1) % 3);
      sides[std::minmax({stands_for[a], stands_for[b]})].push_back(
          {std::minmax({a, b}), away(x, a, b, triangles(t, (k + 2) % 3))});
    }
  int joined = 0, folded = 0;
  for (const auto& [edge, faces] : sides) {
    if (faces.size() != 2 || faces[0].vertices == faces[1].vertices) continue;
    ++joined;
    folded += faces[0].away.dot(faces[1].away) > 0.5;
  }
  return 2 * folded > joined;
}

double distance_of(const Points& x, const Surface& surface) {
  return std::max(1e-3 * mean_edge(surface, x), 1e-6 * box_diagonal(x));
}

Surface surface_of(const Points& x, const Triangles& triangles) {
  return make_surface(static_cast<int>(x.rows()), triangles);
}

using Weights = SkinWeightRows;

// Parts places so that the weights of all vertices at one are nearly the same. Parts of a body that touch have other
// weights there and move apart; seams of textures have the same, but for rounding.
std::vector<int> alike_places(std::vector<int> places, const Weights& weights) {
  constexpr double most = 0.1;  // sum of the differences of two rows, each of which sums to 1
  part_places(
      [&](int v, int w) {
        if (v == w) return true;
        const Eigen::RowVectorXd one = weights.row(v), other = weights.row(w);
        return (one - other).lpNorm<1>() <= most;
      },
      places);
  return places;
}

std::vector<int> roots(DisjointSets& sets, int count) {
  std::vector<int> lowest;
  for (int v = 0; v < count; ++v) lowest.push_back(sets.root(v));
  return lowest;
}

// The triangles whose corners are three vertices.
Triangles whole(const Triangles& triangles) {
  std::vector<int> kept;
  for (int t = 0; t < triangles.rows(); ++t)
    if (const auto row = triangles.row(t); row[0] != row[1] && row[1] != row[2] && row[2] != row[0]) kept.push_back(t);
  return triangles(kept, Eigen::all);
}

// Of each connected piece whether all of its triangles are at the places of others, in lower pieces: it is a copy.
std::vector<char> copied_pieces(const Surface& surface, const std::vector<int>& places) {
  std::map<std::array<int, 3>, int> lowest;  // piece that has a triangle at these places
  const auto piece_of = [&](int t) { return surface.component[surface.triangles(t, 0)]; };
  const auto corners_of = [&](int t) {
    std::array<int, 3> at{};
    for (int k = 0; k < 3; ++k) at[k] = places[surface.triangles(t, k)];
    std::ranges::sort(at);
    return at;
  };
  for (int t = 0; t < surface.triangles.rows(); ++t) {
    int& piece = lowest.try_emplace(corners_of(t), piece_of(t)).first->second;
    piece = std::min(piece, piece_of(t));
  }
  std::vector<char> copied(static_cast<std::size_t>(surface.component_count), 1);
  for (int t = 0; t < surface.triangles.rows(); ++t)
    if (lowest[corners_of(t)] == piece_of(t)) copied[piece_of(t)] = 0;
  return copied;
}

// Of each vertex the lowest that it is joined with: at borders by closed_where_open, and what is open after that, in no
// triangle or a copy by its place.
std::vector<int> joined_where_open(const Points& x, const Surface& as_read, const Weights& weights,
                                   const std::vector<int>& parts) {
  const std::vector<int> same = same_places(x), places = alike_places(same, weights);
  const WeldedSurface closed = closed_where_open(as_read, {same, near_places(x, as_read, same), parts}, weights);
  const Surface& surface = closed.surface;
  DisjointSets sets(as_read.vertex_count);
  for (int v = 0; v < as_read.vertex_count; ++v) sets.join(v, closed.joined[v]);
  const std::vector<char> border = on_border(surface), copied = copied_pieces(surface, places);
  std::map<int, int> used, open;  // of a place the lowest vertex of a triangle, and that at a border
  const auto is_copy = [&](int v) { return surface.vertex_owner[v] >= 0 && copied[surface.component[v]]; };
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (surface.vertex_owner[v] >= 0 && !is_copy(v)) used.try_emplace(places[v], v);
    if (border[v]) open.try_emplace(places[v], v);
  }
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (border[v]) sets.join(v, open[places[v]]);
    if (as_read.vertex_owner[v] < 0 || is_copy(v)) sets.join(v, used.contains(places[v]) ? used[places[v]] : places[v]);
  }
  return roots(sets, surface.vertex_count);
}

}  // namespace

WeldedSurface closed_where_open(const Surface& as_read, const SeamPlaces& seams, const SkinWeightRows& weights) {
  const std::vector<int> places = alike_places(seams.same, weights), one_part(seams.parts.size(), 0);
  struct Pass {
    std::vector<int> places;
    const std::vector<int>& parts;
  };
  DisjointSets sets(as_read.vertex_count);
  Surface surface = as_read;
  for (const Pass& pass : {Pass{places, seams.parts},
                           {places, one_part},
                           {alike_places(seams.near, weights), one_part},
                           {seams.near, one_part}}) {
    const std::vector<char> border = on_border(surface);
    std::map<std::pair<int, int>, int> first;
    std::vector<int> open(border.size());
    for (int v = 0; v < surface.vertex_count; ++v)
      open[v] = border[v] ? first.try_emplace({pass.places[v], pass.parts[v]}, v).first->second : v;
    std::optional<WeldedSurface> welded = welded_surface(surface, open);
    if (!welded) continue;
    for (int v = 0; v < surface.vertex_count; ++v) sets.join(v, welded->joined[v]);
    surface = std::move(welded->surface);
  }
  return {std::move(surface), roots(sets, as_read.vertex_count)};
}

int coincident_vertices(const Points& x) { return lower_elsewhere(same_places(x)); }

int coincident_triangles(const Points& x, const Triangles& triangles) {
  const std::vector<int> places = same_places(x);
  std::vector<std::array<int, 3>> placed;
  for (int t = 0; t < static_cast<int>(triangles.rows()); ++t)
    if (std::optional<std::array<int, 3>> at = placed_corners(triangles, t, places)) {
      std::ranges::sort(*at);
      placed.push_back(*at);
    }
  std::ranges::sort(placed);
  return static_cast<int>(std::ranges::unique(placed).size());
}

double weld_distance(const Points& x, const Triangles& triangles) { return distance_of(x, surface_of(x, triangles)); }

Welding weldable(const Points& x, const Triangles& triangles) {
  const Surface surface = surface_of(x, triangles);
  Joining joining = joining_of(x, surface, distance_of(x, surface));
  if (joining.count.joined > 0) joining.count.layered = is_layered(x, triangles, joining.stands_for);
  return joining.count;
}

std::string unwelded_text(const Welding& welding, const std::string& cure) {
  const std::string vertices = counted(welding.joined, "vertex", "vertices");
  if (!welding.layered) return fmt::format("the seams are not welded: {} joins {}", cure, vertices);
  return fmt::format("layers meet at their borders and are not joined: {} joins {}, if they are sewn there", cure,
                     vertices);
}

Welding weld(Mesh& mesh, const std::string& name, std::optional<double> distance) {
  const Surface before = surface_of(mesh.x, mesh.triangles);
  if (const double edge = mean_edge(before, mesh.x); distance && *distance > 0.5 * edge)
    throw Error(fmt::format("is to be welded within {:g} of its units, and its edges are {:.3g} long on average",
                            *distance, edge),
                name, "give a distance below half of that, or none: the default is a thousandth of it");
  const Joining joining = joining_of(mesh.x, before, distance.value_or(distance_of(mesh.x, before)));
  join_at(joining.stands_for, mesh, name);
  const int crowded = surface_of(mesh.x, mesh.triangles).nonmanifold_edges;
  if (crowded > before.nonmanifold_edges)
    throw Error(fmt::format("cannot be welded: {} would have more than two triangles",
                            counted(crowded - before.nonmanifold_edges, "edge")),
                name, "remove triangles that lie on others, in the program that made the mesh");
  if (joining.count.apart > 0)
    mesh.warnings.push_back(fmt::format(
        "{}: {} not welded: pieces meet there in a point, or in more than two triangles an edge", name,
        counted(joining.count.apart, "vertex at the place of another is", "vertices at the places of others are")));
  return joining.count;
}

void renumber_look(const std::vector<int>& numbers, Mesh& mesh) {
  if (mesh.look.empty() && !mesh.corners.empty())
    mesh.look = plain_look(numbers.size(), mesh.corners, mesh.corner_begin);
  renumber(numbers, mesh.look);
}

void join_at(const std::vector<int>& stands_for, Mesh& mesh, const std::string& name) {
  mesh.welded.assign(stands_for.size(), 0);
  int count = 0;
  for (std::size_t v = 0; v < stands_for.size(); ++v)
    mesh.welded[v] = stands_for[v] == static_cast<int>(v) ? count++ : mesh.welded[stands_for[v]];
  renumber_look(mesh.welded, mesh);
  renumber(mesh.welded, count, mesh);
  leave_out_repeated(mesh, name);
}

void weld_as(const Mesh& welded, Mesh& mesh) {
  if (welded.welded.empty()) return;
  renumber(welded.welded, static_cast<int>(welded.x.rows()), mesh);
  mesh.triangles = welded.triangles;
}

SkinWeightRows join_alike(const std::vector<Eigen::Triplet<double>>& weights, Eigen::Index joints,
                          const std::vector<int>& parts, Mesh& mesh, const std::string& name) {
  Weights as_read(mesh.x.rows(), joints);
  as_read.setFromTriplets(weights.begin(), weights.end());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(as_read.rows());
  for (const Eigen::Triplet<double>& w : weights) sum[w.row()] += w.value();
  for (Eigen::Index v = 0; v < as_read.rows(); ++v) as_read.row(v) /= sum[v];
  const Surface surface = surface_of(mesh.x, whole(mesh.triangles));
  const std::vector<int> stands_for = joined_where_open(mesh.x, surface, as_read, parts);
  join_at(stands_for, mesh, name);
  std::vector<Eigen::Triplet<double>> kept;
  for (int v = 0; v < as_read.rows(); ++v)
    for (Weights::InnerIterator w(as_read, v); stands_for[v] == v && w; ++w)
      kept.emplace_back(mesh.welded[v], w.col(), w.value());
  Weights joined(mesh.x.rows(), joints);
  joined.setFromTriplets(kept.begin(), kept.end());
  return joined;
}

}  // namespace selvedge
