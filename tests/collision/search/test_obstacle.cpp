#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "collision/search/intersections.hpp"
#include "collision/search/obstacle.hpp"
#include "tests/collision/tangles.hpp"

namespace selvedge::test_obstacle {

using testing::Tangle;
using testing::tangles;

TEST_CASE("obstacle: FCL finds the same pairs where nothing hangs on rounding, also after a refit", "[obstacle]") {
  if (!obstacle_available()) {
    WARN("skipped: this build has no FCL");
    CHECK_THROWS_AS(ObstacleModel(Triangles(0, 3), Points(0, 3)), Error);
    return;
  }
  int pairs = 0;
  for (Tangle m : tangles(10)) {
    if (m.name != "crumpled" && m.name != "crushed" && m.name != "dented tube" && m.name != "wavy") continue;
    INFO(m.name);
    ObstacleModel model(m.surface.triangles, m.x);
    for (unsigned k = 0; k < 3; ++k) {
      testing::shake(m.x, 0.02 * k, k);
      model.refit(m.x);
      IntersectionCache cache;
      const auto ours = intersecting_pairs(m.surface, m.x, cache);
      pairs += static_cast<int>(ours.size());
      CHECK(obstacle_self_pairs(model, m.surface.triangles) == ours);
    }
  }
  CHECK(pairs > 1000);
}

TEST_CASE("obstacle: garment against body", "[obstacle]") {
  if (!obstacle_available()) {
    WARN("skipped: this build has no FCL");
    return;
  }
  const Tangle body = testing::tube(20, 6, 0.3, 1);
  Tangle garment = testing::tube(24, 8, 0.35, 0.8);
  const ObstacleModel body_model(body.surface.triangles, body.x);
  CHECK(collision_free(ObstacleModel(garment.surface.triangles, garment.x), body_model));
  garment.x.col(0).array() += 0.1;
  const ObstacleModel moved(garment.surface.triangles, garment.x);
  CHECK_FALSE(collision_free(moved, body_model));
  IntersectionCache cache_a, cache_b;
  const auto ours = intersecting_pairs(garment.surface, garment.x, cache_a, body.surface, body.x, cache_b);
  CHECK_FALSE(ours.empty());
  CHECK(obstacle_pairs(moved, body_model) == ours);
  const ObstacleModel nothing(Triangles(0, 3), Points(0, 3));
  CHECK(collision_free(nothing, body_model));
}

}  // namespace selvedge::test_obstacle
