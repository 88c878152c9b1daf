#include "physics/recovery/balanced_motion.hpp"

#include <algorithm>

#include "collision/geometry/disjoint_sets.hpp"
#include "physics/solve/contact_terms.hpp"

namespace selvedge {
namespace {

constexpr int sweeps = 10;

bool pushes_on_prescribed(const Separation& push, const Eigen::VectorXd& inverse_mass) {
  bool prescribed = false;
  for (int i = 0; i < push.count; ++i) prescribed = prescribed || inverse_mass[push.vertex[i]] == 0;
  return prescribed || is_against_obstacle(push);
}

Points cut_to(double reach, const Eigen::VectorXd& inverse_mass, const Points& wanted) {
  Points move = wanted;
  for (int v = 0; v < wanted.rows(); ++v) {
    const double length = wanted.row(v).norm();
    if (inverse_mass[v] == 0) move.row(v).setZero();
    if (length > reach) move.row(v) *= reach / length;
  }
  return move;
}

DisjointSets moving_together(const Surface& cloth, std::span<const Separation> pushes, const Points& move) {
  DisjointSets sets(cloth.vertex_count);
  for (int e = 0; e < cloth.edges.rows(); ++e) {
    const int a = cloth.edges(e, 0), b = cloth.edges(e, 1);
    if (!move.row(a).isZero(0) && !move.row(b).isZero(0)) sets.join(a, b);
  }
  for (const Separation& push : pushes)
    for (int i = 1; i < push.count; ++i) sets.join(push.vertex[0], push.vertex[i]);
  return sets;
}

void subtract_means(const Eigen::VectorXd& inverse_mass, const std::vector<char>& keeps_mean, DisjointSets& sets,
                    Points& move) {
  std::vector<double> mass(keeps_mean.size(), 0.0);
  std::vector<Vec3> momentum(keeps_mean.size(), Vec3::Zero());
  for (int v = 0; v < move.rows(); ++v) {
    if (move.row(v).isZero(0)) continue;
    mass[sets.root(v)] += 1 / inverse_mass[v];
    momentum[sets.root(v)] += row(move, v) / inverse_mass[v];
  }
  for (int v = 0; v < move.rows(); ++v)
    if (const int set = sets.root(v); !keeps_mean[set] && !move.row(v).isZero(0))
      move.row(v) -= (momentum[set] / mass[set]).transpose();
}

double value_of(const Separation& push, const Points& move) {
  double value = 0;
  for (int i = 0; i < push.count; ++i) value += push.weight[i] * push.direction.dot(row(move, push.vertex[i]));
  return value;
}

void fulfil(std::span<const Separation> pushes, const Eigen::VectorXd& inverse_mass, Points& move) {
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (const Separation& push : pushes) {
      const double value = value_of(push, move), compliance = push_compliance(push, inverse_mass);
      if (value >= push.least || compliance == 0) continue;
      const Vec3 impulse = (push.least - value) / compliance * push.direction;
      for (int i = 0; i < push.count; ++i)
        move.row(push.vertex[i]) += push.weight[i] * inverse_mass[push.vertex[i]] * impulse.transpose();
    }
}

void shorten_sets(double reach, DisjointSets& sets, Points& move) {
  std::vector<double> most(move.rows(), 0.0);
  for (int v = 0; v < move.rows(); ++v) most[sets.root(v)] = std::max(most[sets.root(v)], move.row(v).norm());
  for (int v = 0; v < move.rows(); ++v)
    if (const double length = most[sets.root(v)]; length > reach) move.row(v) *= reach / length;
}

// A push with a small weight on a vertex moves it many times as far as the gap, and its whole set is scaled down for
// that. So each set takes the one of two motions that fulfils its pushes better.
void take_better(std::span<const Separation> pushes, const Points& other, DisjointSets& sets, Points& move) {
  std::vector<double> gain(static_cast<std::size_t>(move.rows()), 0.0);  // of `other` over `move`, by set [m]
  for (const Separation& push : pushes)
    gain[sets.root(push.vertex[0])] +=
        std::min(push.least, value_of(push, other)) - std::min(push.least, value_of(push, move));
  for (int v = 0; v < move.rows(); ++v)
    if (gain[sets.root(v)] > 0) move.row(v) = other.row(v);
}

}  // namespace

Points balanced_motion(const Surface& cloth, const Eigen::VectorXd& inverse_mass, std::span<const Separation> pushes,
                       const Points& wanted, double reach) {
  Points move = cut_to(reach, inverse_mass, wanted);
  DisjointSets sets = moving_together(cloth, pushes, move);
  std::vector<char> keeps_mean(cloth.vertex_count, 0);
  for (const Separation& push : pushes)
    if (pushes_on_prescribed(push, inverse_mass)) keeps_mean[sets.root(push.vertex[0])] = 1;
  subtract_means(inverse_mass, keeps_mean, sets, move);
  Points unpushed = move;
  fulfil(pushes, inverse_mass, move);
  shorten_sets(reach, sets, move);
  shorten_sets(reach, sets, unpushed);
  take_better(pushes, unpushed, sets, move);
  return move;
}

}  // namespace selvedge
