#include <limits>
#include <random>

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "physics/linear/galerkin.hpp"
#include "physics/linear/multigrid.hpp"
#include "tests/physics/linear_example.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_multigrid {

namespace {

// A jittered grid of triangles over a unit square, its inner vertices moved by up to a third of an edge.
struct Sheet {
  Vertices vertices;
  PairPattern pattern;
};

Sheet make_sheet(int side, double jitter) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-jitter, jitter);
  Sheet sheet;
  const int n = side * side;
  sheet.vertices.rest.resize(n, 3);
  for (int i = 0; i < n; ++i) {
    const int u = i % side, v = i / side;
    const bool inner = u > 0 && v > 0 && u + 1 < side && v + 1 < side;
    sheet.vertices.rest.row(i) << (u + (inner ? shift(random) : 0)) / (side - 1),
        (v + (inner ? shift(random) : 0)) / (side - 1), 0;
  }
  const testing::GridElements elements = testing::grid_elements(side);
  sheet.pattern = make_pair_pattern(n, elements.begin, elements.nodes);
  Edges border(4 * (side - 1), 2);
  for (int k = 0; k + 1 < side; ++k) {
    border.row(4 * k) << k, k + 1;
    border.row(4 * k + 1) << n - side + k, n - side + k + 1;
    border.row(4 * k + 2) << k * side, (k + 1) * side;
    border.row(4 * k + 3) << k * side + side - 1, (k + 1) * side + side - 1;
  }
  sheet.vertices.graph = testing::graph_of(sheet.pattern);
  sheet.vertices.rim = rims(sheet.vertices.rest, border);
  return sheet;
}

Eigen::MatrixXd dense(const Prolongation& p) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(p.fine_count(), p.coarse_count());
  for (int i = 0; i < p.fine_count(); ++i)
    for (int k = p.begin[i]; k < p.begin[i + 1]; ++k) matrix(i, p.coarse[k]) += p.weight[k];
  return matrix;
}

using Blocks = std::vector<BlockColumns<float>>;
using PairedBlocks = std::vector<BlockPair<float>>;

PairedBlocks paired(const Blocks& blocks) {
  PairedBlocks pairs((blocks.size() + 1) / 2, BlockPair<float>{});
  for (std::size_t entry = 0; entry < blocks.size(); ++entry)
    for (int k = 0; k < 3; ++k) column_of(pairs.data(), static_cast<int>(entry), k) = blocks[entry].column[k];
  return pairs;
}

Blocks single(const PairedBlocks& pairs) {
  Blocks blocks(2 * pairs.size());
  for (std::size_t entry = 0; entry < blocks.size(); ++entry)
    for (int k = 0; k < 3; ++k) blocks[entry].column[k] = column_of(pairs.data(), static_cast<int>(entry), k);
  return blocks;
}

// y_i = D_i u_i + sum_j B_ij (u_j - u_i) as a matrix.
Eigen::MatrixXd dense(const RowPattern& pattern, const Blocks& blocks, const Blocks& diagonal) {
  const int n = static_cast<int>(diagonal.size());
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (int i = 0; i < n; ++i) {
    whole.block<3, 3>(3 * i, 3 * i) += block_of(diagonal[i]);
    for (int k = pattern.begin[i]; k < pattern.begin[i + 1]; ++k) {
      whole.block<3, 3>(3 * i, 3 * pattern.column[k]) += block_of(blocks[k]);
      whole.block<3, 3>(3 * i, 3 * i) -= block_of(blocks[k]);
    }
  }
  return whole;
}

Eigen::MatrixXd three_times(const Eigen::MatrixXd& p) {
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(3 * p.rows(), 3 * p.cols());
  for (int i = 0; i < p.rows(); ++i)
    for (int a = 0; a < p.cols(); ++a) whole.block<3, 3>(3 * i, 3 * a) = p(i, a) * Mat3::Identity();
  return whole;
}

// Springs along edges in random directions, mass, bending of the graph, contacts across the sheet, a held row.
struct Example : testing::LinearExample {
  Sheet sheet;
};

