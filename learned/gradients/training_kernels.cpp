#include "learned/gradients/training_kernels.hpp"

#include "collision/geometry/error.hpp"
#include "learned/network/row_norms.hpp"

// Built as engine_kernels.cpp: templates over the lanes, inlined into one function per instruction set. Contraction is
// allowed.

namespace selvedge {
namespace {

template <int Lanes>
[[gnu::always_inline]] inline void add_to(float* to, Vector<Lanes> x) {
  store_vector<Lanes>(load_vector<Lanes>(to) + x, to);
}

template <int Lanes, int Rows>
[[gnu::always_inline]] inline void norm_rows(const NormTile& t, int row) {
  float* values = t.values + static_cast<std::ptrdiff_t>(row) * t.stride;
  const int whole = t.columns / Lanes * Lanes;
  float mean[Rows], factor[Rows];
  find_norms<Lanes, Rows>(values, t.stride, t.columns, mean, factor);
  for (int r = 0; r < Rows; ++r) t.factor[row + r] = factor[r];
  for (int r = 0; r < Rows; ++r) {
    float* of_row = values + r * t.stride;
    for (int k = 0; k < whole; k += Lanes)
      store_vector<Lanes>((load_vector<Lanes>(of_row + k) - mean[r]) * factor[r], of_row + k);
    for (int k = whole; k < t.columns; ++k) of_row[k] = (of_row[k] - mean[r]) * factor[r];
  }
}

template <int Lanes>
[[gnu::always_inline]] inline void spread_row(const NormTile& t, int r) {
  const float* values = t.values + static_cast<std::ptrdiff_t>(r) * t.stride;
  const float* from = t.from ? t.from[r] : nullptr;
  float* sum = t.sum ? t.sum[r] : nullptr;
  float* latent = t.latent[r];
  const int whole = t.columns / Lanes * Lanes;
  for (int k = 0; k < whole; k += Lanes) {
    Vector<Lanes> x = load_vector<Lanes>(values + k);
    if (t.scale) x = x * load_vector<Lanes>(t.scale + k) + load_vector<Lanes>(t.shift + k);
    if (sum) add_to<Lanes>(sum + k, x);
    store_vector<Lanes>(from ? load_vector<Lanes>(from + k) + x : x, latent + k);
  }
  for (int k = whole; k < t.columns; ++k) {
    const float x = t.scale ? values[k] * t.scale[k] + t.shift[k] : values[k];
    if (sum) sum[k] += x;
    latent[k] = from ? from[k] + x : x;
  }
}

template <int Lanes>
[[gnu::always_inline]] inline void norm_tile(const NormTile& t) {
  int row = 0;
  for (; row + 4 <= t.rows; row += 4) {
    if (t.scale) norm_rows<Lanes, 4>(t, row);
    for (int r = 0; r < 4; ++r) spread_row<Lanes>(t, row + r);
  }
  for (; row < t.rows; ++row) {
    if (t.scale) norm_rows<Lanes, 1>(t, row);
    spread_row<Lanes>(t, row);
  }
}

// Each row becomes factor (g - mean(g) - u mean(g u)), where g = d scale and u are the normalised values.
template <int Lanes, int Rows>
[[gnu::always_inline]] inline void norm_back_rows(const NormBackTile& t, int row) {
  float* d = t.d + static_cast<std::ptrdiff_t>(row) * t.stride;
  const float* u = t.values + static_cast<std::ptrdiff_t>(row) * t.values_stride;
  const int whole = t.columns / Lanes * Lanes;
  const auto columns = static_cast<float>(t.columns);
  Vector<Lanes> sums[Rows] = {}, products[Rows] = {};
  for (int k = 0; k < whole; k += Lanes) {
    const Vector<Lanes> scale = load_vector<Lanes>(t.scale + k);
    Vector<Lanes> d_scale = load_vector<Lanes>(t.d_scale + k), d_shift = load_vector<Lanes>(t.d_shift + k);
    SELVEDGE_UNROLL
    for (int r = 0; r < Rows; ++r) {
      const Vector<Lanes> dk = load_vector<Lanes>(d + r * t.stride + k);
      const Vector<Lanes> uk = load_vector<Lanes>(u + r * t.values_stride + k);
      const Vector<Lanes> g = dk * scale;
      d_scale += dk * uk;
      d_shift += dk;
      sums[r] += g;
      products[r] += g * uk;
    }
    store_vector<Lanes>(d_scale, t.d_scale + k);
    store_vector<Lanes>(d_shift, t.d_shift + k);
  }
  for (int r = 0; r < Rows; ++r) {
    float *dr = d + r * t.stride, mean = sum_lanes<Lanes>(sums[r]), slope = sum_lanes<Lanes>(products[r]);
    const float* ur = u + r * t.values_stride;
    for (int k = whole; k < t.columns; ++k) {
      t.d_scale[k] += dr[k] * ur[k];
      t.d_shift[k] += dr[k];
      mean += dr[k] * t.scale[k];
      slope += dr[k] * t.scale[k] * ur[k];
    }
    const float factor = t.factor[row + r];
    mean /= columns;
    slope /= columns;
    for (int k = 0; k < whole; k += Lanes) {
      const Vector<Lanes> g = load_vector<Lanes>(dr + k) * load_vector<Lanes>(t.scale + k);
      store_vector<Lanes>((g - mean - load_vector<Lanes>(ur + k) * slope) * factor, dr + k);
    }
    for (int k = whole; k < t.columns; ++k) dr[k] = (dr[k] * t.scale[k] - mean - ur[k] * slope) * factor;
  }
}

template <int Lanes>
[[gnu::always_inline]] inline void norm_back_tile(const NormBackTile& t) {
  int row = 0;
  for (; row + 4 <= t.rows; row += 4) norm_back_rows<Lanes, 4>(t, row);
  for (; row < t.rows; ++row) norm_back_rows<Lanes, 1>(t, row);
}

// Adds products of columns [i, i + Columns) of a with two vectors of b. The sums stay in registers.
template <int Lanes, int Columns>
[[gnu::always_inline]] inline void outer_block(const OuterTile& t, int i, int j) {
  Vector<Lanes> sums[Columns][2];
  float* const out = t.out + static_cast<std::ptrdiff_t>(i) * t.b_columns + j;
  SELVEDGE_UNROLL
  for (int c = 0; c < Columns; ++c) {
    sums[c][0] = load_vector<Lanes>(out + static_cast<std::ptrdiff_t>(c) * t.b_columns);
    sums[c][1] = load_vector<Lanes>(out + static_cast<std::ptrdiff_t>(c) * t.b_columns + Lanes);
  }
  const float* a = t.a + i;
  for (int r = 0; r < t.rows; ++r) {
    const Vector<Lanes> left = load_vector<Lanes>(t.b[r] + j), right = load_vector<Lanes>(t.b[r] + j + Lanes);
    SELVEDGE_UNROLL
    for (int c = 0; c < Columns; ++c) {
      sums[c][0] += a[c] * left;
      sums[c][1] += a[c] * right;
    }
    a += t.a_stride;
  }
  SELVEDGE_UNROLL
  for (int c = 0; c < Columns; ++c) {
    store_vector<Lanes>(sums[c][0], out + static_cast<std::ptrdiff_t>(c) * t.b_columns);
    store_vector<Lanes>(sums[c][1], out + static_cast<std::ptrdiff_t>(c) * t.b_columns + Lanes);
  }
}

template <int Lanes, int Columns>
[[gnu::always_inline]] inline void outer_tile(const OuterTile& t) {
  for (int j = 0; j < t.b_columns; j += 2 * Lanes) {
    int i = 0;
    for (; (t.a_columns - i) % Columns != 0; i += 4) outer_block<Lanes, 4>(t, i, j);  // 32 and 64 are no multiples of 6
    for (; i < t.a_columns; i += Columns) outer_block<Lanes, Columns>(t, i, j);
  }
  if (!t.bias) return;
  for (int i = 0; i < t.a_columns; i += Lanes) {
    Vector<Lanes> sum = load_vector<Lanes>(t.bias + i);
    for (int r = 0; r < t.rows; ++r) sum += load_vector<Lanes>(t.a + static_cast<std::ptrdiff_t>(r) * t.a_stride + i);
    store_vector<Lanes>(sum, t.bias + i);
  }
}

template <int Lanes>
[[gnu::always_inline]] inline void add_tile(const AddTile& t) {
  for (int r = 0; r < t.rows; ++r)
    for (int k = 0; k < t.columns; k += Lanes)
      add_to<Lanes>(t.to[r] + k, load_vector<Lanes>(t.from + static_cast<std::ptrdiff_t>(r) * t.stride + k));
}

template <int Lanes>
[[gnu::always_inline]] inline void sum_tile(const SumTile& t) {
  for (int k = 0; k < t.columns; k += 2 * Lanes) {
    Vector<Lanes> left{}, right{};
    for (int r = 0; r < t.rows; ++r) {
      const float* from = t.from + static_cast<std::ptrdiff_t>(t.slots[r]) * t.stride + k;
      left += load_vector<Lanes>(from);
      right += load_vector<Lanes>(from + Lanes);
    }
    store_vector<Lanes>(left, t.to + k);
    store_vector<Lanes>(right, t.to + k + Lanes);
  }
}

void norm_plain(const NormTile& t) { norm_tile<4>(t); }
void norm_back_plain(const NormBackTile& t) { norm_back_tile<4>(t); }
void outer_plain(const OuterTile& t) { outer_tile<4, 4>(t); }
void add_plain(const AddTile& t) { add_tile<4>(t); }
void sum_plain(const SumTile& t) { sum_tile<4>(t); }

#define SELVEDGE_AVX2 SELVEDGE_TARGET("avx2,fma")
SELVEDGE_AVX2 void norm_avx2(const NormTile& t) { norm_tile<8>(t); }
SELVEDGE_AVX2 void norm_back_avx2(const NormBackTile& t) { norm_back_tile<8>(t); }
SELVEDGE_AVX2 void outer_avx2(const OuterTile& t) { outer_tile<8, 6>(t); }
SELVEDGE_AVX2 void add_avx2(const AddTile& t) { add_tile<8>(t); }
SELVEDGE_AVX2 void sum_avx2(const SumTile& t) { sum_tile<8>(t); }

#define SELVEDGE_AVX512 SELVEDGE_TARGET("avx512f,avx512vl,avx512dq,avx2,fma")
SELVEDGE_AVX512 void norm_avx512(const NormTile& t) { norm_tile<16>(t); }
SELVEDGE_AVX512 void norm_back_avx512(const NormBackTile& t) { norm_back_tile<16>(t); }
SELVEDGE_AVX512 void outer_avx512(const OuterTile& t) { outer_tile<16, 8>(t); }
SELVEDGE_AVX512 void add_avx512(const AddTile& t) { add_tile<16>(t); }
SELVEDGE_AVX512 void sum_avx512(const SumTile& t) { sum_tile<16>(t); }

constexpr TrainingKernels plain_training{norm_plain, norm_back_plain, outer_plain, add_plain, sum_plain};
constexpr TrainingKernels avx2_training{norm_avx2, norm_back_avx2, outer_avx2, add_avx2, sum_avx2};
constexpr TrainingKernels avx512_training{norm_avx512, norm_back_avx512, outer_avx512, add_avx512, sum_avx512};

}  // namespace

const TrainingKernels& training_kernels_for(InstructionSet set) {
  if (!is_supported(set))
    throw Error("this machine does not have the instruction set", name_of(set), "choose another one");
  return set == InstructionSet::avx512 ? avx512_training : set == InstructionSet::avx2 ? avx2_training : plain_training;
}

}  // namespace selvedge
