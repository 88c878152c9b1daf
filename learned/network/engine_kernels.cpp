#include "learned/network/engine_kernels.hpp"

#include "collision/geometry/error.hpp"
#include "learned/network/row_norms.hpp"

// Inner loops are templates over the number of lanes, inlined into one function per instruction set. CMake lets the
// compiler contract a * b + c here, because bits need to be the same on every thread only.

namespace selvedge {
namespace {

// `Rows` x two vectors of results stay in registers over all inputs. `Fetch` brings the next panel of weights into the
// first cache meanwhile, a line for each line that is read.
template <int Lanes, int Rows, bool Fetch>
[[gnu::always_inline]] inline void multiply_block(const LayerTile& t, int row, int column, const float* next) {
  Vector<Lanes> sums[Rows][2];
  const float* input[Rows];
  float* const out = t.out + static_cast<std::ptrdiff_t>(row) * t.stride + column;
  SELVEDGE_UNROLL
  for (int r = 0; r < Rows; ++r) {
    input[r] = t.input[row + r];
    const float* start = t.go_on ? out + static_cast<std::ptrdiff_t>(r) * t.stride : t.bias + column;
    sums[r][0] = load_vector<Lanes>(start);
    sums[r][1] = load_vector<Lanes>(start + Lanes);
  }
  const float* weight = t.weight + static_cast<std::ptrdiff_t>(column) * t.inputs;
  for (int k = 0; k < t.inputs; ++k) {
    const Vector<Lanes> left = load_vector<Lanes>(weight), right = load_vector<Lanes>(weight + Lanes);
    if constexpr (Fetch) __builtin_prefetch(next + 2 * Lanes * k);
    weight += 2 * Lanes;
    SELVEDGE_UNROLL
    for (int r = 0; r < Rows; ++r) {
      sums[r][0] += input[r][k] * left;
      sums[r][1] += input[r][k] * right;
    }
  }
  const Vector<Lanes> zero{};
  SELVEDGE_UNROLL
  for (int r = 0; r < Rows; ++r)
    for (int half = 0; half < 2; ++half) {
      Vector<Lanes> result = sums[r][half];
      if (t.rectify) result = result < zero ? zero : result;  // NaN stays
      if (t.mask) {
        const float* mask = t.mask + static_cast<std::ptrdiff_t>(row + r) * t.mask_stride + column + half * Lanes;
        result = load_vector<Lanes>(mask) > zero ? result : zero;
      }
      store_vector<Lanes>(result, out + static_cast<std::ptrdiff_t>(r) * t.stride + half * Lanes);
    }
}

template <int Lanes, int Rows>
[[gnu::always_inline]] inline void multiply_tile(const LayerTile& t) {
  static_assert(tile_rows % Rows == 0 && padding % (2 * Lanes) == 0);
  for (int column = 0; column < t.outputs; column += 2 * Lanes) {
    const int last = column + 2 * Lanes;
    const float* next = last < t.outputs ? t.weight + static_cast<std::ptrdiff_t>(last) * t.inputs : t.next_weight;
    int row = 0;
    for (; row + Rows < t.rows; row += Rows) multiply_block<Lanes, Rows, false>(t, row, column, next);
    multiply_block<Lanes, Rows, true>(t, row, column, next);
  }
}

template <int Lanes>
[[gnu::always_inline]] inline void add_pairs_tile(const PairTile& t) {
  for (int r = 0; r < t.rows; ++r) {
    float* out = t.out + static_cast<std::ptrdiff_t>(r) * t.stride;
    for (int k = 0; k < t.columns; k += Lanes)
      store_vector<Lanes>(load_vector<Lanes>(t.a[r] + k) + load_vector<Lanes>(t.b[r] + k), out + k);
  }
}

// One piece of a row. Value is a vector, or a float after the last whole vector.
template <class Value>
[[gnu::always_inline]] inline Value normalised(Value x, float mean, float factor, Value scale, Value shift) {
  return (x - mean) * factor * scale + shift;
}

template <int Lanes>
[[gnu::always_inline]] inline void finish_row(const ResultTile& t, int r, float mean, float factor) {
  const float* values = t.values + static_cast<std::ptrdiff_t>(r) * t.stride;
  float* latent = t.latent[r];
  float* sum = t.sum ? t.sum[r] : nullptr;
  const int whole = t.columns / Lanes * Lanes;
  for (int k = 0; k < whole; k += Lanes) {
    Vector<Lanes> x = load_vector<Lanes>(values + k);
    if (t.scale) x = normalised(x, mean, factor, load_vector<Lanes>(t.scale + k), load_vector<Lanes>(t.shift + k));
    if (sum) store_vector<Lanes>(load_vector<Lanes>(sum + k) + x, sum + k);
    store_vector<Lanes>(t.add ? load_vector<Lanes>(latent + k) + x : x, latent + k);
  }
  for (int k = whole; k < t.columns; ++k) {
    const float x = t.scale ? normalised(values[k], mean, factor, t.scale[k], t.shift[k]) : values[k];
    if (sum) sum[k] += x;
    latent[k] = t.add ? latent[k] + x : x;
  }
}

template <int Lanes, int Rows>
[[gnu::always_inline]] inline void finish_rows(const ResultTile& t, int row) {
  float mean[Rows] = {}, factor[Rows] = {};
  if (t.scale)
    find_norms<Lanes, Rows>(t.values + static_cast<std::ptrdiff_t>(row) * t.stride, t.stride, t.columns, mean, factor);
  for (int r = 0; r < Rows; ++r) finish_row<Lanes>(t, row + r, mean[r], factor[r]);
}

template <int Lanes>
[[gnu::always_inline]] inline void finish_tile(const ResultTile& t) {
  int row = 0;
  for (; row + 4 <= t.rows; row += 4) finish_rows<Lanes, 4>(t, row);
  for (; row < t.rows; ++row) finish_rows<Lanes, 1>(t, row);
}

template <int Lanes>
[[gnu::always_inline]] inline float exercise_registers(long iterations, float factor) {
  Vector<Lanes> sums[exercise_chains];
  SELVEDGE_UNROLL
  for (int chain = 0; chain < exercise_chains; ++chain) sums[chain] = Vector<Lanes>{} + static_cast<float>(chain);
  const Vector<Lanes> factors = Vector<Lanes>{} + factor;
  for (long i = 0; i < iterations; ++i) {
    SELVEDGE_UNROLL
    for (int chain = 0; chain < exercise_chains; ++chain) sums[chain] = sums[chain] * factors + factors;
  }
  SELVEDGE_UNROLL
  for (int chain = 1; chain < exercise_chains; ++chain) sums[0] += sums[chain];
  return sum_lanes<Lanes>(sums[0]);
}

// Blocks of 12 sums fit the 16 registers of the smaller sets, and 24 sums fit the 32 registers of AVX-512.
void multiply_plain(const LayerTile& t) { multiply_tile<4, 6>(t); }
void add_pairs_plain(const PairTile& t) { add_pairs_tile<4>(t); }
void finish_plain(const ResultTile& t) { finish_tile<4>(t); }
float exercise_plain(long n, float factor) { return exercise_registers<4>(n, factor); }

SELVEDGE_TARGET("avx2,fma") void multiply_avx2(const LayerTile& t) { multiply_tile<8, 6>(t); }
SELVEDGE_TARGET("avx2,fma") void add_pairs_avx2(const PairTile& t) { add_pairs_tile<8>(t); }
SELVEDGE_TARGET("avx2,fma") void finish_avx2(const ResultTile& t) { finish_tile<8>(t); }
SELVEDGE_TARGET("avx2,fma") float exercise_avx2(long n, float factor) { return exercise_registers<8>(n, factor); }

SELVEDGE_TARGET("avx512f,avx512vl,avx512dq,avx2,fma") void multiply_avx512(const LayerTile& t) {
  multiply_tile<16, 12>(t);
}
SELVEDGE_TARGET("avx512f,avx512vl,avx512dq,avx2,fma") void add_pairs_avx512(const PairTile& t) {
  add_pairs_tile<16>(t);
}
SELVEDGE_TARGET("avx512f,avx512vl,avx512dq,avx2,fma") void finish_avx512(const ResultTile& t) { finish_tile<16>(t); }
SELVEDGE_TARGET("avx512f,avx512vl,avx512dq,avx2,fma") float exercise_avx512(long n, float factor) {
  return exercise_registers<16>(n, factor);
}

constexpr EngineKernels plain_kernels{8, 4, false, multiply_plain, add_pairs_plain, finish_plain, exercise_plain};
constexpr EngineKernels avx2_kernels{16, 8, false, multiply_avx2, add_pairs_avx2, finish_avx2, exercise_avx2};
constexpr EngineKernels avx512_kernels{
    32, 16, false, multiply_avx512, add_pairs_avx512, finish_avx512, exercise_avx512};
#if defined(__x86_64__)
constexpr EngineKernels vnni_kernels{32, 16, true, multiply_int16, add_pairs_avx512, finish_avx512, exercise_avx512};
#endif

}  // namespace

bool is_supported(InstructionSet set) {
  if (set == InstructionSet::plain) return true;
#if defined(__x86_64__)
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (set == InstructionSet::avx2) return avx2;
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                      __builtin_cpu_supports("avx512dq");
  if (set == InstructionSet::avx512) return avx512;
  return avx512 && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vnni");
#else
  return false;
#endif
}

InstructionSet best_instruction_set() {
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2})
    if (is_supported(set)) return set;
  return InstructionSet::plain;
}

std::string name_of(InstructionSet set) {
  if (set == InstructionSet::vnni) return "AVX-512 VNNI";
  return set == InstructionSet::avx512 ? "AVX-512" : set == InstructionSet::avx2 ? "AVX2" : "plain";
}

const EngineKernels& kernels_for(InstructionSet set) {
  if (!is_supported(set))
    throw Error("this machine does not have the instruction set", name_of(set), "choose another one");
#if defined(__x86_64__)
  if (set == InstructionSet::vnni) return vnni_kernels;
#endif
  return set == InstructionSet::avx512 ? avx512_kernels : set == InstructionSet::avx2 ? avx2_kernels : plain_kernels;
}

}  // namespace selvedge