Example make_example(int side, double stiffness, int contacts) {
  Example e;
  e.sheet = make_sheet(side, 0.3);
  const int n = side * side;
  e.pattern = e.sheet.pattern;
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (const auto& [i, j] : e.pattern.pairs) {
    const Vec3 along = (row(e.sheet.vertices.rest, j) - row(e.sheet.vertices.rest, i)).normalized();
    e.pairs.push_back(-stiffness * (along * along.transpose() + 0.02 * Mat3::Identity()));
  }
  e.flat = 1e-3 * stiffness * testing::squared_laplacian(e.pattern);
  e.flat.makeCompressed();
  e.flat_scale.assign(n, 1.2);
  e.diagonal.assign(n, 1);
  e.free.assign(n, 1);
  for (int i = 0; i < side / 2; ++i) e.free[i] = 0;
  for (int c = 0; c < contacts; ++c) {
    const int first = (c * 29) % (n / 2);
    const Vec3 direction(normal(random), normal(random), normal(random));
    const bool obstacle = c % 3 == 0;
    e.contacts.push_back({{first, first + 1, n - 1 - first, obstacle ? -1 : n - 2 - first},
                          {0.4, 0.6, obstacle ? 0.0 : -0.3, obstacle ? 0.0 : -0.7},
                          direction.normalized(),
                          2 * stiffness,
                          c % 2 ? 0.0 : 0.2 * stiffness});
    if (obstacle) e.contacts.back().nodes[2] = -1;
  }
  e.finish();
  return e;
}

Points apply(Multigrid& multigrid, const Points& r) {
  Quads<float> in(r.rows()), out(r.rows());
  for (int i = 0; i < r.rows(); ++i)
    for (int k = 0; k < 3; ++k) in[i].lanes[k] = static_cast<float>(r(i, k));
  multigrid.apply(in, out);
  Points z(r.rows(), 3);
  for (int i = 0; i < r.rows(); ++i)
    for (int k = 0; k < 3; ++k) z(i, k) = out[i].lanes[k];
  return z;
}

// The V-cycle and the example's matrix on the free unknowns, dense.
struct DenseCycle {
  Eigen::MatrixXd cycle, matrix;

  // Of the cycle times the matrix.
  Eigen::VectorXd eigenvalues() const {
    const Eigen::MatrixXd factor = matrix.llt().matrixL();
    const Eigen::MatrixXd even = 0.5 * (cycle + cycle.transpose());
    return (factor.transpose() * even * factor).selfadjointView<Eigen::Lower>().eigenvalues();
  }
};

DenseCycle dense_cycle(const Example& e, Multigrid& multigrid) {
  const int n = e.pattern.rows;
  std::vector<int> unknowns;
  for (int i = 0; i < 3 * n; ++i)
    if (e.free[i / 3]) unknowns.push_back(i);
  const int m = static_cast<int>(unknowns.size());
  DenseCycle dense{Eigen::MatrixXd(m, m), Eigen::MatrixXd(m, m)};
  for (int column = 0; column < m; ++column) {
    Points unit = Points::Zero(n, 3), product;
    unit(unknowns[column] / 3, unknowns[column] % 3) = 1;
    multiply(e.system(), unit, product);
    const Points z = apply(multigrid, unit);
    for (int k = 0; k < m; ++k) {
      dense.cycle(k, column) = z(unknowns[k] / 3, unknowns[k] % 3);
      dense.matrix(k, column) = product(unknowns[k] / 3, unknowns[k] % 3);
    }
    for (int i = 0; i < n; ++i)
      if (!e.free[i]) CHECK(z.row(i).norm() == 0);
  }
  CHECK((dense.cycle - dense.cycle.transpose()).norm() < 1e-3 * dense.cycle.norm());
  return dense;
}

}  // namespace

TEST_CASE("Coarse vertices: a quarter, no two neighbours; linear functions are kept up to the corners", "[multigrid]") {
  const double jitter = GENERATE(0.0, 0.3);
  const Vertices fine = make_sheet(24, jitter).vertices;
  const std::vector<char> free(fine.graph.vertex_count(), 1);
  const Prolongation p = coarsen(fine, free);
  CHECK(p.coarse_count() > 0.18 * p.fine_count());
  CHECK(p.coarse_count() < 0.34 * p.fine_count());
  std::vector<char> chosen(p.fine_count(), false);
  for (int i : p.chosen) chosen[i] = true;
  for (int i = 0; i < p.fine_count(); ++i)
    for (int k = fine.graph.begin[i]; k < fine.graph.begin[i + 1]; ++k)
      CHECK(!(chosen[i] && chosen[fine.graph.neighbour[k]]));
  const Eigen::MatrixXd weights = dense(p);
  CHECK(weights.minCoeff() >= 0);
  CHECK((weights.rowwise().sum().array() - 1).abs().maxCoeff() < 1e-12);
  const Vertices coarse = coarse_vertices(fine, p);
  // Weights under a thousandth are dropped.
  CHECK((weights * coarse.rest - fine.rest).rowwise().norm().maxCoeff() < (jitter > 0 ? 5e-3 / 23 : 1e-12));
  for (int a = 0; a < coarse.graph.vertex_count(); ++a) CHECK(coarse.graph.begin[a + 1] - coarse.graph.begin[a] >= 2);
}

