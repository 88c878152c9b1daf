#include "pipeline/tools/check_opinion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "collision/geometry/corners.hpp"
#include "collision/geometry/counted.hpp"
#include "collision/search/obstacle.hpp"

namespace selvedge {
namespace {

using Pairs = std::vector<std::pair<int, int>>;
using Corners = std::array<Vec3, 3>;

// The corners of a triangle; `triangle` counts through all bodies.
Corners corners_in(std::span<const AuditBody> bodies, int triangle) {
  for (const AuditBody& body : bodies) {
    const int count = static_cast<int>(body.surface->triangles.rows());
    if (triangle < count) return corners_of(*body.surface, *body.points, triangle);
    triangle -= count;
  }
  return {};
}

double gap_along(const Vec3& direction, const Corners& a, const Corners& b) {
  const auto [a_lo, a_hi] = std::minmax({0.0, direction.dot(a[1] - a[0]), direction.dot(a[2] - a[0])});
  const auto [b_lo, b_hi] =
      std::minmax({direction.dot(b[0] - a[0]), direction.dot(b[1] - a[0]), direction.dot(b[2] - a[0])});
  return std::max(b_lo - a_hi, a_lo - b_hi);
}

Pairs pairs_with_bodies(const ObstacleModel& cloth, std::span<const AuditBody> bodies) {
  Pairs all;
  int first_number = 0;
  for (const AuditBody& body : bodies) {
    const ObstacleModel model(body.surface->triangles, *body.points);
    for (const auto& [t, b] : obstacle_pairs(cloth, model)) all.emplace_back(t, first_number + b);
    first_number += static_cast<int>(body.surface->triangles.rows());
  }
  std::sort(all.begin(), all.end());
  return all;
}

double size_of(const Points& x, std::span<const AuditBody> bodies) {
  double size = largest_coordinate(x);
  for (const AuditBody& body : bodies) size = std::max(size, largest_coordinate(*body.points));
  return size;
}

// The pairs of the cloth, with bodies or with itself, that only one list has.
std::vector<Disagreement> disagreements(const Surface& cloth, const Points& x, std::span<const AuditBody> bodies,
                                        const Pairs& ours, const Pairs& fcl, bool with_body) {
  Pairs other;
  std::set_symmetric_difference(ours.begin(), ours.end(), fcl.begin(), fcl.end(), std::back_inserter(other));
  const double size = size_of(x, bodies);
  std::vector<Disagreement> all;
  for (const auto& pair : other) {
    const Corners a = corners_of(cloth, x, pair.first);
    const Corners b = with_body ? corners_in(bodies, pair.second) : corners_of(cloth, x, pair.second);
    const double margin = std::abs(separation(a, b));
    all.push_back({0, pair.first, pair.second, with_body, std::binary_search(ours.begin(), ours.end(), pair), margin,
                   margin > 1e-9 * size});
  }
  return all;
}

}  // namespace

double separation(const Corners& a, const Corners& b) {
  double widest = -std::numeric_limits<double>::infinity();
  const auto try_direction = [&](const Vec3& direction) {
    const double length = direction.norm();
    if (length > 0) widest = std::max(widest, gap_along(direction / length, a, b));
  };
  const auto edge = [](const Corners& c, int k) { return Vec3(c[(k + 1) % 3] - c[k]); };
  const Vec3 normal_a = edge(a, 0).cross(edge(a, 1)), normal_b = edge(b, 0).cross(edge(b, 1));
  try_direction(normal_a);
  try_direction(normal_b);
  for (int i = 0; i < 3; ++i) {
    try_direction(edge(a, i).cross(normal_a));
    try_direction(edge(b, i).cross(normal_b));
    for (int j = 0; j < 3; ++j) try_direction(edge(a, i).cross(edge(b, j)));
  }
  return widest;
}

void add_opinion(const Surface& cloth, const Points& x, std::span<const AuditBody> bodies, const Audit& ours, int frame,
                 Opinion& opinion) {
  const ObstacleModel model(cloth.triangles, x);
  const Pairs self = obstacle_self_pairs(model, cloth.triangles);
  const Pairs with_bodies = pairs_with_bodies(model, bodies);
  opinion.pairs_by_frame.push_back(static_cast<int>(self.size() + with_bodies.size()));
  opinion.frames_against_body += !with_bodies.empty();

  std::vector<Disagreement> found = disagreements(cloth, x, bodies, ours.self_pairs, self, false);
  for (const Disagreement& d : disagreements(cloth, x, bodies, ours.obstacle_pairs, with_bodies, true))
    found.push_back(d);
  for (Disagreement& d : found) {
    d.frame = frame;
    opinion.beyond_rounding += d.beyond;
    opinion.disagreements.push_back(d);
  }
}

bool agrees_on_bodies(const Surface& cloth, const Points& x, std::span<const AuditBody> bodies, const Pairs& ours) {
  const Pairs fcl = pairs_with_bodies(ObstacleModel(cloth.triangles, x), bodies);
  return std::ranges::none_of(disagreements(cloth, x, bodies, ours, fcl, true), &Disagreement::beyond);
}

std::string opinion_text(const Opinion& o) {
  const int worst = o.pairs_by_frame.empty() ? 0 : *std::max_element(o.pairs_by_frame.begin(), o.pairs_by_frame.end());
  std::string text = fmt::format("{} in the worst frame; cloth not free of the bodies in {}", counted(worst, "pair"),
                                 counted(o.frames_against_body, "frame"));
  text += fmt::format("; {}, {} by more than rounding",
                      counted(std::ssize(o.disagreements), "pair differs", "pairs differ"), o.beyond_rounding);
  constexpr std::size_t shown = 20;
  for (std::size_t i = 0; i < std::min(shown, o.disagreements.size()); ++i) {
    const Disagreement& d = o.disagreements[i];
    text += fmt::format("\n  frame {}: triangle {} and {} {} {} (exact signs), FCL says the opposite; margin {:.2g} m",
                        d.frame, d.first, d.with_body ? "the bodies' triangle" : "triangle", d.second,
                        d.ours ? "intersect" : "do not intersect", d.margin);
  }
  if (o.disagreements.size() > shown) text += fmt::format("\n  and {} more", o.disagreements.size() - shown);
  return text;
}

}  // namespace selvedge
