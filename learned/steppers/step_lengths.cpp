#include "learned/steppers/step_lengths.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "collision/contact/path_pairs.hpp"
#include "collision/geometry/distance.hpp"
#include "learned/graph/elastic_motion.hpp"

namespace selvedge {
namespace {

constexpr int smoothing_rounds = 8;  // roll-outs with 3 and with 20 end within 3 % of this (decision 41)

bool moves(const GraphScene& scene, Eigen::Index v) {
  const auto at = static_cast<std::size_t>(v);
  return scene.types[at] != pinned_vertex && scene.mass[at] > 0;
}

// Each row becomes the mean of itself and its neighbours, several times over; rows of vertices that do not move are 0.
Points smoothed(const GraphScene& scene, Points rows) {
  for (int round = 0; round < smoothing_rounds; ++round) {
    Points sum = rows;
    Eigen::VectorXd count = Eigen::VectorXd::Ones(rows.rows());
    for (const auto& edge : scene.cloth.edges.rowwise())
      for (int end = 0; end < 2; ++end) {
        sum.row(edge[end]) += rows.row(edge[1 - end]);
        count[edge[end]] += 1;
      }
    for (Eigen::Index v = 0; v < rows.rows(); ++v)
      if (moves(scene, v))
        rows.row(v) = sum.row(v) / count[v];
      else
        rows.row(v).setZero();
  }
  return rows;
}

// How far the forces of the incremental potential would move each vertex from x: -dt^2 dE/dx / m [m].
Points unbalanced(const GraphState& state, const Points& x, const Points& elastic) {
  Points motion = state.x + state.velocity - x + elastic;
  if (state.acceleration.rows() > 0) motion += state.timestep * state.timestep * state.acceleration;
  return motion;
}

// The potential of one component over two lengths c: -slope . c + c . bend c / 2, in units of m / dt^2.
struct Quadratic {
  std::array<double, 2> slope{};
  std::array<std::array<double, 2>, 2> bend{};
};

// Its least point for lengths from 0 to 1: each in turn for the given other one. The whole output where nothing is
// known of it.
std::array<double, 2> least_lengths(const Quadratic& potential) {
  constexpr int rounds = 50;  // of which ten suffice unless both parts are nearly the same
  std::array<double, 2> length{1, 1};
  const double mixed = 0.5 * (potential.bend[0][1] + potential.bend[1][0]);
  for (int round = 0; round < rounds; ++round)
    for (std::size_t k = 0; k < 2; ++k) {
      const double slope = potential.slope[k] - mixed * length[1 - k], bend = potential.bend[k][k];
      length[k] = bend > 0 ? std::clamp(slope / bend, 0.0, 1.0) : slope < 0 ? 0.0 : 1.0;
    }
  return length;
}

bool is_near_face(const GraphScene& scene, const Points& body, const BodyPair& pair, const Vec3& p, double reach) {
  const int* v = scene.body.triangles.data() + Eigen::Index{3} * pair.face;
  return point_triangle(p, row(body, v[0]), row(body, v[1]), row(body, v[2])).squared_distance < reach * reach;
}

// Marks vertices near the face of their pair, where the frame begins or where they would be at its end. Pairs without a
// face mark nothing.
std::vector<char> near_body(const LengthScene& scene, const GraphState& state, std::span<const BodyPair> pairs,
                            const Points& end) {
  const double reach = contact_reach * scene.thickness;
  std::vector<char> near(static_cast<std::size_t>(scene.graph.cloth.vertex_count), 0);
  for (const BodyPair& pair : pairs)
    if (pair.face >= 0)
      near[static_cast<std::size_t>(pair.cloth)] =
          is_near_face(scene.graph, state.body, pair, row(state.x, pair.cloth), reach) ||
          is_near_face(scene.graph, state.body_target, pair, row(end, pair.cloth), reach);
  return near;
}

// One for each component.
std::vector<Quadratic> quadratics_of(const LengthScene& scene, const GraphState& state,
                                     const std::vector<char>& touching, const Points& guess,
                                     const std::array<Points, 2>& part, AssemblyScratch& scratch) {
  const GraphScene& graph = scene.graph;
  const auto forces = [&](const Points& x) {
    return unbalanced(state, x, elastic_motion(scene.elastic, graph, state.timestep, x, scratch));
  };
  const Points at_guess = state.elastic.rows() > 0 ? unbalanced(state, guess, state.elastic) : forces(guess);
  std::vector<Quadratic> quadratics(static_cast<std::size_t>(graph.cloth.component_count));
  for (std::size_t j = 0; j < 2; ++j) {
    const Points change = at_guess - forces(guess + part[j]);
    for (Eigen::Index v = 0; v < guess.rows(); ++v) {
      const auto at = static_cast<std::size_t>(v);
      if (touching[at] || !moves(graph, v)) continue;
      Quadratic& one = quadratics[static_cast<std::size_t>(graph.cloth.component[at])];
      one.slope[j] += graph.mass[at] * at_guess.row(v).dot(part[j].row(v));
      for (std::size_t i = 0; i < 2; ++i) one.bend[i][j] += graph.mass[at] * change.row(v).dot(part[i].row(v));
    }
  }
  return quadratics;
}

}  // namespace

void take_lengths(const LengthScene& scene, const GraphState& state, std::span<const BodyPair> pairs,
                  AssemblyScratch& scratch, NextCloth& next) {
  const SeenPositions seen = seen_positions(scene.rest, state, scene.features);
  const Points guess = guess_of(scene.rest, state, seen, scene.features), output = next.x - guess;
  std::array<Points, 2> part{smoothed(scene.graph, output), output};
  part[1] -= part[0];
  std::vector<std::array<double, 2>> lengths;
  for (const Quadratic& one : quadratics_of(scene, state, near_body(scene, state, pairs, guess), guess, part, scratch))
    lengths.push_back(least_lengths(one));
  for (Eigen::Index v = 0; v < guess.rows(); ++v) {
    if (!moves(scene.graph, v)) continue;
    const auto& length = lengths[static_cast<std::size_t>(scene.graph.cloth.component[static_cast<std::size_t>(v)])];
    next.x.row(v) = guess.row(v) + length[0] * part[0].row(v) + length[1] * part[1].row(v);
    next.velocity.row(v) = next.x.row(v) - seen.x.row(v);
  }
}

}  // namespace selvedge
