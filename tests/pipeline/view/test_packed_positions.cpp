#include "pipeline/view/packed_positions.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

namespace selvedge::test_packed_positions {
namespace {

// Reads the code as its header describes it, bit by bit, and shares nothing with the writer.
struct Reader {
  std::string bytes;
  std::size_t at = 0;

  std::uint64_t bit() {
    const std::uint64_t value = static_cast<unsigned char>(bytes.at(at / 8)) >> (7 - at % 8) & 1;
    ++at;
    return value;
  }
  std::uint64_t bits(int count) {
    std::uint64_t value = 0;
    while (count-- > 0) value = 2 * value + bit();
    return value;
  }
  std::int64_t number(int k) {
    std::uint64_t ones = 0;
    while (ones < 24 && bit() == 1) ++ones;
    const std::uint64_t value = ones < 24 ? (ones << k) + bits(k) : bits(40);
    return value % 2 ? -static_cast<std::int64_t>(value / 2) - 1 : static_cast<std::int64_t>(value / 2);
  }
};

std::vector<std::vector<std::int64_t>> read(const PackedPositions& packed, int vertices) {
  Reader reader{closed(packed)};
  std::vector<std::vector<std::int64_t>> frames;
  for (int f = 0; f < packed.frames; ++f) {
    std::vector<std::int64_t> now(3 * vertices);
    for (int axis = 0; axis < 3; ++axis) {
      const bool line = reader.bit(), against_neighbour = reader.bit();
      const int k = static_cast<int>(reader.bits(5));
      std::int64_t neighbour = 0;
      for (int i = axis; i < 3 * vertices; i += 3) {
        const std::int64_t before = f > 0 ? frames[f - 1][i] : 0;
        const std::int64_t predicted = line ? 2 * before - frames.at(f - 2)[i] : before;
        neighbour = reader.number(k) + (against_neighbour ? neighbour : 0);
        now[i] = predicted + neighbour;
      }
    }
    frames.push_back(now);
  }
  CHECK((reader.at + 7) / 8 == reader.bytes.size());
  return frames;
}

// A sheet of n x n vertices that swings and falls.
PointsF sheet(int n, int frame) {
  PointsF x(n * n, 3);
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k)
      x.row(i * n + k) << 0.02f * i, 1 - 0.003f * frame + 0.05f * std::sin(0.3f * i + 0.2f * frame), 0.02f * k;
  return x;
}

}  // namespace

TEST_CASE("packed positions: every frame comes back to half a step", "[view]") {
  constexpr int n = 20, frames = 12;
  PackedPositions packed;
  packed.step = grid_step(sheet(n, 0));
  CHECK(packed.step <= 1e-4);
  for (int f = 0; f < frames; ++f) append(packed, sheet(n, f));
  const auto found = read(packed, n * n);
  REQUIRE(found.size() == frames);
  for (int f = 0; f < frames; ++f) {
    const PointsF x = sheet(n, f);
    double worst = 0;
    for (Eigen::Index i = 0; i < x.size(); ++i)
      worst = std::max(worst, std::abs(static_cast<double>(found[f][i]) * packed.step - x.data()[i]));
    CHECK(worst <= 0.5001 * packed.step);
  }
  // Less than half of two bytes a number.
  CHECK(packed.bytes.size() < 3 * n * n * frames);
}

TEST_CASE("packed positions: jumps, far vertices and what is not finite come back or are named", "[view]") {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> anywhere(-3000, 3000);
  PackedPositions packed;
  packed.step = 1e-4;
  std::vector<PointsF> frames;
  for (int f = 0; f < 6; ++f) {
    PointsF x = PointsF::Constant(7, 3, 0.25f);
    x.row(f) << anywhere(random), anywhere(random), anywhere(random);
    if (f == 3) x(2, 1) = std::numeric_limits<float>::quiet_NaN();
    if (f == 4) x(0, 0) = 1e9f;
    frames.push_back(x);
    append(packed, x);
  }
  CHECK(packed.absent == std::vector<std::vector<int>>{{}, {}, {}, {2}, {0}, {}});
  const auto found = read(packed, 7);
  for (int f = 0; f < 6; ++f)
    for (int v = 0; v < 7; ++v) {
      if (std::ranges::find(packed.absent[f], v) != packed.absent[f].end()) continue;
      for (int k = 0; k < 3; ++k)
        CHECK(std::abs(static_cast<double>(found[f][3 * v + k]) * packed.step - frames[f](v, k)) <= 5.1e-5);
    }
}

TEST_CASE("packed positions: what is small may lie or move far away", "[view]") {
  for (const auto& [place, way] : {std::pair(0.f, 90.f), std::pair(3000.f, 0.f), std::pair(-90000.f, 1000.f)}) {
    PackedPositions packed;
    std::vector<PointsF> frames;
    for (int f = 0; f < 3; ++f) {
      PointsF x(2, 3);
      x << place, 0, 0, place, 0.001f, 0;
      x.col(0).array() += way * static_cast<float>(f) / 2;
      frames.push_back(x);
      if (f == 0) packed.step = grid_step(x);
      append(packed, x);
    }
    INFO(place << " " << way);
    CHECK(packed.absent == std::vector<std::vector<int>>(3));
    const auto found = read(packed, 2);
    for (int f = 0; f < 3; ++f)
      for (Eigen::Index i = 0; i < 6; ++i)
        CHECK(std::abs(static_cast<double>(found[f][i]) * packed.step - frames[f].data()[i]) <= 5.1e-5);
  }
}

TEST_CASE("packed positions: the grid is as fine as the surface is small", "[view]") {
  CHECK(grid_step(PointsF::Zero(3, 3)) == 1e-4);
  CHECK(grid_step(PointsF::Constant(2, 3, INFINITY)) == 1e-4);
  PointsF x = PointsF::Zero(2, 3);
  x(1, 2) = 0.01f;
  CHECK(grid_step(x) == Approx(0.01 / 32768));
  x(1, 2) = 100;
  CHECK(grid_step(x) == 1e-4);
  x(1, 2) = 0.001f;
  CHECK(grid_step(x) == 1e-7);
  PackedPositions empty;
  empty.step = 1e-4;
  append(empty, PointsF(0, 3));
  CHECK(empty.frames == 1);
}

}  // namespace selvedge::test_packed_positions