TEST_CASE("What comes from held vertices is left out, and they are on no coarse level", "[multigrid]") {
  const Vertices fine = make_sheet(12, 0.2).vertices;
  std::vector<char> free(fine.graph.vertex_count(), 1);
  for (int i = 0; i < 12; ++i) free[i] = 0;
  const Prolongation p = coarsen(fine, free);
  for (int i : p.chosen) CHECK(free[i]);
  const Eigen::VectorXd sums = dense(p).rowwise().sum();
  for (int i = 0; i < 12; ++i) CHECK(sums[i] == 0);
  CHECK(sums.maxCoeff() < 1 + 1e-12);
  CHECK(sums.segment(12, 12).minCoeff() < 0.9);
}

TEST_CASE("Galerkin products are P^T A P, of matrices and of contacts", "[multigrid]") {
  const Example e = make_example(9, 50, 40);
  const Prolongation p = coarsen(e.sheet.vertices, e.free);
  const Eigen::MatrixXd weights = three_times(dense(p));
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  const auto some = [&] {
    Mat3 m;
    for (int k = 0; k < 9; ++k) m(k) = normal(random);
    return columns_of<float>(m);
  };
  // Of a symmetric matrix: B_ji is the transpose of B_ij, diagonals and the rows' sums of blocks are symmetric, the
  // blocks are not.
  const auto symmetric = [&] {
    const Mat3 m = block_of(some());
    return columns_of<float>(m + m.transpose());
  };
  RowPattern fine{{0}, {}};
  Blocks blocks, diagonal(e.pattern.rows);
  std::vector<BlockColumns<float>> of_pair(e.pattern.pairs.size());
  std::generate(of_pair.begin(), of_pair.end(), symmetric);
  const auto known = [&](int i, int j) { return std::ranges::binary_search(e.pattern.pairs, std::array{i, j}); };
  const auto add = [&](int i, int j, const Mat3& m) {
    BlockColumns<float>& block = of_pair[find_pair(e.pattern, i, j)];
    block = columns_of<float>(block_of(block) + m);
  };
  int loops = 0;
  for (const auto& [i, j] : e.pattern.pairs)
    for (int k = j + 1; k < e.pattern.rows; ++k) {
      if (!known(i, k) || !known(j, k)) continue;
      const Mat3 m = block_of(some()), skew = m - m.transpose();
      add(i, j, skew);
      add(j, k, skew);
      add(i, k, -skew);
      ++loops;
    }
  REQUIRE(loops > 50);
  for (int i = 0; i < e.pattern.rows; ++i) {
    for (int k = e.pattern.row_begin[i]; k < e.pattern.row_begin[i + 1]; ++k) {
      const Mat3 block = block_of(of_pair[e.pattern.pair[k]]);
      fine.column.push_back(e.pattern.column[k]);
      blocks.push_back(columns_of<float>(e.pattern.column[k] > i ? block : Mat3(block.transpose())));
    }
    fine.end_row(i);
    blocks.resize(fine.column.size(), BlockColumns<float>{});
  }
  std::generate(diagonal.begin(), diagonal.end(), symmetric);
  RowPattern coarse;
  const Product product = make_product(fine, true, p, transpose(p), coarse);
  PairedBlocks coarse_blocks(coarse.column.size() / 2, BlockPair<float>{});
  Blocks coarse_diagonal(p.coarse_count(), BlockColumns<float>{});
  accumulate(product, paired(blocks).data(), diagonal.data(), coarse_blocks.data(), coarse_diagonal.data(), 0,
             p.coarse_count());
  reflect(product, coarse, coarse_blocks.data(), 0, p.coarse_count());
  const Eigen::MatrixXd expected = weights.transpose() * dense(fine, blocks, diagonal) * weights;
  CHECK((dense(coarse, single(coarse_blocks), coarse_diagonal) - expected).norm() < 1e-5 * expected.norm());

  // With some blocks as constants, whose part is in `constant`, the product is the same.
  ConstantEntries constant;
  Blocks other = blocks;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const int row =
        static_cast<int>(std::ranges::upper_bound(fine.begin, static_cast<int>(k)) - fine.begin.begin()) - 1;
    const bool is_constant = fine.column[k] != row && (row + fine.column[k]) % 3 == 0;
    constant.value.push_back(is_constant ? 1 + row + fine.column[k] : std::numeric_limits<double>::quiet_NaN());
    if (is_constant) other[k] = columns_of<float>(constant.value.back() * Mat3::Identity());
  }
  const auto coarse_of_other = [&](const Product& terms) {
    accumulate(terms, paired(other).data(), diagonal.data(), coarse_blocks.data(), coarse_diagonal.data(), 0,
               p.coarse_count());
    reflect(terms, coarse, coarse_blocks.data(), 0, p.coarse_count());
    return dense(coarse, single(coarse_blocks), coarse_diagonal);
  };
  coarse_blocks.assign(coarse_blocks.size(), BlockPair<float>{});
  coarse_diagonal.assign(coarse_diagonal.size(), BlockColumns<float>{});
  const Eigen::MatrixXd of_all = coarse_of_other(product);
  RowPattern pattern;
  const Product of_rest = make_product(fine, true, p, transpose(p), pattern, &constant);
  CHECK(pattern.column == coarse.column);
  CHECK(of_rest.term.size() < product.term.size());
  for (int a = 0; a < p.coarse_count(); ++a) {
    coarse_diagonal[a] = columns_of<float>(constant.diagonal[a] * Mat3::Identity());
    for (int k = coarse.begin[a]; k < coarse.begin[a + 1]; ++k)
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 4; ++r)
          column_of(coarse_blocks.data(), k, c).lanes[r] = r == c ? static_cast<float>(constant.sum[k]) : 0;
  }
  CHECK((coarse_of_other(of_rest) - of_all).norm() < 1e-5 * of_all.norm());

  Eigen::MatrixXd touching = Eigen::MatrixXd::Zero(weights.rows(), weights.rows());
  Blocks factors;
  for (const ContactBlock& contact : e.contacts) {
    factors.push_back(columns_of<float>(contact_matrix(contact)));
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b)
        if (contact.nodes[a] >= 0 && contact.nodes[b] >= 0)
          touching.block<3, 3>(3 * contact.nodes[a], 3 * contact.nodes[b]) +=
              contact.weights[a] * contact.weights[b] * contact_matrix(contact);
  }
  const Product of_contacts = make_product(e.contacts, p, coarse);
  coarse_blocks.assign(coarse.column.size() / 2, BlockPair<float>{});
  coarse_diagonal.assign(p.coarse_count(), BlockColumns<float>{});
  accumulate(of_contacts, paired(factors).data(), nullptr, coarse_blocks.data(), coarse_diagonal.data(), 0,
             p.coarse_count());
  reflect(of_contacts, coarse, coarse_blocks.data(), 0, p.coarse_count());
  const Eigen::MatrixXd expected_touching = weights.transpose() * touching * weights;
  CHECK((dense(coarse, single(coarse_blocks), coarse_diagonal) - expected_touching).norm() <
        1e-5 * expected_touching.norm());
}

