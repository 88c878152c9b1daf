#include "physics/linear/galerkin.hpp"

#include <algorithm>
#include <cmath>

#include "collision/geometry/lists.hpp"

namespace selvedge {
namespace {

constexpr double rounding = 1e-12;

// Of each item the number of its list; `begin` as in IndexLists.
std::vector<int> lists_of_items(const std::vector<int>& begin) {
  std::vector<int> list;
  for (int i = 0; i + 1 < static_cast<int>(begin.size()); ++i) list.resize(begin[i + 1], i);
  return list;
}

// Collects the terms of coarse rows, one row after the other, on the diagonal and right of it, and assigns slots to
// columns. `constant` may be null.
class RowCollector {
 public:
  RowCollector(int columns, ConstantEntries* constant) : constant_(constant), slot_(columns, -1) {
    product_.begin = {0};
    if (constant) constant->diagonal.clear();
  }
  void start(int row) {
    row_ = row;
    if (constant_) constant_->diagonal.push_back(0);
  }
  void add(int source, int column, double weight) {
    if (weight == 0 || column < row_) return;
    const int target = column == row_ ? -1 : slot(column);
    const float rounded = static_cast<float>(weight);
    if (constant_ && source >= 0 && !std::isnan(constant_->value[source]))
      (target < 0 ? constant_->diagonal.back() : slot_sum_[target]) +=
          static_cast<double>(rounded) * constant_->value[source];
    else
      row_terms_.push_back({{source, rounded}, target});
  }
  void finish() {
    for (std::size_t k = begin_.back(); k < column_.size(); ++k) slot_[column_[k]] = -1;
    sort_by_target();
    begin_.push_back(static_cast<int>(column_.size()));
    product_.begin.push_back(static_cast<int>(product_.target.size()));
  }
  Product with_mirrored(RowPattern& whole);

 private:
  int slot(int column) {
    if (slot_[column] < 0) {
      slot_[column] = static_cast<int>(column_.size());
      column_.push_back(column);
      if (constant_) slot_sum_.push_back(0);
    }
    return slot_[column];
  }
  // Appends the terms of the last row by target, the diagonal first; terms of one target keep their order.
  void sort_by_target();

