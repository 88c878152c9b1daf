#include <catch2/catch.hpp>

#include "collision/contour/find_contours.hpp"
#include "collision/penetration/penetration_loss.hpp"
#include "tests/collision/penetration/closed_shapes.hpp"

// Meshes whose vertices lie on a small integer grid: planes coincide, vertices lie on faces, edges cross, vertices
// coincide. The topology is that of shapes that may be closed, open, or of edges with three faces.

namespace selvedge::test_penetration_grid {

using namespace closed;

namespace {

struct Counts {
  long contours = 0, enclosed = 0, open = 0, not_orientable = 0, unassigned = 0;
  long stray_ends = 0, untraced = 0, not_finite = 0;
};

Solid random_mesh(std::mt19937& random) {
  std::uniform_int_distribution<int> coordinate(0, 4), kind(0, 5);
  std::vector<Solid> parts;
  for (int p = std::uniform_int_distribution<int>(1, 3)(random); p > 0; --p) {
    switch (kind(random)) {
      case 0:
        parts.push_back(ball(0));
        break;
      case 1:
        parts.push_back(box(Vec3::Zero(), Vec3::Ones()));
        break;
      case 2:
        parts.push_back(rings(4, 4, [](int, double) { return Vec3(0, 0, 0); }));
        break;
      case 3: {
        Solid soup{Points(7, 3), Triangles(6, 3)};
        for (int t = 0; t < 6; ++t) {
          const int a = std::uniform_int_distribution<int>(0, 6)(random);
          soup.triangles.row(t) << a, (a + 1 + t % 2) % 7, (a + 4 + t % 3) % 7;
        }
        parts.push_back(soup);
        break;
      }
      default:
        parts.push_back(tetrahedron({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}));
    }
  }
  Solid solid = parts.front();
  for (std::size_t p = 1; p < parts.size(); ++p) solid = both(solid, parts[p]);
  for (double& x : solid.x.reshaped()) x = coordinate(random);
  return solid;
}

void check_mesh(const Solid& solid, RegionRule rule, Counts& counts) {
  const ClosedSurface closed = close_surface(solid.surface());
  const Points x = closed_positions(closed, solid.x);
  const SheetView sheet{&closed.surface, &x};
  const Segments segments = penetration_segments(closed, find_segments(std::span(&sheet, 1)));
  const std::vector<Contour> contours = trace_contours(std::span(&sheet, 1), segments);
  std::size_t traced = 0;
  for (const Contour& contour : contours) {
    traced += contour.segments.size();
    // A path ends at a loop vertex, at the rim of a garment, or at an edge with three triangles.
    for (int end = 0; end < 2 && !contour.closed; ++end) {
      if (contour.ends[end] != ContourEnd::boundary) continue;
      const int point = end == 0 ? contour.points.front() : contour.points.back();
      const auto [a, b] = closed.surface.edge_triangles[segments.crossings[point].edge];
      if (b >= 0 && closed.is_fan(a) == closed.is_fan(b)) ++counts.stray_ends;
    }
  }
  counts.untraced += traced != segments.segments.size();
  const Penetration found = find_penetration(closed, x, segments, contours, {rule, SmallerSide::faces});
  for (const ContourVolume contour : found.contours) {
    ++counts.contours;
    counts.enclosed += contour == ContourVolume::enclosed;
    counts.open += contour == ContourVolume::open;
    counts.not_orientable += contour == ContourVolume::not_orientable;
    counts.unassigned += contour == ContourVolume::unassigned;
  }
  for (const CrossingMotion motion : {CrossingMotion::exact, CrossingMotion::frozen_on_edge}) {
    Points gradient;
    const double value = penetration_loss(closed, x, found, {PenetrationMeasure::volume, motion, 1}, &gradient);
    counts.not_finite += !std::isfinite(value) || !gradient.allFinite();
  }
}

// Meshes `first` and later of a seed.
Counts check_meshes(int first, int count, unsigned seed) {
  std::mt19937 random(seed);
  Counts counts;
  for (int i = 0; i < first + count; ++i) {
    const Solid solid = random_mesh(random);
    if (i < first) continue;
    check_mesh(solid, i % 2 ? RegionRule::single : RegionRule::parity, counts);
  }
  return counts;
}

void report(const Counts& c) {
  CHECK(c.stray_ends == 0);
  CHECK(c.untraced == 0);
  CHECK(c.not_finite == 0);
  CHECK(c.contours > 0);
  CHECK(c.enclosed > c.contours / 4);
  WARN("contours " << c.contours << ": enclosed " << c.enclosed << ", open " << c.open << ", not orientable "
                   << c.not_orientable << ", unassigned " << c.unassigned);
}

}  // namespace

TEST_CASE("penetration: degenerate meshes on an integer grid", "[penetration]") { report(check_meshes(0, 1000, 1)); }

TEST_CASE("penetration: a plane between garments that ends in faces without area pulls nothing", "[penetration]") {
  for (const int mesh : {2586, 4567}) CHECK(check_meshes(mesh, 1, 2).not_finite == 0);
}

TEST_CASE("penetration: a hundred thousand degenerate meshes", "[penetration][.long]") {
  report(check_meshes(0, 100000, 2));
}

}  // namespace selvedge::test_penetration_grid
