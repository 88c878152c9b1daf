#include "physics/linear/coarsening.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "collision/geometry/factorisations.hpp"
#include "collision/geometry/lists.hpp"

namespace selvedge {
namespace {

constexpr int most_candidates = 12;    // most kept vertices that are tried for a vertex
constexpr double straight = 0.766;     // cosine of the largest turn of a border without a corner
constexpr double least_weight = 1e-3;  // smaller weights are set to zero
constexpr double aside = 1e-9;         // of a triangle's squared sides: smaller areas count as none

// 1 for vertices to keep. Vertices that are not free count as kept, since their values are known to be zero.
std::vector<char> choose(const Vertices& fine, std::span<const char> free) {
  const int n = fine.graph.vertex_count();
  std::vector<char> kept(n, false), covered(n, false);
  const auto keep = [&](int i) {
    kept[i] = true;
    for (const int neighbour : fine.graph.of(i)) covered[neighbour] = true;
  };
  for (int i = 0; i < n; ++i)
    if (!free[i]) keep(i);
  for (const Rim rim : {Rim::corner, Rim::border, Rim::inside})
    for (int i = 0; i < n; ++i)
      if (fine.rim[i] == rim && !kept[i] && !covered[i]) keep(i);
  return kept;
}

struct Candidate {
  int vertex;
  double distance;
  Vec2 place;  // in the tangent plane, the vertex itself at the origin
};

// Kept vertices within two edges, the nearest first.
std::vector<Candidate> candidates(const Vertices& fine, const std::vector<char>& kept, int i) {
  std::vector<int> ring{i};
  for (int step = 0, first = 0; step < 2; ++step) {
    const int last = static_cast<int>(ring.size());
    for (; first < last; ++first)
      for (const int neighbour : fine.graph.of(ring[first])) ring.push_back(neighbour);
  }
  sort_once(ring);
  std::vector<Candidate> found;
  for (int j : ring)
    if (kept[j] && j != i) found.push_back({j, (row(fine.rest, j) - row(fine.rest, i)).norm(), Vec2::Zero()});
  std::ranges::stable_sort(found, {}, &Candidate::distance);
  if (found.size() > most_candidates) found.resize(most_candidates);
  return found;
}

void flatten(const Points& rest, int i, std::vector<Candidate>& around) {
  Mat3 spread = Mat3::Zero();
  for (const Candidate& c : around) {
    const Vec3 offset = row(rest, c.vertex) - row(rest, i);
    spread += offset * offset.transpose();
  }
  const Mat3 axes = symmetric_spectrum3(spread).vectors;
  for (Candidate& c : around) {
    const Vec3 offset = row(rest, c.vertex) - row(rest, i);
    c.place = {axes.col(2).dot(offset), axes.col(1).dot(offset)};
  }
}

struct Weights {
  std::array<int, 3> candidate{0, 0, 0};
  std::array<double, 3> weight{1, 0, 0};
};

// Weights of the origin in the triangle of the nearest candidates round it. False if it is in none.
bool triangle_weights(const std::vector<Candidate>& c, Weights& found) {
  for (int k = 2; k < static_cast<int>(c.size()); ++k)
    for (int j = 1; j < k; ++j)
      for (int i = 0; i < j; ++i) {
        const double whole = cross(c[j].place - c[i].place, c[k].place - c[i].place);
        if (std::abs(whole) < aside * c[k].place.squaredNorm()) continue;
        const std::array weight = {cross(c[j].place, c[k].place) / whole, cross(c[k].place, c[i].place) / whole,
                                   cross(c[i].place, c[j].place) / whole};
        if (*std::min_element(weight.begin(), weight.end()) < -least_weight) continue;
        found = {{i, j, k}, weight};
        return true;
      }
  return false;
}

// Weights of the point nearest to the origin on segments between candidates; on a tie on the shortest segment.
Weights segment_weights(const std::vector<Candidate>& c) {
  Weights best;
  double least = 1.01 * c[0].distance;
  for (int j = 1; j < static_cast<int>(c.size()); ++j)
    for (int i = 0; i < j; ++i) {
      const Vec2 along = c[j].place - c[i].place;
      const double t = -c[i].place.dot(along) / along.squaredNorm();
      if (!(t > 0 && t < 1)) continue;
      const double cost = (c[i].place + t * along).norm() + 0.01 * along.norm();
      if (cost >= least) continue;
      least = cost;
      best = {{i, j, 0}, {1 - t, t, 0}};
    }
  return best;
}

Weights interpolate(const Vertices& fine, int i, std::vector<Candidate>& around) {
  flatten(fine.rest, i, around);
  if (fine.rim[i] != Rim::inside) {  // a border vertex is interpolated along the border if possible
    std::vector<Candidate> border;
    for (const Candidate& c : around)
      if (fine.rim[c.vertex] != Rim::inside) border.push_back(c);
    if (border.size() >= 2) {
      around = border;
      return segment_weights(around);
    }
  }
  Weights weights;
  return triangle_weights(around, weights) ? weights : segment_weights(around);
}

}  // namespace

std::vector<Rim> rims(const Points& rest, const Edges& border) {
  std::vector<Rim> rim(rest.rows(), Rim::inside);
  const Adjacency graph = adjacency_of(static_cast<int>(rest.rows()), border);
  for (int i = 0; i < graph.vertex_count(); ++i) {
    const std::span<const int> ends = graph.of(i);
    if (ends.empty()) continue;
    rim[i] = Rim::corner;
    if (ends.size() != 2) continue;
    const Vec3 in = row(rest, i) - row(rest, ends[0]);
    const Vec3 out = row(rest, ends[1]) - row(rest, i);
    if (in.dot(out) > straight * in.norm() * out.norm()) rim[i] = Rim::border;
  }
  return rim;
}

Prolongation coarsen(const Vertices& fine, std::span<const char> free) {
  const std::vector<char> kept = choose(fine, free);
  const int n = fine.graph.vertex_count();
  std::vector<int> index(n, -1);
  Prolongation result;
  for (int i = 0; i < n; ++i)
    if (kept[i] && free[i]) {
      index[i] = result.coarse_count();
      result.chosen.push_back(i);
    }
  result.begin.push_back(0);
  for (int i = 0; i < n; ++i) {
    const auto add = [&](int vertex, double weight) {
      if (index[vertex] < 0 || weight < least_weight) return;
      result.coarse.push_back(index[vertex]);
      result.weight.push_back(weight);
    };
    if (kept[i]) {
      add(i, 1);
    } else if (free[i]) {
      std::vector<Candidate> around = candidates(fine, kept, i);
      const Weights found = interpolate(fine, i, around);
      double sum = 0;
      for (double weight : found.weight) sum += weight < least_weight ? 0 : weight;
      for (int k = 0; k < 3; ++k) add(around[found.candidate[k]].vertex, found.weight[k] / sum);
    }
    result.begin.push_back(static_cast<int>(result.coarse.size()));
  }
  return result;
}

Vertices coarse_vertices(const Vertices& fine, const Prolongation& p) {
  Vertices coarse;
  coarse.rest.resize(p.coarse_count(), 3);
  for (int a = 0; a < p.coarse_count(); ++a) {
    coarse.rest.row(a) = fine.rest.row(p.chosen[a]);
    coarse.rim.push_back(fine.rim[p.chosen[a]]);
  }
  std::vector<std::pair<int, int>> pairs;
  const auto join = [&](int i, int j) {
    for (int k = p.begin[i]; k < p.begin[i + 1]; ++k)
      for (int l = p.begin[j]; l < p.begin[j + 1]; ++l)
        if (p.coarse[k] < p.coarse[l]) pairs.emplace_back(p.coarse[k], p.coarse[l]);  // its reverse is visited too
  };
  for (int i = 0; i < fine.graph.vertex_count(); ++i) {
    join(i, i);
    for (const int neighbour : fine.graph.of(i)) join(i, neighbour);
  }
  coarse.graph = adjacency_of(p.coarse_count(), unique_edges(std::move(pairs)));
  return coarse;
}

}  // namespace selvedge