  struct RowTerm {
    ProductTerm term;
    int target;  // a slot, or -1
  };
  ConstantEntries* constant_;
  int row_ = 0;
  std::vector<int> slot_, begin_{0}, column_;  // slots are positions in column_
  std::vector<double> slot_sum_;               // of constant entries
  std::vector<RowTerm> row_terms_;
  std::vector<int> next_;  // of each target of a row: the index of its next term
  Product product_;
};

void RowCollector::sort_by_target() {
  const int before = begin_.back() - 1;  // the diagonal comes before the row's slots
  const int old = static_cast<int>(product_.term.size());
  const auto place = [&](const RowTerm& t) { return t.target < 0 ? 0 : t.target - before; };
  next_.assign(column_.size() - before + 1, 0);
  for (const RowTerm& t : row_terms_) ++next_[place(t) + 1];
  for (std::size_t k = 0; k + 1 < next_.size(); ++k) {
    if (next_[k + 1] > 0) {
      product_.target.push_back(k == 0 ? -1 : static_cast<int>(k) + before);
      product_.first.push_back(old + next_[k]);
    }
    next_[k + 1] += next_[k];
  }
  product_.term.resize(old + row_terms_.size());
  for (const RowTerm& t : row_terms_) product_.term[old + next_[place(t)]++] = t.term;
  row_terms_.clear();
}

// The product of the collected terms and their mirror images in one pattern: each row's left part first.
Product RowCollector::with_mirrored(RowPattern& whole) {
  const int rows = static_cast<int>(begin_.size()) - 1;
  const IndexLists left = indices_by_value(column_, rows);  // slots
  const std::vector<int> row_of_slot = lists_of_items(begin_);
  std::vector<int> entry(column_.size());  // of each slot its entry in the whole pattern
  whole.begin = {0};
  whole.column.clear();
  product_.mirror.clear();
  for (int a = 0; a < rows; ++a) {
    for (const int slot : left.of(a)) {
      whole.column.push_back(row_of_slot[slot]);
      product_.mirror.push_back(entry[slot]);
    }
    for (int k = begin_[a]; k < begin_[a + 1]; ++k) {
      entry[k] = static_cast<int>(whole.column.size());
      whole.column.push_back(column_[k]);
    }
    whole.end_row(a);
    product_.mirror.resize(whole.column.size(), -1);
  }
  for (int& target : product_.target)
    if (target >= 0) target = entry[target];
  product_.first.push_back(static_cast<int>(product_.term.size()));
  if (constant_) {
    constant_->sum.assign(whole.column.size(), 0);
    for (std::size_t k = 0; k < entry.size(); ++k) constant_->sum[entry[k]] = slot_sum_[k];
  }
  for (std::vector<int>* list : {&product_.target, &product_.first, &product_.mirror, &whole.column})
    list->shrink_to_fit();
  product_.term.shrink_to_fit();
  return std::move(product_);
}

// Rounds a sum that is zero or one up to rounding to exactly that.
double without_rounding(double sum) {
  if (std::abs(sum) < rounding) return 0;
  return std::abs(sum - 1) < rounding ? 1 : sum;
}

double weight_sum(const Prolongation& p, int i) {
  double sum = 0;
  for (int k = p.begin[i]; k < p.begin[i + 1]; ++k) sum += p.weight[k];
  return without_rounding(sum);
}

double weight_of(const Prolongation& p, int i, int coarse) {
  for (int k = p.begin[i]; k < p.begin[i + 1]; ++k)
    if (p.coarse[k] == coarse) return p.weight[k];
  return 0;
}

struct CoarseContacts {
  std::vector<int> begin{0}, node;
  std::vector<double> weight, sum;
};

CoarseContacts interpolate(std::span<const ContactBlock> contacts, const Prolongation& p) {
  CoarseContacts coarse;
  for (const ContactBlock& contact : contacts) {
    const std::size_t first = coarse.node.size();
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      const int i = contact.nodes[k];
      if (i < 0) continue;
      for (int l = p.begin[i]; l < p.begin[i + 1]; ++l) {
        const double weight = contact.weights[k] * p.weight[l];
        sum += weight;
        const auto known = std::find(coarse.node.begin() + first, coarse.node.end(), p.coarse[l]);
        if (known != coarse.node.end()) {
          coarse.weight[known - coarse.node.begin()] += weight;
        } else {
          coarse.node.push_back(p.coarse[l]);
          coarse.weight.push_back(weight);
        }
      }
    }
    coarse.begin.push_back(static_cast<int>(coarse.node.size()));
    coarse.sum.push_back(without_rounding(sum));
  }
  return coarse;
}

}  // namespace

Restriction transpose(const Prolongation& p) {
  const IndexLists by = indices_by_value(p.coarse, p.coarse_count());
  const std::vector<int> fine = lists_of_items(p.begin);
  Restriction result{by.begin, {}, {}};
  for (const int k : by.item) {
    result.fine.push_back(fine[k]);
    result.weight.push_back(p.weight[k]);
  }
  return result;
}

