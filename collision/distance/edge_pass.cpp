#include "collision/distance/edge_pass.hpp"

#include <algorithm>
#include <functional>

namespace selvedge {
namespace {

using Weights = Eigen::Vector3d;

// An edge or a triangle of the garment, and its deepest point found so far.
struct DeepPlace {
  DeepPlace(const std::array<int, 3>& vertices, int count) : vertex(vertices), corners(count) {}
  std::array<int, 3> vertex;
  int corners;
  Weights weight = Weights::Zero();  // of the corners, sum 1
  SignedDistance at;

  Vec3 point(const Points& x, const Weights& w) const {
    Vec3 p = Vec3::Zero();
    for (int k = 0; k < corners; ++k) p += w[k] * row(x, vertex[k]);
    return p;
  }
};

struct Touched {
  std::vector<int> edges, triangles;  // ascending
  int pairs = 0;
};

// The garment's edges and triangles that meet the body.
Touched touched_by(const DistanceField& body, const Surface& garment, const Points& x, EdgePassMemory& memory) {
  Touched touched;
  const auto pairs = intersecting_pairs(garment, x, memory.garment, body.surface(), body.positions(), memory.body);
  touched.pairs = static_cast<int>(pairs.size());
  for (const auto& [t, other] : pairs) {
    touched.triangles.push_back(t);
    for (int k = 0; k < 3; ++k) touched.edges.push_back(garment.triangle_edges(t, k));
  }
  sort_once(touched.edges);
  sort_once(touched.triangles);
  return touched;
}

using Tries = std::vector<std::vector<Weights>>;  // of each place

std::vector<SignedDistance> ask_tries(const DistanceField& body, const Points& x, const Tries& tries,
                                      const std::vector<DeepPlace>& places) {
  Eigen::Index count = 0;
  for (const auto& of_place : tries) count += std::ssize(of_place);
  Points at(count, 3);
  Eigen::Index next = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (const Weights& w : tries[i]) at.row(next++) = places[i].point(x, w).transpose();
  return body.ask(at);
}

void keep_deeper(const Weights& weight, const SignedDistance& at, DeepPlace& place) {
  if (!place.weight.isZero(0) && !(at.value < place.at.value)) return;
  place.at = at;
  place.weight = weight;
}

// Points near the deepest one so far, only in directions in which the distance falls.
std::vector<Weights> downhill(const Points& x, const DeepPlace& place, double step) {
  std::vector<Weights> tries;
  for (int from = 0; from < place.corners; ++from)
    for (int to = 0; to < place.corners; ++to) {
      const double part = std::min(step, place.weight[from]);
      if (from == to || part <= 0) continue;
      if (place.at.gradient.dot(row(x, place.vertex[to]) - row(x, place.vertex[from])) > 0) continue;
      Weights w = place.weight;
      w[from] -= part;
      w[to] += part;
      tries.push_back(w);
    }
  return tries;
}

// Searches for the deepest points, with half the step each time.
void descend(const DistanceField& body, const Points& x, std::vector<DeepPlace>& places) {
  Tries tries(places.size());
  for (double step = 1.0 / 8; step > 1e-3; step /= 2) {
    for (std::size_t i = 0; i < places.size(); ++i) tries[i] = downhill(x, places[i], step);
    const std::vector<SignedDistance> found = ask_tries(body, x, tries, places);
    for (std::size_t i = 0, k = 0; i < places.size(); ++i)
      for (const Weights& w : tries[i]) keep_deeper(w, found[k++], places[i]);
  }
}

// Distances of the ends of some edges, by vertex; other vertices keep default values.
std::vector<SignedDistance> ask_ends(const DistanceField& body, const Surface& garment, const std::vector<int>& edges,
                                     const Points& x) {
  std::vector<int> ends;
  for (const int e : edges) ends.insert(ends.end(), {garment.edges(e, 0), garment.edges(e, 1)});
  sort_once(ends);
  const std::vector<SignedDistance> found = body.ask(x(ends, Eigen::all));
  std::vector<SignedDistance> of_vertex(static_cast<std::size_t>(x.rows()));
  for (std::size_t k = 0; k < ends.size(); ++k) of_vertex[static_cast<std::size_t>(ends[k])] = found[k];
  return of_vertex;
}

// The deepest points of edges. Edges that are outside along their whole length are left out: a distance changes by no
// more than the point moves.
std::vector<DeepPlace> deepest_of_edges(const DistanceField& body, const Surface& garment,
                                        const std::vector<int>& edges, double margin, const Points& x) {
  const std::vector<SignedDistance> ends = ask_ends(body, garment, edges, x);
  std::vector<DeepPlace> places;
  for (const int e : edges) {
    const int a = garment.edges(e, 0), b = garment.edges(e, 1);
    const double sum = ends[static_cast<std::size_t>(a)].value + ends[static_cast<std::size_t>(b)].value;
    if (sum - (row(x, b) - row(x, a)).norm() >= margin) continue;
    places.emplace_back(std::array{a, b, 0}, 2);
    keep_deeper({1, 0, 0}, ends[static_cast<std::size_t>(a)], places.back());
    keep_deeper({0, 1, 0}, ends[static_cast<std::size_t>(b)], places.back());
  }
  const std::vector<Weights> inner{{0.75, 0.25, 0}, {0.5, 0.5, 0}, {0.25, 0.75, 0}};
  const std::vector<SignedDistance> found = ask_tries(body, x, Tries(places.size(), inner), places);
  for (std::size_t k = 0; k < found.size(); ++k) keep_deeper(inner[k % 3], found[k], places[k / 3]);
  descend(body, x, places);
  return places;
}

std::vector<DeepPlace> deepest_of_faces(const DistanceField& body, const Surface& garment,
                                        const std::vector<int>& triangles, const Points& x) {
  std::vector<DeepPlace> places;
  for (const int t : triangles)
    places.emplace_back(std::array{garment.triangles(t, 0), garment.triangles(t, 1), garment.triangles(t, 2)}, 3);
  const std::vector<Weights> inner{
      {1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.5, 0.25, 0.25}, {0.25, 0.5, 0.25}, {0.25, 0.25, 0.5}};
  const std::vector<SignedDistance> found = ask_tries(body, x, Tries(places.size(), inner), places);
  for (std::size_t k = 0; k < found.size(); ++k) keep_deeper(inner[k % 4], found[k], places[k / 4]);
  descend(body, x, places);
  return places;
}

// A demand that a vertex moves along a normal by at least `length` [m].
struct Demand {
  double length = 0;
  Vec3 normal;
};
using Demands = std::vector<std::vector<Demand>>;  // by vertex

// Adds demands to the corners that move the deepest point to the margin. False if it is there already.
bool add_demand(const DeepPlace& place, double margin, Demands& demands) {
  if (!(place.at.value < margin) || place.at.gradient.isZero(0)) return false;
  const double square = place.weight.squaredNorm();
  for (int k = 0; k < place.corners; ++k)
    if (place.weight[k] > 0)
      demands[static_cast<std::size_t>(place.vertex[k])].push_back(
          {(margin - place.at.value) * place.weight[k] / square, place.at.gradient});
  return true;
}

// About the shortest motion that fulfils all demands: the longest first, then what the others still need.
Vec3 combined(std::vector<Demand> demands) {
  std::ranges::stable_sort(demands, std::greater{}, &Demand::length);
  Vec3 motion = Vec3::Zero();
  for (const Demand& one : demands) motion += std::max(0.0, one.length - one.normal.dot(motion)) * one.normal;
  return motion;
}

void move_once(const DistanceField& body, const Surface& garment, const Touched& touched, double margin, Points& x,
               std::span<const char> held, EdgePassReport& report) {
  Demands demands(static_cast<std::size_t>(x.rows()));
  const std::vector<DeepPlace> edges = deepest_of_edges(body, garment, touched.edges, margin, x);
  const std::vector<DeepPlace> faces = deepest_of_faces(body, garment, touched.triangles, x);
  for (const DeepPlace& place : edges)
    if (place.at.value < 0.5 * margin) report.edges += add_demand(place, margin, demands);
  for (const DeepPlace& place : faces) report.faces += add_demand(place, margin, demands);
  for (int v = 0; v < x.rows(); ++v)
    if (!demands[v].empty() && (held.empty() || !held[v])) x.row(v) += combined(std::move(demands[v])).transpose();
}

}  // namespace

EdgePassReport pass_edges(const DistanceField& body, const Surface& garment, const EdgePassOptions& options, Points& x,
                          std::span<const char> held, EdgePassMemory* kept) {
  EdgePassReport report;
  EdgePassMemory own;
  EdgePassMemory& memory = kept ? *kept : own;
  for (int round = 0; round <= options.rounds; ++round) {
    const bool last = round == options.rounds;
    if (last && !options.count && round > 0) break;
    const Touched touched = touched_by(body, garment, x, memory);
    if (round == 0) report.pairs_before = touched.pairs;
    if (last || touched.pairs == 0) {
      report.pairs_after = touched.pairs;
      break;
    }
    move_once(body, garment, touched, options.margin, x, held, report);
  }
  return report;
}

}  // namespace selvedge
