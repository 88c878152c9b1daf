#include "pipeline/obstacles/setup_pairs.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace selvedge {
namespace {

int nearest(const Vec3& place, std::span<const int> candidates, const Points& x) {
  const auto distance = [&](int v) { return (row(x, v) - place).squaredNorm(); };
  return *std::ranges::min_element(candidates, {}, distance);
}

}  // namespace

std::vector<std::array<int, 2>> read_pairs(const Config& section, std::span<const int> from, std::span<const int> to,
                                           const Points& x) {
  const bool listed = section["pair"].text() == "listed";
  if (listed && from.size() != to.size())
    section.fail(fmt::format("pairs {} vertices with {}", from.size(), to.size()),
                 "name as many on both sides, or write pair: nearest");
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t k = 0; k < from.size(); ++k) {
    pairs.push_back({from[k], listed ? to[k] : nearest(row(x, from[k]), to, x)});
    if (pairs[k][0] == pairs[k][1])
      section.fail(fmt::format("pairs a vertex with itself, the one at place {} of `from`", k),
                   "name different vertices in `from` and `to`");
  }
  return pairs;
}

}  // namespace selvedge
