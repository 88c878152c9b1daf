#include "physics/linear/multigrid.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "collision/geometry/parallel.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "physics/linear/galerkin.hpp"

namespace selvedge {
namespace {

constexpr int level_chunk = 64;     // rows of one task
constexpr int one_thread = 128;     // levels with fewer rows are faster on one thread
constexpr int coarsest = 48;        // levels with at most so many vertices are solved by Cholesky
constexpr int smoothing_steps = 2;  // before and after the coarse correction
// Bound of the eigenvalues of the inverse diagonal blocks times the matrix. Triangles give at most 3, contacts 4, flat
// bending 3.3 on regular meshes; the polynomial is harmless up to 5. Estimating it by the power method took longer than
// it saved.
constexpr float longest = 4;
constexpr int most_levels = 12;
constexpr double least_coarsening = 0.7;  // of the vertices; a level that keeps more is not used

// Calls f(begin, end) for the chunks of `rows`: shared by the calling team, or on one thread alone.
template <class F>
void for_chunks(bool team, int rows, const F& f) {
  if (team) {
#pragma omp for schedule(static)
    for (int c = 0; c < chunks_of(rows, level_chunk); ++c) f(c * level_chunk, std::min(rows, (c + 1) * level_chunk));
  } else {
    f(0, rows);
  }
}

// Calls f(row) for all rows, on a team of its own if there are many. Scheduling is dynamic, since rows differ in cost.
template <class F>
void for_rows(int rows, const F& f) {
#pragma omp parallel for schedule(dynamic, 8) if (rows > 32)
  for (int row = 0; row < rows; ++row) f(row);
}

using Blocks = std::vector<BlockColumns<float>>;
using PairedBlocks = std::vector<BlockPair<float>>;

Mat3 block_at(const PairedBlocks& blocks, int entry) {
  return block_of(BlockColumns<float>{column_of(blocks.data(), entry, 0), column_of(blocks.data(), entry, 1),
                                      column_of(blocks.data(), entry, 2)});
}

// A level of the hierarchy. The finest has no matrix of its own.
struct Level {
  int rows = 0;
  // To the next coarser level, if there is one.
  Prolongation prolongation;
  Restriction restriction;
  std::vector<float> prolongation_weight, restriction_weight;
  // The matrix, a product of the finer level's. `touching`: the same for contacts.
  RowPattern pattern, touching;
  Product product, touching_product;
  PairedBlocks block, touching_block;
  Blocks diagonal;
  // Data of the smoother.
  Blocks inverse;
  Quads<float> step, product_of_step, residual;
  Quads<float> right, x;  // of the level's system; empty on the finest, whose caller has them

  LevelView view() const {
    return {diagonal.data(),
            {pattern.begin.data(), touching.begin.data()},
            {pattern.column.data(), touching.column.data()},
            {block.data(), touching_block.data()}};
  }
  WeightView up() const { return {prolongation.begin.data(), prolongation.coarse.data(), prolongation_weight.data()}; }
  WeightView down() const { return {restriction.begin.data(), restriction.fine.data(), restriction_weight.data()}; }
};

void take_away(const PairedBlocks& blocks, const RowPattern& pattern, int row, BlockColumns<float>& sum) {
  for (int entry = pattern.begin[row]; entry < pattern.begin[row + 1]; ++entry)
    for (int k = 0; k < 3; ++k) sum.column[k].lanes -= column_of(blocks.data(), entry, k).lanes;
}

void clear(PairedBlocks& blocks, const RowPattern& pattern, int row) {
  std::fill(blocks.begin() + pattern.begin[row] / 2, blocks.begin() + pattern.begin[row + 1] / 2, BlockPair<float>{});
}

void reflect(Level& level) {
  for_rows(level.rows, [&](int a) {
    reflect(level.product, level.pattern, level.block.data(), a, a + 1);
    reflect(level.touching_product, level.touching, level.touching_block.data(), a, a + 1);
  });
}

bool same(std::span<const ContactBlock> contacts, const std::vector<ContactBlock>& known) {
  return std::equal(
      contacts.begin(), contacts.end(), known.begin(), known.end(),
      [](const ContactBlock& a, const ContactBlock& b) { return a.nodes == b.nodes && a.weights == b.weights; });
}

}  // namespace

struct Multigrid::Impl {
  std::vector<Level> levels;
  PcgMatrix<float>* fine = nullptr;
  bool patterns = false;                 // patterns of the coarse matrices are made
  std::vector<float> far, far_diagonal;  // of the second level: product of the flat entries outside of blocks
  std::vector<ContactBlock> contacts;    // for which the patterns were made
  PairedBlocks contact_factor;
  Blocks fine_diagonal;
  Eigen::LLT<Eigen::MatrixXd> cholesky;
  Eigen::VectorXd coarse_right;
  bool direct = false;  // the coarsest level is solved by Cholesky
  std::vector<double> partial;

