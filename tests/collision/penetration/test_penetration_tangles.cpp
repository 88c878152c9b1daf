#include <catch2/catch.hpp>

#include "collision/penetration/penetration_loss.hpp"
#include "tests/collision/penetration/closed_shapes.hpp"

// Garments with two and four holes, tangled by smooth random displacements, so that many of their parts go through each
// other, three at a place among them.

namespace selvedge::test_penetration_tangles {

using namespace closed;

namespace {

// A sum of waves.
class Displacement {
 public:
  Displacement(std::mt19937& random, double size) {
    std::normal_distribution<double> normal;
    const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
    for (int i = 0; i < 6; ++i) waves_.push_back({6 * any(), size * any(), 3 * normal(random)});
  }
  Vec3 at(const Vec3& x) const {
    Vec3 sum = Vec3::Zero();
    for (const Wave& wave : waves_) sum += wave.by * std::sin(wave.number.dot(x) + wave.phase);
    return sum;
  }

 private:
  struct Wave {
    Vec3 number, by;
    double phase;
  };
  std::vector<Wave> waves_;
};

Solid tangle(std::mt19937& random) {
  const double size = std::uniform_real_distribution<double>(0.05, 0.12)(random);
  Solid solid =
      rings(36, 36, [](int j, double angle) { return Vec3(0.25 * std::cos(angle), 0.2 * std::sin(angle), 0.03 * j); });
  if (random() % 2 == 0)
    solid = both(solid, rings(30, 30, [](int j, double angle) {
                   return Vec3(0.3 * std::cos(angle), 0.24 * std::sin(angle), 0.035 * j);
                 }));
  const Displacement displacement(random, size);
  for (int v = 0; v < solid.x.rows(); ++v) solid.x.row(v) += displacement.at(row(solid.x, v)).transpose();
  return solid;
}

struct TangleCounts {
  int tangles = 0, contours = 0, enclosed = 0, open = 0, unassigned = 0, imbalanced = 0;
};

TangleCounts count_tangles(int wanted, unsigned seed) {
  std::mt19937 random(seed);
  TangleCounts counts;
  while (counts.tangles < wanted) {
    const Solid solid = tangle(random);
    const ClosedSurface closed = close_surface(solid.surface());
    const Points x = closed_positions(closed, solid.x);
    const Penetration found = find_penetration(closed, x);
    if (found.contours.empty()) continue;
    ++counts.tangles;
    for (const ContourVolume contour : found.contours) {
      ++counts.contours;
      counts.enclosed += contour == ContourVolume::enclosed;
      counts.open += contour == ContourVolume::open;
      counts.unassigned += contour == ContourVolume::unassigned;
    }
    // What is closed does not push itself away.
    Points gradient;
    penetration_loss(closed, x, found, {}, &gradient);
    counts.imbalanced += gradient.colwise().sum().norm() > 1e-7 * gradient.rowwise().norm().sum();
  }
  return counts;
}

// What ends at two holes of one garment stays open; of few tangles that may be more than 2 %.
void check_tangles(const TangleCounts& c, double least_enclosed) {
  WARN(c.tangles << " tangles, " << c.contours << " contours: " << c.enclosed << " enclosed, " << c.open << " open, "
                 << c.unassigned << " unassigned; " << c.imbalanced << " with a net push");
  CHECK(c.imbalanced == 0);
  CHECK(c.unassigned == 0);
  CHECK(c.enclosed >= least_enclosed * c.contours);
}

}  // namespace

TEST_CASE("penetration: contours of tangled garments get a volume", "[penetration]") {
  check_tangles(count_tangles(12, 1), 0.96);
}

TEST_CASE("penetration: contours of a thousand tangled garments get a volume", "[penetration][.long]") {
  check_tangles(count_tangles(1000, 2), 0.98);
}

}  // namespace selvedge::test_penetration_tangles
