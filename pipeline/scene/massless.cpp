#include "pipeline/scene/massless.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "collision/geometry/distance.hpp"

namespace selvedge {
namespace {

constexpr double without_area = 1e-6;  // altitude of a triangle, in its longest edges

bool has_area(const RestTriangle& triangle) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, (triangle.col(k) - triangle.col((k + 1) % 3)).norm());
  return smallest_altitude(triangle) > without_area * longest;
}

// For each vertex the triangles that have it.
std::vector<std::vector<int>> triangles_round(const Triangles& triangles, Eigen::Index vertices) {
  std::vector<std::vector<int>> round(static_cast<std::size_t>(vertices));
  for (int t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) round[triangles(t, k)].push_back(t);
  return round;
}

// The triangles with area that the vertex reaches through triangles without.
std::vector<int> joined_to(int vertex, const Triangles& triangles, const std::vector<std::vector<int>>& round,
                           const std::vector<char>& sound, const std::vector<char>& massless) {
  std::vector<int> reached{vertex}, found;
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const int t : round[reached[i]]) {
      if (sound[t]) found.push_back(t);
      for (int k = 0; k < 3 && massless[reached[i]]; ++k)
        if (const int next = triangles(t, k); std::ranges::find(reached, next) == reached.end())
          reached.push_back(next);
    }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::optional<Follower> follower_of(int vertex, const Triangles& triangles, const std::vector<int>& candidates,
                                    const Points& rest) {
  std::optional<Follower> best;
  double nearest = std::numeric_limits<double>::infinity();
  for (const int t : candidates) {
    const std::array<int, 3> of{triangles(t, 0), triangles(t, 1), triangles(t, 2)};
    const Closest found = point_triangle(row(rest, vertex), row(rest, of[0]), row(rest, of[1]), row(rest, of[2]));
    if (!(found.squared_distance < nearest)) continue;
    nearest = found.squared_distance;
    best = Follower{vertex, of, -found.weights.tail<3>()};
  }
  return best;
}

void keep_triangles(const std::vector<char>& kept, ClothPart& part) {
  Mesh& mesh = part.mesh;
  Eigen::Index next = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    if (!kept[static_cast<std::size_t>(t)]) continue;
    mesh.triangles.row(next) = mesh.triangles.row(t);
    if (mesh.uv_triangles.rows() > 0) mesh.uv_triangles.row(next) = mesh.uv_triangles.row(t);
    part.rest_triangle[static_cast<std::size_t>(next)] = part.rest_triangle[static_cast<std::size_t>(t)];
    ++next;
  }
  mesh.triangles.conservativeResize(next, 3);
  if (mesh.uv_triangles.rows() > 0) mesh.uv_triangles.conservativeResize(next, 3);
  part.rest_triangle.resize(static_cast<std::size_t>(next));
}

class FollowingStepper final : public Stepper {
 public:
  FollowingStepper(const Scene& scene, std::vector<Follower> followers, std::unique_ptr<Stepper> stepper)
      : followers_(std::move(followers)), stepper_(std::move(stepper)) {
    for (const Follower& one : followers_)
      pins_.push_back(static_cast<int>(std::ranges::lower_bound(scene.pins, one.vertex) - scene.pins.begin()));
  }
  const StepperTraits& traits() const override { return stepper_->traits(); }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) override {
    Drive held = drive;  // a pin that moves would ask for substeps
    for (std::size_t k = 0; k < pins_.size(); ++k) held.pins.row(pins_[k]) = from.x.row(followers_[k].vertex);
    StepReport report = stepper_->step(from, held, dt, to, extras);
    if (report.status != StepStatus::accepted) return report;
    for (const Follower& one : followers_) {
      follow(one, to.x);
      follow(one, to.v);
      for (MemoryBlock& block : to.memory)
        if (block.positions && block.rows_of == RowsOf::vertices) block.rows.row(one.vertex) = to.x.row(one.vertex);
    }
    return report;
  }

 private:
  static void follow(const Follower& one, Points& rows) {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 3; ++k) sum += one.weights[k] * row(rows, one.of[static_cast<std::size_t>(k)]);
    rows.row(one.vertex) = sum.transpose();
  }

  std::vector<Follower> followers_;
  std::vector<int> pins_;  // of each follower: its row in Scene::pins
  std::unique_ptr<Stepper> stepper_;
};

}  // namespace

void leave_out_massless(ClothPart& part, std::vector<std::string>& warnings) {
  const Triangles triangles = part.mesh.triangles;
  std::vector<char> sound, massless(static_cast<std::size_t>(part.rest.rows()), 1);
  for (const RestTriangle& triangle : part.rest_triangle) sound.push_back(has_area(triangle));
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      if (sound[static_cast<std::size_t>(t)]) massless[triangles(t, k)] = 0;
  std::vector<char> kept(sound.size());
  int left_out = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    bool at_massless = false;
    for (int k = 0; k < 3; ++k) at_massless = at_massless || massless[triangles(t, k)];
    kept[static_cast<std::size_t>(t)] = !at_massless;
    left_out += at_massless;
  }
  if (left_out == 0) return;
  const auto round = triangles_round(triangles, part.rest.rows());
  for (int v = 0; v < part.rest.rows(); ++v) {
    if (!massless[v] || round[v].empty()) continue;
    const std::vector<int> near = joined_to(v, triangles, round, sound, massless);
    if (const auto found = follower_of(v, triangles, near, part.rest)) part.followers.push_back(*found);
  }
  keep_triangles(kept, part);
  warnings.push_back(
      fmt::format("cloth `{}`: {} triangles of zero rest area are left out, and {} vertices without mass follow the "
                  "cloth that they were joined to by them",
                  part.name, left_out, part.followers.size()));
}

std::unique_ptr<Stepper> make_following_stepper(const Scene& scene, std::vector<Follower> followers,
                                                std::unique_ptr<Stepper> stepper) {
  return std::make_unique<FollowingStepper>(scene, std::move(followers), std::move(stepper));
}

}  // namespace selvedge
