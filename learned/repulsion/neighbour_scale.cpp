#include "learned/repulsion/neighbour_scale.hpp"

#include <algorithm>
#include <cassert>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

constexpr int own_columns = 3;

FeatureRows own_features(const NeighbourShape& shape, const NeighbourPatch& patch) {
  FeatureRows own(std::ssize(patch.vertex), own_columns);
  for (Eigen::Index i = 0; i < own.rows(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    own(i, 0) = static_cast<float>(patch.distance[k] / shape.unit);
    own(i, 1) = static_cast<float>(patch.smallest[k].value / shape.unit);
    own(i, 2) = static_cast<float>(patch.length[k] / shape.edge_unit);
  }
  return own;
}

// The first `count` rows, each beside the mean of its neighbours' rows.
FeatureRows with_neighbours(const FeatureRows& rows, const NeighbourPatch& patch, int count) {
  FeatureRows both = FeatureRows::Zero(count, 2 * rows.cols());
  for (int i = 0; i < count; ++i) {
    const std::vector<int>& neighbours = patch.neighbour[static_cast<std::size_t>(i)];
    both.row(i).head(rows.cols()) = rows.row(i);
    for (const int next : neighbours) both.row(i).tail(rows.cols()) += rows.row(next);
    if (!neighbours.empty()) both.row(i).tail(rows.cols()) /= static_cast<float>(neighbours.size());
  }
  return both;
}

// The transpose: from the derivative by the result to that by all `rows` rows.
FeatureRows back_to_neighbours(const FeatureRows& by_both, const NeighbourPatch& patch, Eigen::Index rows) {
  const Eigen::Index columns = by_both.cols() / 2;
  FeatureRows by = FeatureRows::Zero(rows, columns);
  for (Eigen::Index i = 0; i < by_both.rows(); ++i) {
    const std::vector<int>& neighbours = patch.neighbour[static_cast<std::size_t>(i)];
    by.row(i) += by_both.row(i).head(columns);
    for (const int next : neighbours)
      by.row(next) += by_both.row(i).tail(columns) / static_cast<float>(neighbours.size());
  }
  return by;
}

FeatureRows bent_rows(const FeatureRows& sums) { return sums.cwiseMax(0.0f); }
FeatureRows through_bend(const FeatureRows& by, const FeatureRows& sums) {
  return (sums.array() > 0).select(by, FeatureRows::Zero(by.rows(), by.cols()));
}

// Intermediate results of one evaluation.
struct NeighbourTrace {
  FeatureRows first_in, first_sum, second_in, second_sum, end_in, end_sum;
};

NeighbourTrace trace_scales(const NeighbourScale& network, const NeighbourPatch& patch) {
  NeighbourTrace made;
  made.first_in = with_neighbours(own_features(network.shape, patch), patch, patch.near);
  made.first_sum = evaluate(network.first, made.first_in);
  made.second_in = with_neighbours(bent_rows(made.first_sum), patch, patch.pushed);
  made.second_sum = evaluate(network.second, made.second_in);
  made.end_in.resize(patch.pushed, network.shape.width + 1);
  made.end_in.leftCols(network.shape.width) = bent_rows(made.second_sum);
  for (int i = 0; i < patch.pushed; ++i)
    made.end_in(i, network.shape.width) =
        static_cast<float>(patch.distance[static_cast<std::size_t>(i)] / network.shape.unit);
  made.end_sum = evaluate(network.end, made.end_in);
  return made;
}

// Lists the patch's vertices in order. `place` is the place of each vertex of the garment; -1: not in the patch.
void gather_vertices(const Adjacency& ring, std::span<const int> pushed, NeighbourPatch& patch,
                     std::vector<int>& place) {
  const auto add = [&](int v) {
    if (place[static_cast<std::size_t>(v)] >= 0) return;
    place[static_cast<std::size_t>(v)] = static_cast<int>(patch.vertex.size());
    patch.vertex.push_back(v);
  };
  const auto add_rings = [&](int count) {
    for (int i = 0; i < count; ++i)
      for (const int next : ring.of(patch.vertex[static_cast<std::size_t>(i)])) add(next);
  };
  for (const int v : pushed) add(v);
  patch.pushed = static_cast<int>(patch.vertex.size());
  add_rings(patch.pushed);
  patch.near = static_cast<int>(patch.vertex.size());
  add_rings(patch.near);
  for (int i = 0; i < patch.near; ++i) {
    std::vector<int>& own = patch.neighbour.emplace_back();
    for (const int next : ring.of(patch.vertex[static_cast<std::size_t>(i)]))
      own.push_back(place[static_cast<std::size_t>(next)]);
  }
}

// The midpoints of all edges at the patch's vertices, each once. `number` has the midpoint of each edge of each vertex.
std::vector<Vec3> edge_middles(const Points& x, const Adjacency& ring, const NeighbourPatch& patch,
                               const std::vector<int>& place, std::vector<std::vector<int>>& number) {
  std::vector<Vec3> middles;
  for (std::size_t i = 0; i < patch.vertex.size(); ++i) {
    const int v = patch.vertex[i];
    std::vector<int>& own = number.emplace_back();
    for (const int next : ring.of(v)) {
      const int other = place[static_cast<std::size_t>(next)];
      if (other >= 0 && other < static_cast<int>(i)) {
        const auto back = ring.of(next);
        own.push_back(number[static_cast<std::size_t>(other)]
                            [static_cast<std::size_t>(std::ranges::lower_bound(back, v) - back.begin())]);
      } else {
        own.push_back(static_cast<int>(middles.size()));
        middles.push_back(0.5 * (row(x, v) + row(x, next)));
      }
    }
  }
  return middles;
}

}  // namespace