// With s_i the sum of row i of P, row a of P^T A P in the form that sees differences only:
//   sum_i P_ia [ D_i (s_i u_a + sum_b P_ib (u_b - u_a)) + sum_j B_ij ((s_j - s_i) u_a + sum_b (P_jb - P_ib) (u_b -
//   u_a)) ].
Product make_product(const RowPattern& fine, bool diagonal, const Prolongation& p, const Restriction& restriction,
                     RowPattern& coarse, ConstantEntries* constant) {
  RowCollector rows(p.coarse_count(), constant);
  std::vector<double> sum(p.fine_count());
  for (int i = 0; i < p.fine_count(); ++i) sum[i] = weight_sum(p, i);
  for (int a = 0; a < p.coarse_count(); ++a) {
    rows.start(a);
    for (int k = restriction.begin[a]; k < restriction.begin[a + 1]; ++k) {
      const int i = restriction.fine[k];
      const double own = restriction.weight[k];
      if (diagonal) {
        rows.add(~i, a, own * sum[i]);
        for (int l = p.begin[i]; l < p.begin[i + 1]; ++l)
          if (p.coarse[l] != a) rows.add(~i, p.coarse[l], own * p.weight[l]);
      }
      for (int entry = fine.begin[i]; entry < fine.begin[i + 1]; ++entry) {
        const int j = fine.column[entry];
        rows.add(entry, a, own * (sum[j] - sum[i]));
        for (int l = p.begin[j]; l < p.begin[j + 1]; ++l)
          if (p.coarse[l] != a) rows.add(entry, p.coarse[l], own * (p.weight[l] - weight_of(p, i, p.coarse[l])));
        for (int l = p.begin[i]; l < p.begin[i + 1]; ++l)
          if (p.coarse[l] != a && weight_of(p, j, p.coarse[l]) == 0) rows.add(entry, p.coarse[l], -own * p.weight[l]);
      }
    }
    rows.finish();
  }
  return rows.with_mirrored(coarse);
}

Product make_product(std::span<const ContactBlock> contacts, const Prolongation& p, RowPattern& coarse) {
  const CoarseContacts all = interpolate(contacts, p);
  const IndexLists places = indices_by_value(all.node, p.coarse_count());
  const std::vector<int> contact = lists_of_items(all.begin);
  RowCollector rows(p.coarse_count(), nullptr);
  for (int a = 0; a < p.coarse_count(); ++a) {
    rows.start(a);
    for (const int place : places.of(a)) {
      const int c = contact[place];
      const double own = all.weight[place];
      rows.add(c, a, own * all.sum[c]);
      for (int k = all.begin[c]; k < all.begin[c + 1]; ++k)
        if (all.node[k] != a) rows.add(c, all.node[k], own * all.weight[k]);
    }
    rows.finish();
  }
  return rows.with_mirrored(coarse);
}

void accumulate(const Product& product, const BlockPair<float>* source, const BlockColumns<float>* source_diagonal,
                BlockPair<float>* target, BlockColumns<float>* target_diagonal, int begin, int end) {
  for (int a = begin; a < end; ++a)
    for (int target_of_row = product.begin[a]; target_of_row < product.begin[a + 1]; ++target_of_row) {
      const int entry = product.target[target_of_row];
      const auto to = [&](int k) -> Quad<float>& {
        return entry < 0 ? target_diagonal[a].column[k] : column_of(target, entry, k);
      };
      auto x = to(0).lanes, y = to(1).lanes, z = to(2).lanes;
      for (int t = product.first[target_of_row]; t < product.first[target_of_row + 1]; ++t) {
        const ProductTerm term = product.term[t];
        const auto add = [&](const auto& from) {
          x += from(0).lanes * term.weight;
          y += from(1).lanes * term.weight;
          z += from(2).lanes * term.weight;
        };
        if (term.source < 0)
          add([&](int k) -> const Quad<float>& { return source_diagonal[~term.source].column[k]; });
        else
          add([&](int k) -> const Quad<float>& { return column_of(source, term.source, k); });
      }
      to(0).lanes = x;
      to(1).lanes = y;
      to(2).lanes = z;
    }
}

void reflect(const Product& product, const RowPattern& pattern, BlockPair<float>* target, int begin, int end) {
  for (int entry = pattern.begin[begin]; entry < pattern.begin[end]; ++entry) {
    const int of = product.mirror[entry];
    if (of < 0) continue;
    for (int k = 0; k < 3; ++k)
      for (int r = 0; r < 3; ++r) column_of(target, entry, k).lanes[r] = column_of(target, of, r).lanes[k];
  }
}

}  // namespace selvedge