  void make_patterns(const LinearSystem&);
  void make_contact_patterns(std::span<const ContactBlock>);
  void fill_second(const LinearSystem&, Level&);
  void fill_coarser(const Level& finer, Level&);
  bool invert_diagonal(Level&);
  bool factor_coarsest();
  void solve_coarsest();
  void multiply(int l, bool team, const Quads<float>& u, Quads<float>& y);
  void smooth(int l, bool team, Quads<float>& x, bool further);
  void cycle(int l, bool team, const Quads<float>& right, Quads<float>& x);
};

Multigrid::Multigrid(const Vertices& vertices, std::span<const char> free) : impl_(std::make_unique<Impl>()) {
  Vertices here = vertices;
  std::vector<char> here_free(free.begin(), free.end());
  for (;;) {
    check_stop();
    Level& level = impl_->levels.emplace_back();
    level.rows = here.graph.vertex_count();
    if (level.rows <= coarsest || impl_->levels.size() == most_levels) break;
    Prolongation prolongation = coarsen(here, here_free);
    if (prolongation.coarse_count() == 0 || prolongation.coarse_count() > least_coarsening * level.rows) break;
    level.restriction = transpose(prolongation);
    level.prolongation_weight.assign(prolongation.weight.begin(), prolongation.weight.end());
    level.restriction_weight.assign(level.restriction.weight.begin(), level.restriction.weight.end());
    here = coarse_vertices(here, prolongation);
    here_free.assign(here.graph.vertex_count(), true);
    level.prolongation = std::move(prolongation);
  }
  for (Level& level : impl_->levels) {
    const bool finest = &level == &impl_->levels.front();
    for (Quads<float>* vector : {&level.right, &level.x}) vector->assign(finest ? 0 : level.rows, Quad<float>{});
    for (Quads<float>* vector : {&level.step, &level.product_of_step, &level.residual})
      vector->assign(level.rows, Quad<float>{});
  }
}
Multigrid::~Multigrid() = default;

// The first product takes blocks and flat entries outside of blocks together; the latter are constants.
void Multigrid::Impl::make_patterns(const LinearSystem& system) {
  patterns = true;
  if (levels.size() < 2) return;
  const RowPattern &near = fine->pattern(), &beyond = fine->far();
  const std::size_t count = near.column.size() + beyond.column.size();
  RowPattern joint{{0}, {}};
  ConstantEntries constant;
  std::vector<int> entry;  // of `near`; -1 for those of `beyond`
  joint.begin.reserve(near.begin.size());
  joint.column.reserve(count);
  constant.value.reserve(count);
  entry.reserve(count);
  const auto add = [&](int column, int near_entry, double value) {
    joint.column.push_back(column);
    entry.push_back(near_entry);
    constant.value.push_back(value);
  };
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < near.rows(); ++i) {
    for (int k = near.begin[i]; k < near.begin[i + 1]; ++k) add(near.column[k], k, none);
    for (int k = beyond.begin[i]; k < beyond.begin[i + 1]; ++k) {
      const int place = fine->far_place()[k];  // -1: an entry that makes the row's number even, and has no terms
      add(beyond.column[k], -1, place < 0 ? none : system.flat.valuePtr()[place]);
    }
    joint.end_row(i);
  }
  Level& second = levels[1];
  second.product = make_product(joint, true, levels[0].prolongation, levels[0].restriction, second.pattern, &constant);
  for (ProductTerm& term : second.product.term)
    if (term.source >= 0) term.source = entry[term.source];
  if (!beyond.column.empty()) {
    far.assign(constant.sum.begin(), constant.sum.end());
    far_diagonal.assign(constant.diagonal.begin(), constant.diagonal.end());
  }
  for (std::size_t l = 2; l < levels.size(); ++l)
    levels[l].product = make_product(levels[l - 1].pattern, true, levels[l - 1].prolongation, levels[l - 1].restriction,
                                     levels[l].pattern);
  for (std::size_t l = 1; l < levels.size(); ++l) {
    levels[l].block.assign(levels[l].pattern.column.size() / 2, {});
    levels[l].diagonal.resize(levels[l].rows);
  }
}