NeighbourScale make_neighbour_scale(const NeighbourShape& shape, std::uint64_t seed) {
  if (!(shape.unit > 0) || !(shape.edge_unit > 0) || shape.width < 1)
    throw Error("no network has these sizes", "scales by neighbours", "give width and units above 0");
  NeighbourScale made;
  made.shape = shape;
  made.first = make_plain_network({2 * own_columns, {shape.width, shape.width}}, seed);
  made.second = make_plain_network({2 * shape.width, {shape.width, shape.width}}, seed + 1);
  made.end = make_scale_end(shape.width + 1, shape.range, seed + 2);
  return made;
}

NeighbourPatch neighbour_patch(const Points& x, const Adjacency& ring, const AskDistance& ask,
                               std::span<const int> pushed) {
  NeighbourPatch patch;
  std::vector<int> place(static_cast<std::size_t>(x.rows()), -1);
  gather_vertices(ring, pushed, patch, place);
  std::vector<std::vector<int>> number;
  const std::vector<Vec3> middles = edge_middles(x, ring, patch, place, number);
  const auto count = std::ssize(patch.vertex);
  Points at(count + std::ssize(middles), 3);
  at.topRows(count) = x(patch.vertex, Eigen::all);
  for (std::size_t k = 0; k < middles.size(); ++k)
    at.row(count + static_cast<Eigen::Index>(k)) = middles[k].transpose();
  std::vector<SignedDistance> found;
  ask(at, found);
  for (std::size_t i = 0; i < patch.vertex.size(); ++i) {
    const int v = patch.vertex[i];
    SmallestDistance smallest{-1, found[i].value, found[i].gradient};
    double length = 0;
    const auto neighbours = ring.of(v);
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
      const SignedDistance& middle = found[static_cast<std::size_t>(count + number[i][k])];
      if (middle.value < smallest.value) smallest = {neighbours[k], middle.value, middle.gradient};
      length += (row(x, v) - row(x, neighbours[k])).norm() / static_cast<double>(neighbours.size());
    }
    patch.distance.push_back(found[i].value);
    patch.gradient.push_back(found[i].gradient);
    patch.smallest.push_back(smallest);
    patch.length.push_back(length);
  }
  return patch;
}

Scales neighbour_scales(const NeighbourScale& network, const NeighbourPatch& patch) {
  const FeatureRows sums = trace_scales(network, patch).end_sum;
  Scales scales;
  for (int i = 0; i < patch.pushed; ++i)
    scales.alpha.push_back(scale_end(network.shape.range, static_cast<double>(sums(i, 0))));
  scales.slope.assign(scales.alpha.size(), 0);
  return scales;
}

AskScale ask_neighbours(const NeighbourScale& network, const Points& x, const Adjacency& ring, const AskDistance& ask) {
  return [&network, &x, &ring, ask](std::span<const int> vertices, std::span<const double>) {
    return neighbour_scales(network, neighbour_patch(x, ring, ask, vertices));
  };
}

NeighbourGradients neighbour_gradients(const NeighbourScale& network, const NeighbourPatch& patch, const Points& x,
                                       const Adjacency& ring, std::span<const double> by_alpha) {
  assert(static_cast<int>(by_alpha.size()) == patch.pushed);
  const NeighbourTrace made = trace_scales(network, patch);
  PlainGradients end = backward(network.end, made.end_in, {}, scale_adjoints(made.end_sum, by_alpha));
  const FeatureRows by_q = through_bend(end.inputs.leftCols(network.shape.width), made.second_sum);
  PlainGradients second = backward(network.second, made.second_in, {}, {by_q, {}});
  const FeatureRows by_p = through_bend(back_to_neighbours(second.inputs, patch, patch.near), made.first_sum);
  PlainGradients first = backward(network.first, made.first_in, {}, {by_p, {}});
  FeatureRows by_own = back_to_neighbours(first.inputs, patch, std::ssize(patch.vertex));
  by_own.col(0).head(patch.pushed) += end.inputs.col(network.shape.width);

  NeighbourGradients result{std::move(first.parameters), std::move(second.parameters), std::move(end.parameters),
                            Points::Zero(x.rows(), 3)};
  for (std::size_t i = 0; i < patch.vertex.size(); ++i) {
    const int v = patch.vertex[i];
    const Vec3 by = by_own.row(static_cast<Eigen::Index>(i)).transpose().cast<double>();
    const SmallestDistance& smallest = patch.smallest[i];
    result.by_x.row(v) += by[0] / network.shape.unit * patch.gradient[i].transpose();
    const Vec3 at_smallest = by[1] / network.shape.unit * smallest.gradient;
    result.by_x.row(v) += (smallest.other < 0 ? 1.0 : 0.5) * at_smallest.transpose();
    if (smallest.other >= 0) result.by_x.row(smallest.other) += 0.5 * at_smallest.transpose();
    const auto neighbours = ring.of(v);
    for (const int next : neighbours) {
      const Vec3 along = (row(x, v) - row(x, next)).normalized();
      const Vec3 part = by[2] / network.shape.edge_unit / static_cast<double>(neighbours.size()) * along;
      result.by_x.row(v) += part.transpose();
      result.by_x.row(next) -= part.transpose();
    }
  }
  return result;
}

}  // namespace selvedge
