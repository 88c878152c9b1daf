#include "pipeline/view/packed_positions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace selvedge {
namespace {

using Steps = std::vector<std::int64_t>;

constexpr std::int64_t farthest = std::int64_t(1) << 30;  // steps; JavaScript's bit operations have 32 bits
constexpr std::uint64_t longest_run = 24;                 // of ones; a number beyond it follows with all its bits
constexpr int whole_bits = 40, most_parameter = 24;

void put(PackedPositions& packed, std::uint64_t value, int bits) {
  for (int b = bits - 1; b >= 0; --b) {
    packed.open_bits = packed.open_bits << 1 | static_cast<unsigned>(value >> b & 1);
    if (++packed.open_count < 8) continue;
    packed.bytes += static_cast<char>(packed.open_bits);
    packed.open_bits = 0;
    packed.open_count = 0;
  }
}

void put_code(PackedPositions& packed, std::uint64_t number, int k) {
  const std::uint64_t ones = number >> k;
  if (ones >= longest_run) {
    put(packed, ~std::uint64_t(0), static_cast<int>(longest_run));
    put(packed, number, whole_bits);
  } else {
    put(packed, (std::uint64_t(1) << (ones + 1)) - 2, static_cast<int>(ones + 1));
    put(packed, number, k);
  }
}

// 0, -1, 1, -2, 2, ... as 0, 1, 2, 3, 4, ...
std::uint64_t unsigned_of(std::int64_t value) {
  return value >= 0 ? 2 * static_cast<std::uint64_t>(value) : 2 * static_cast<std::uint64_t>(-(value + 1)) + 1;
}

std::uint64_t bits_of(const std::vector<std::uint64_t>& numbers, int k) {
  std::uint64_t sum = 0;
  for (const std::uint64_t number : numbers)
    sum += number >> k >= longest_run ? longest_run + whole_bits : (number >> k) + 1 + k;
  return sum;
}

// One coordinate of a frame as it would be written.
struct Column {
  bool line = false, against_neighbour = false;
  int k = 0;
  std::uint64_t bits = std::numeric_limits<std::uint64_t>::max();
  std::vector<std::uint64_t> numbers;
};

Column column_of(const PackedPositions& packed, const Steps& now, int axis, bool line, bool against_neighbour) {
  Column column{.line = line, .against_neighbour = against_neighbour, .numbers = {}};
  column.numbers.reserve(now.size() / 3);
  std::int64_t neighbour = 0;
  double sum = 0;
  for (std::size_t i = static_cast<std::size_t>(axis); i < now.size(); i += 3) {
    const std::int64_t predicted = line ? 2 * packed.last[i] - packed.before_last[i] : packed.last[i];
    const std::int64_t rest = now[i] - predicted;
    column.numbers.push_back(unsigned_of(against_neighbour ? rest - neighbour : rest));
    sum += static_cast<double>(column.numbers.back());
    neighbour = rest;
  }
  const double mean = sum / std::max<double>(1, static_cast<double>(column.numbers.size()));
  const int guess = static_cast<int>(std::log2(mean + 1));
  for (int k = std::max(0, guess - 2); k <= std::min(most_parameter, guess + 1); ++k)
    if (const std::uint64_t bits = bits_of(column.numbers, k); bits < column.bits) {
      column.bits = bits;
      column.k = k;
    }
  return column;
}

void put_column(PackedPositions& packed, const Column& column) {
  put(packed, column.line, 1);
  put(packed, column.against_neighbour, 1);
  put(packed, static_cast<std::uint64_t>(column.k), 5);
  for (const std::uint64_t number : column.numbers) put_code(packed, number, column.k);
}

// Positions in whole steps; an absent vertex stays where it was.
Steps steps_of(PackedPositions& packed, const PointsF& x) {
  Steps steps = packed.last;
  std::vector<int> absent;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const Eigen::RowVector3d at = (x.row(v).cast<double>() / packed.step).array().round();
    if (!at.allFinite() || at.cwiseAbs().maxCoeff() >= static_cast<double>(farthest))
      absent.push_back(static_cast<int>(v));
    else
      for (int k = 0; k < 3; ++k) steps[3 * v + k] = static_cast<std::int64_t>(at[k]);
  }
  packed.absent.push_back(std::move(absent));
  return steps;
}

}  // namespace

double grid_step(const PointsF& x) {
  constexpr double coarsest = 1e-4, finest = 1e-7, steps_a_side = 32768, of_floats = 0x1p-24;
  Eigen::RowVector3d low = Eigen::RowVector3d::Constant(INFINITY), high = -low;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    if (!x.row(v).allFinite()) continue;
    low = low.cwiseMin(x.row(v).cast<double>());
    high = high.cwiseMax(x.row(v).cast<double>());
  }
  const double side = low.allFinite() ? (high - low).maxCoeff() : 0;
  if (!(side > 0)) return coarsest;
  const double rounding = of_floats * std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  return std::min(coarsest, std::max({side / steps_a_side, finest, rounding}));
}

void append(PackedPositions& packed, const PointsF& x) {
  if (packed.frames == 0) packed.last.assign(static_cast<std::size_t>(x.size()), 0);
  Steps now = steps_of(packed, x);
  for (int axis = 0; axis < 3; ++axis) {
    Column best = column_of(packed, now, axis, false, false);
    for (const auto& [line, neighbour] : {std::array{false, true}, std::array{true, false}, std::array{true, true}})
      if (!line || packed.frames > 1)
        if (Column column = column_of(packed, now, axis, line, neighbour); column.bits < best.bits)
          best = std::move(column);
    put_column(packed, best);
  }
  packed.before_last = std::move(packed.last);
  packed.last = std::move(now);
  ++packed.frames;
}

std::string closed(const PackedPositions& packed) {
  std::string bytes = packed.bytes;
  if (packed.open_count > 0) bytes += static_cast<char>(packed.open_bits << (8 - packed.open_count));
  return bytes;
}

}  // namespace selvedge
