#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <utility>

#include "learned/network/engine_kernels.hpp"
#include "learned/network/simd_vector.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

#define SELVEDGE_VNNI SELVEDGE_TARGET("avx512vnni,avx512f,avx512bw,avx512vl,avx512dq,avx2,fma")

namespace selvedge {
namespace {

constexpr int block_rows = 12, lanes = 16;
constexpr int most_pairs = 128;  // pairs of inputs that are rounded at a time, so that they stay in the first cache

// Inputs of a tile as integers: an input is about its integer times the unit of its row. Two neighbours make a pair, as
// the instruction reads them.
struct RoundedInputs {
  alignas(64) std::uint32_t pair[tile_rows][most_pairs];
  float unit[tile_rows], per_unit[tile_rows];
};

// The first `count` floats, which are 1 to 15, and zeros after them.
SELVEDGE_VNNI inline __m512 load_first(const float* from, int count) {
  return _mm512_maskz_loadu_ps(static_cast<__mmask16>((1 << count) - 1), from);
}

SELVEDGE_VNNI inline std::int32_t largest_of(__m512i values) {
  const __m256i eight = _mm256_max_epi32(_mm512_castsi512_si256(values), _mm512_extracti64x4_epi64(values, 1));
  __m128i four = _mm_max_epi32(_mm256_castsi256_si128(eight), _mm256_extracti128_si256(eight, 1));
  four = _mm_max_epi32(four, _mm_shuffle_epi32(four, 0x4e));
  return _mm_cvtsi128_si32(_mm_max_epi32(four, _mm_shuffle_epi32(four, 0xb1)));
}

// The larger of both sizes. Without their sign, bits of floats are in the order of the floats, no numbers above all.
SELVEDGE_VNNI inline __m512i larger(__m512i largest, __m512 values) {
  return _mm512_max_epi32(largest, _mm512_castps_si512(values) & _mm512_set1_epi32(0x7fffffff));
}

// The unit of a row is its largest input over the largest integer. Something that is no number makes the unit none.
SELVEDGE_VNNI void find_units(const LayerTile& t, int rows, RoundedInputs& rounded) {
  const int whole = t.inputs / lanes * lanes;
  for (int r = 0; r < rows; ++r) {
    const float* row = t.input[r];
    __m512i largest{};
    for (int k = 0; k < whole; k += lanes) largest = larger(largest, _mm512_loadu_ps(row + k));
    if (whole < t.inputs) largest = larger(largest, load_first(row + whole, t.inputs - whole));
    const auto size = std::bit_cast<float>(largest_of(largest));
    rounded.unit[r] = size * (1 / static_cast<float>(largest_input));
    rounded.per_unit[r] = size == 0 ? 0 : static_cast<float>(largest_input) / size;
  }
}

// Eight pairs.
SELVEDGE_VNNI inline void store_pairs(__m512 inputs, __m512 per_unit, std::uint32_t* to) {
  _mm256_store_si256(reinterpret_cast<__m256i*>(to), _mm512_cvtepi32_epi16(_mm512_cvtps_epi32(inputs * per_unit)));
}

// Inputs [begin, end) of each row.
SELVEDGE_VNNI void round_inputs(const LayerTile& t, int rows, int begin, int end, RoundedInputs& rounded) {
  const int whole = (end - begin) / lanes * lanes, rest = end - begin - whole;
  for (int r = 0; r < rows; ++r) {
    const float* row = t.input[r] + begin;
    const __m512 per_unit = _mm512_set1_ps(rounded.per_unit[r]);
    for (int k = 0; k < whole; k += lanes) store_pairs(_mm512_loadu_ps(row + k), per_unit, rounded.pair[r] + k / 2);
    if (rest > 0) store_pairs(load_first(row + whole, rest), per_unit, rounded.pair[r] + whole / 2);
  }
}

// Sums of one row and vector become results.
SELVEDGE_VNNI inline void store_results(const LayerTile& t, __m512i sums, float unit, int row, int column, bool go_on,
                                        bool rectify) {
  float* const out = t.out + static_cast<std::ptrdiff_t>(row) * t.stride + column;
  const __m512 start = _mm512_loadu_ps(go_on ? out : t.bias + column), zero{};
  __m512 result = start + _mm512_cvtepi32_ps(sums) * (_mm512_loadu_ps(t.unit + column) * unit);
  if (rectify) result = result < zero ? zero : result;  // NaN stays
  _mm512_storeu_ps(out, result);
}

// sums += products of pairs. GCC 12 copies every sum before its own function for this instruction.
SELVEDGE_VNNI inline __m512i with_products(__m512i sums, __m512i weights, __m512i pair) {
  asm("vpdpwssd %2, %1, %0" : "+v"(sums) : "v"(weights), "v"(pair));
  return sums;
}

// A block of `R...` rows x two vectors of sums, which stay in registers over all pairs of inputs: a loop over the rows
// would put them into memory.
template <int... R>
SELVEDGE_VNNI [[gnu::noinline]] void multiply_block(std::integer_sequence<int, R...>, const LayerTile& t,
                                                    const RoundedInputs& rounded, const float* weight, int pairs,
                                                    int row, int column, bool go_on, bool rectify) {
  __m512i left_sums[] = {(static_cast<void>(R), __m512i{})...}, right_sums[] = {(static_cast<void>(R), __m512i{})...};
  const std::uint32_t* input = rounded.pair[row];
  for (int k = 0; k < pairs; ++k, weight += 2 * lanes, ++input) {
    const __m512i left = _mm512_loadu_si512(weight), right = _mm512_loadu_si512(weight + lanes);
    __m512i pair;
    ((pair = _mm512_set1_epi32(static_cast<int>(input[R * most_pairs])),
      left_sums[R] = with_products(left_sums[R], left, pair),
      right_sums[R] = with_products(right_sums[R], right, pair)),
     ...);
  }
  (store_results(t, left_sums[R], rounded.unit[row + R], row + R, column, go_on, rectify), ...);
  (store_results(t, right_sums[R], rounded.unit[row + R], row + R, column + lanes, go_on, rectify), ...);
}

}  // namespace

SELVEDGE_VNNI void multiply_int16(const LayerTile& t) {
  assert(!t.mask);
  const int all = pairs_of(t.inputs), rows = (t.rows + block_rows - 1) / block_rows * block_rows;
  RoundedInputs rounded;
  find_units(t, rows, rounded);
  for (int first = 0; first < all; first += most_pairs) {
    const int pairs = std::min(most_pairs, all - first);
    round_inputs(t, rows, 2 * first, std::min(2 * (first + pairs), t.inputs), rounded);
    for (int column = 0; column < t.outputs; column += 2 * lanes) {
      const float* weight = t.weight + static_cast<std::ptrdiff_t>(column) * all + first * 2 * lanes;
      for (int row = 0; row < rows; row += block_rows)
        multiply_block(std::make_integer_sequence<int, block_rows>(), t, rounded, weight, pairs, row, column,
                       t.go_on || first > 0, t.rectify && first + pairs == all);
    }
  }
}

}  // namespace selvedge
#endif
