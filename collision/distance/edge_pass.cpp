#include "collision/distance/edge_pass.hpp"

#include <algorithm>

namespace selvedge {
namespace {

using Weights = Eigen::Vector3d;

// An edge or a triangle of the garment, and the point of it that lies deepest so far.
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

// What of the garment meets the body.
Touched touched_by(const DistanceField& body, const Surface& garment, const Points& x, EdgePassMemory& memory) {
  Touched touched;
  const auto pairs = intersecting_pairs(garment, x, memory.garment, body.surface(), body.positions(), memory.body);
  touched.pairs = static_cast<int>(pairs.size());
  for (const auto& [t, other] : pairs) {
    touched.triangles.push_back(t);
    for (int k = 0; k < 3; ++k) touched.edges.push_back(garment.triangle_edges(t, k));
  }
  for (std::vector<int>* list : {&touched.edges, &touched.triangles}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  return touched;
}

// Asks of every place a few points round the deepest one, and keeps the deeper of them.
void try_points(const DistanceField& body, const Points& x, const std::vector<std::vector<Weights>>& tries,
                std::vector<DeepPlace>& places, bool first) {
  Eigen::Index count = 0;
  for (const auto& of_place : tries) count += static_cast<Eigen::Index>(of_place.size());
  Points at(count, 3);
  Eigen::Index next = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (const Weights& w : tries[i]) at.row(next++) = places[i].point(x, w).transpose();
  const std::vector<SignedDistance> found = body.ask(at);
  std::size_t k = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < tries[i].size(); ++j, ++k)
      if ((first && j == 0) || found[k].value < places[i].at.value) {
        places[i].at = found[k];
        places[i].weight = tries[i][j];
      }
}

std::vector<Weights> first_tries(int corners) {
  std::vector<Weights> tries;
  if (corners == 2) {
    for (int i = 0; i <= 8; ++i) tries.emplace_back(1 - i / 8.0, i / 8.0, 0);
  } else {
    for (int i = 1; i < 6; ++i)
      for (int j = 1; i + j < 6; ++j) tries.emplace_back(i / 6.0, j / 6.0, (6 - i - j) / 6.0);
  }
  return tries;
}

// Points round the deepest one so far, half as far off each time.
std::vector<Weights> tries_round(const DeepPlace& place, double step) {
  std::vector<Weights> tries;
  for (int from = 0; from < place.corners; ++from)
    for (int to = 0; to < place.corners; ++to) {
      if (from == to) continue;
      const double part = std::min(step, place.weight[from]);
      Weights w = place.weight;
      w[from] -= part;
      w[to] += part;
      tries.push_back(w);
    }
  return tries;
}

void find_deepest(const DistanceField& body, const Points& x, std::vector<DeepPlace>& places) {
  if (places.empty()) return;
  std::vector<std::vector<Weights>> tries;
  for (const DeepPlace& place : places) tries.push_back(first_tries(place.corners));
  try_points(body, x, tries, places, true);
  for (double step = 1.0 / 16; step > 1e-3; step /= 2) {
    for (std::size_t i = 0; i < places.size(); ++i) tries[i] = tries_round(places[i], step);
    try_points(body, x, tries, places, false);
  }
}

// What vertices are asked for.
struct Wishes {
  Points sum;
  std::vector<int> count;
};

// Asks the corners so that the deepest point comes to the margin. False: it is there.
bool wish(const DeepPlace& place, double margin, Wishes& wishes) {
  if (!(place.at.value < margin) || place.at.gradient.isZero(0)) return false;
  const double square = place.weight.squaredNorm();
  for (int k = 0; k < place.corners; ++k) {
    if (place.weight[k] <= 0) continue;
    wishes.sum.row(place.vertex[k]) +=
        ((margin - place.at.value) * place.weight[k] / square * place.at.gradient).transpose();
    ++wishes.count[place.vertex[k]];
  }
  return true;
}

bool has_deep_edge(const Surface& garment, int t, const std::vector<char>& deep) {
  return deep[garment.triangle_edges(t, 0)] || deep[garment.triangle_edges(t, 1)] || deep[garment.triangle_edges(t, 2)];
}

void move_once(const DistanceField& body, const Surface& garment, const Touched& touched, double margin, Points& x,
               std::span<const char> held, EdgePassReport& report) {
  Wishes wishes{Points::Zero(x.rows(), 3), std::vector<int>(static_cast<std::size_t>(x.rows()), 0)};
  std::vector<DeepPlace> places;
  for (const int e : touched.edges) places.emplace_back(std::array{garment.edges(e, 0), garment.edges(e, 1), 0}, 2);
  find_deepest(body, x, places);
  std::vector<char> deep(static_cast<std::size_t>(garment.edges.rows()));
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i].at.value < 0.5 * margin && wish(places[i], margin, wishes))
      deep[touched.edges[i]] = true, ++report.edges;

  places.clear();
  for (const int t : touched.triangles)
    if (!has_deep_edge(garment, t, deep))
      places.emplace_back(std::array{garment.triangles(t, 0), garment.triangles(t, 1), garment.triangles(t, 2)}, 3);
  find_deepest(body, x, places);
  for (const DeepPlace& place : places) report.faces += wish(place, margin, wishes);
  for (int v = 0; v < x.rows(); ++v)
    if (wishes.count[v] > 0 && (held.empty() || !held[v])) x.row(v) += wishes.sum.row(v) / wishes.count[v];
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