void Multigrid::Impl::make_contact_patterns(std::span<const ContactBlock> wanted) {
  contacts.assign(wanted.begin(), wanted.end());
  for (std::size_t l = 1; l < levels.size(); ++l) {
    const Level& finer = levels[l - 1];
    Level& level = levels[l];
    level.touching_product =
        l == 1 ? make_product(wanted, finer.prolongation, level.touching)
               : make_product(finer.touching, false, finer.prolongation, finer.restriction, level.touching);
    level.touching_block.assign(level.touching.column.size() / 2, {});
  }
}

void Multigrid::Impl::fill_second(const LinearSystem& system, Level& level) {
  const int touching = static_cast<int>(contacts.size());
  contact_factor.resize((touching + 1) / 2);
  fine_diagonal.resize(fine->rows());
#pragma omp parallel if (chunks_of(levels[0].rows, level_chunk) > 2)
  {
#pragma omp for schedule(static) nowait
    for (int p = 0; p < static_cast<int>(contact_factor.size()); ++p)
      for (int c = 2 * p; c < std::min(touching, 2 * p + 2); ++c)
        for (int k = 0; k < 3; ++k)
          column_of(contact_factor.data(), c, k) = columns_of<float>(contact_matrix(fine->contacts()[c])).column[k];
#pragma omp for schedule(static)
    for (int i = 0; i < fine->rows(); ++i) fine_diagonal[i] = fine->diagonal(i);
  }
  for_rows(level.rows, [&](int a) {
    const float scale = far.empty() ? 0.f : static_cast<float>(system.flat_scale[levels[0].prolongation.chosen[a]]);
    level.diagonal[a] = BlockColumns<float>{};
    clear(level.block, level.pattern, a);
    clear(level.touching_block, level.touching, a);
    for (int k = 0; k < 3 && !far.empty(); ++k) {
      level.diagonal[a].column[k].lanes[k] = scale * far_diagonal[a];
      for (int e = level.pattern.begin[a]; e < level.pattern.begin[a + 1]; ++e)
        column_of(level.block.data(), e, k).lanes[k] = scale * far[e];
    }
    accumulate(level.product, fine->blocks(), fine_diagonal.data(), level.block.data(), level.diagonal.data(), a,
               a + 1);
    accumulate(level.touching_product, contact_factor.data(), nullptr, level.touching_block.data(),
               level.diagonal.data(), a, a + 1);
  });
  reflect(level);
}

void Multigrid::Impl::fill_coarser(const Level& finer, Level& level) {
  for_rows(level.rows, [&](int a) {
    level.diagonal[a] = BlockColumns<float>{};
    clear(level.block, level.pattern, a);
    clear(level.touching_block, level.touching, a);
    accumulate(level.product, finer.block.data(), finer.diagonal.data(), level.block.data(), level.diagonal.data(), a,
               a + 1);
    accumulate(level.touching_product, finer.touching_block.data(), nullptr, level.touching_block.data(),
               level.diagonal.data(), a, a + 1);
  });
  reflect(level);
}

// False if a block is not positive definite.
bool Multigrid::Impl::invert_diagonal(Level& level) {
  level.inverse.resize(level.rows);
  std::vector<char> positive(level.rows);
  for_rows(level.rows, [&](int a) {
    BlockColumns<float> sum = level.diagonal[a];
    take_away(level.block, level.pattern, a, sum);
    take_away(level.touching_block, level.touching, a, sum);
    const Mat3 whole = block_of(sum);
    const Mat3 inverse = (0.5 * (whole + whole.transpose())).inverse();
    positive[a] = inverse.allFinite() && inverse.trace() > 0;
    level.inverse[a] = columns_of<float>(inverse);
  });
  return std::ranges::all_of(positive, [](char yes) { return yes != 0; });
}

bool Multigrid::Impl::factor_coarsest() {
  const Level& level = levels.back();
  direct = level.rows <= 4 * coarsest;
  if (!direct) return true;
  const int n = level.rows;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  const auto add = [&](int a, const RowPattern& pattern, const PairedBlocks& block) {
    for (int k = pattern.begin[a]; k < pattern.begin[a + 1]; ++k) {
      const Mat3 entry = block_at(block, k);
      whole.block<3, 3>(3 * a, 3 * pattern.column[k]) += entry;
      whole.block<3, 3>(3 * a, 3 * a) -= entry;
    }
  };
  for (int a = 0; a < n; ++a) {
    whole.block<3, 3>(3 * a, 3 * a) += block_of(level.diagonal[a]);
    add(a, level.pattern, level.block);
    add(a, level.touching, level.touching_block);
  }
  cholesky.compute(0.5 * (whole + whole.transpose()));
  coarse_right.resize(3 * n);
  return cholesky.info() == Eigen::Success;
}

