#include "learned/repulsion/smooth_push.hpp"

namespace selvedge {
namespace {

struct SmoothProblem {
  const Adjacency& ring;
  const SmoothPushOptions& options;
  std::span<const char> held;
  std::vector<int> inside;       // penetrating vertices
  std::vector<Vec3> normals;     // one per penetrating vertex, unit length
  std::vector<double> shortage;  // along the normal [m]: gap - n . (x - c)

  bool is_held(int v) const { return !held.empty() && held[v]; }
};

// u_i - mean of the neighbours' u, and the transpose of this map. Vertices without neighbours give 0.
Points unevenness(const Adjacency& ring, const Points& u) {
  Points result = Points::Zero(u.rows(), 3);
  for (int v = 0; v < u.rows(); ++v) {
    const auto neighbours = ring.of(v);
    if (neighbours.empty()) continue;
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (const int next : neighbours) sum += u.row(next);
    result.row(v) = u.row(v) - sum / static_cast<double>(neighbours.size());
  }
  return result;
}
Points unevenness_transposed(const Adjacency& ring, const Points& u) {
  Points result = Points::Zero(u.rows(), 3);
  for (int v = 0; v < u.rows(); ++v) {
    const auto neighbours = ring.of(v);
    if (!neighbours.empty()) result.row(v) += u.row(v);
    for (const int next : neighbours) result.row(v) -= u.row(next) / static_cast<double>(ring.of(next).size());
  }
  return result;
}

void hold(const SmoothProblem& problem, Points& u) {
  if (problem.held.empty()) return;
  for (int v = 0; v < u.rows(); ++v)
    if (problem.held[v]) u.row(v).setZero();
}

// Half of the objective's Hessian times u.
Points times(const SmoothProblem& problem, const Points& u) {
  Points result = problem.options.damping * u +
                  problem.options.smoothness * unevenness_transposed(problem.ring, unevenness(problem.ring, u));
  for (std::size_t i = 0; i < problem.inside.size(); ++i)
    result.row(problem.inside[i]) +=
        u.row(problem.inside[i]).dot(problem.normals[i].transpose()) * problem.normals[i].transpose();
  hold(problem, result);
  return result;
}

double product(const Points& a, const Points& b) { return a.cwiseProduct(b).sum(); }

Points minimise_smoothly(const SmoothProblem& problem, Eigen::Index count, int& iterations) {
  Points u = Points::Zero(count, 3), rest = Points::Zero(count, 3);
  for (std::size_t i = 0; i < problem.inside.size(); ++i)
    if (!problem.is_held(problem.inside[i]))
      rest.row(problem.inside[i]) += problem.shortage[i] * problem.normals[i].transpose();
  Points direction = rest;
  double square = product(rest, rest);
  const double goal = problem.options.tolerance * problem.options.tolerance * square;
  for (int k = 0; k < problem.options.most_iterations && square > goal; ++k, ++iterations) {
    const Points image = times(problem, direction);
    const double step = square / product(direction, image);
    u += step * direction;
    rest -= step * image;
    const double next = product(rest, rest);
    direction = rest + next / square * direction;
    square = next;
  }
  return u;
}

SmoothProblem problem_at(const Points& x, const Adjacency& ring, const std::vector<SignedDistance>& found,
                         const SmoothPushOptions& options, std::span<const char> held) {
  SmoothProblem problem{ring, options, held, {}, {}, {}};
  for (int i = 0; i < x.rows(); ++i) {
    const double length = found[i].gradient.norm();
    if (!(found[i].value < 0) || !(length > 0)) continue;
    problem.inside.push_back(i);
    problem.normals.push_back(found[i].gradient / length);
    problem.shortage.push_back(options.gap - found[i].value);
  }
  return problem;
}

}  // namespace

SmoothlyPushed push_smoothly(const Points& x, const Adjacency& ring, const AskDistance& ask,
                             const SmoothPushOptions& options, std::span<const char> held) {
  SmoothlyPushed result;
  result.x = x;
  std::vector<SignedDistance> found;
  for (int round = 0; round < options.rounds; ++round) {
    ask(result.x, found);
    const SmoothProblem problem = problem_at(result.x, ring, found, options, held);
    if (round == 0) result.penetrating = static_cast<int>(problem.inside.size());
    if (problem.inside.empty()) break;
    result.x += minimise_smoothly(problem, x.rows(), result.iterations);
  }
  return result;
}

}  // namespace selvedge