TEST_CASE("A V-cycle is symmetric and positive, and no eigenvalue of it times the matrix is far from one",
          "[multigrid]") {
  const Example e = make_example(14, GENERATE(1.0, 1e4), GENERATE(0, 60));
  PcgMatrix<float> fine;
  fine.fill(e.system());
  Multigrid multigrid(e.sheet.vertices, e.free);
  REQUIRE(multigrid.fill(e.system(), e.blocks, fine));
  const Eigen::VectorXd values = dense_cycle(e, multigrid).eigenvalues();
  CHECK(values.minCoeff() > (e.contacts.empty() ? 0.3 : 0.08));
  CHECK(values.maxCoeff() < 1.2);
}

TEST_CASE("A V-cycle with the coarse levels of another matrix is symmetric and positive all the same", "[multigrid]") {
  const Example before = make_example(14, 1e2, 0), e = make_example(14, GENERATE(1.0, 1e4), 0);
  PcgMatrix<float> fine;
  fine.fill(before.system());
  Multigrid multigrid(e.sheet.vertices, e.free);
  REQUIRE(multigrid.fill(before.system(), before.blocks, fine));
  fine.fill(e.system());
  multigrid.fill_finest(e.system(), e.blocks, fine);
  CHECK(dense_cycle(e, multigrid).eigenvalues().minCoeff() > 1e-3);
}

TEST_CASE("Contacts that come and go change the coarse matrices", "[multigrid]") {
  Example with = make_example(14, 1e3, 60), without = make_example(14, 1e3, 0);
  PcgMatrix<float> fine;
  Multigrid kept(with.sheet.vertices, with.free), fresh(with.sheet.vertices, with.free);
  Points r = Points::Random(with.pattern.rows, 3);
  for (const Example* e : {&without, &with, &without, &with}) {
    fine.fill(e->system());
    REQUIRE(kept.fill(e->system(), e->blocks, fine));
    const Points z = apply(kept, r);
    Multigrid anew(e->sheet.vertices, e->free);
    REQUIRE(anew.fill(e->system(), e->blocks, fine));
    CHECK(same_bits(z, apply(anew, r)));
  }
}

}  // namespace selvedge::test_multigrid