void Multigrid::Impl::solve_coarsest() {
  Level& level = levels.back();
  for (int a = 0; a < level.rows; ++a)
    for (int k = 0; k < 3; ++k) coarse_right[3 * a + k] = level.right[a].lanes[k];
  cholesky.solveInPlace(coarse_right);
  for (int a = 0; a < level.rows; ++a)
    for (int k = 0; k < 3; ++k) level.x[a].lanes[k] = static_cast<float>(coarse_right[3 * a + k]);
}

void Multigrid::Impl::multiply(int l, bool team, const Quads<float>& u, Quads<float>& y) {
  if (l == 0) {
    fine->multiply(u, y, partial);
    return;
  }
  const LevelView view = levels[l].view();
  for_chunks(team, levels[l].rows, [&](int begin, int end) { multiply_level(view, u.data(), y.data(), begin, end); });
}

void Multigrid::fill_finest(const LinearSystem& system, std::span<const Mat3> diagonal, PcgMatrix<float>& fine) {
  Impl& impl = *impl_;
  impl.fine = &fine;
  impl.partial.resize(fine.chunks());
  Level& finest = impl.levels[0];
  finest.inverse.resize(finest.rows);
#pragma omp parallel for schedule(static) if (chunks_of(finest.rows, level_chunk) > 2)
  for (int i = 0; i < finest.rows; ++i)
    finest.inverse[i] = columns_of<float>(system.free[i] ? Mat3(diagonal[i].inverse()) : Mat3(Mat3::Zero()));
}

bool Multigrid::fill(const LinearSystem& system, std::span<const Mat3> diagonal, PcgMatrix<float>& fine) {
  Impl& impl = *impl_;
  if (impl.levels.size() < 2) return false;
  check_stop();
  impl.fine = &fine;
  const bool first = !impl.patterns;
  if (first) impl.make_patterns(system);
  if (first || !same(fine.contacts(), impl.contacts)) impl.make_contact_patterns(fine.contacts());
  fill_finest(system, diagonal, fine);
  for (std::size_t l = 1; l < impl.levels.size(); ++l) {
    if (l == 1)
      impl.fill_second(system, impl.levels[1]);
    else
      impl.fill_coarser(impl.levels[l - 1], impl.levels[l]);
    if (!impl.invert_diagonal(impl.levels[l])) return false;
  }
  return impl.factor_coarsest();
}

// Steps of the iteration. The residual is `residual` minus `product_of_step`, which is still to be subtracted. Adds the
// steps to x. `further`: also computes the product of the last step.
void Multigrid::Impl::smooth(int l, bool team, Quads<float>& x, bool further) {
  Level& level = levels[l];
  for (int k = 1; k <= smoothing_steps; ++k) {
    const float keep = static_cast<float>(2 * k - 3) / static_cast<float>(2 * k + 1);
    const float factor = static_cast<float>(8 * k - 4) / (static_cast<float>(2 * k + 1) * longest);
    for_chunks(team, level.rows, [&](int begin, int end) {
      chebyshev(k == 1 ? 0.f : keep, factor, level.inverse.data(), level.product_of_step.data(), level.residual.data(),
                level.step.data(), x.data(), begin, end);
    });
    if (k < smoothing_steps || further) multiply(l, team, level.step, level.product_of_step);
  }
}

void Multigrid::Impl::cycle(int l, bool team, const Quads<float>& right, Quads<float>& x) {
  Level& level = levels[l];
  const bool last = l + 1 == static_cast<int>(levels.size());
  if (last && direct) {
    solve_coarsest();
    return;
  }
  for_chunks(team, level.rows, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      level.residual[i] = right[i];
      level.product_of_step[i] = level.step[i] = x[i] = Quad<float>{};
    }
  });
  smooth(l, team, x, true);
  if (!last) {
    Level& coarser = levels[l + 1];
    for_chunks(team, level.rows, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) level.residual[i].lanes -= level.product_of_step[i].lanes;
    });
    for_chunks(team, coarser.rows, [&](int begin, int end) {
      gather(level.down(), level.residual.data(), coarser.right.data(), begin, end);
    });
    if (team && coarser.rows < one_thread) {
#pragma omp single
      cycle(l + 1, false, coarser.right, coarser.x);
    } else {
      cycle(l + 1, team, coarser.right, coarser.x);
    }
    for_chunks(team, level.rows, [&](int begin, int end) {
      add_gathered(level.up(), coarser.x.data(), level.step.data(), x.data(), begin, end);
    });
    multiply(l, team, level.step, level.product_of_step);
  }
  smooth(l, team, x, false);
}

void Multigrid::apply(const Quads<float>& r, Quads<float>& z) { impl_->cycle(0, true, r, z); }

}  // namespace selvedge
