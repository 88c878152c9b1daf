#include <fmt/format.h>

#include <algorithm>

#include "pipeline/drapes/drape_stages.hpp"

namespace selvedge {
namespace {

// A point drawn on a surface, uniformly by area. `areas` are running sums.
struct SurfacePoint {
  Vec3 at, normal;
};
SurfacePoint draw_on(const Points& x, const Triangles& triangles, const std::vector<double>& areas,
                     RandomStream& random) {
  const auto found = std::ranges::lower_bound(areas, random.uniform() * areas.back());
  const auto t = static_cast<Eigen::Index>(std::min<std::ptrdiff_t>(found - areas.begin(), std::ssize(areas) - 1));
  const Vec3 a = row(x, triangles(t, 0)), b = row(x, triangles(t, 1)), c = row(x, triangles(t, 2));
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return {a + u * (b - a) + v * (c - a), (b - a).cross(c - a).normalized()};
}

std::vector<double> running_areas(const Points& x, const Triangles& triangles) {
  std::vector<double> sums;
  double sum = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Vec3 a = row(x, triangles(t, 0));
    sum += (row(x, triangles(t, 1)) - a).cross(row(x, triangles(t, 2)) - a).norm();
    sums.push_back(sum);
  }
  return sums;
}

Vec3 noise_of(double deviation, RandomStream& random) {
  Vec3 noise;
  for (double& value : noise) value = deviation * random.normal();
  return noise;
}

// The samples on which errors are printed. They are the same at each call.
DistanceSamples samples_to_watch(const DistanceOptions& options, const DrapeLessons& lessons,
                                 const std::vector<std::unique_ptr<DrapeBody>>& bodies, std::size_t most_bodies) {
  RandomStream random = stream_of(7, 0);
  DistanceSamples samples;
  constexpr int points = 96;
  for (std::size_t k = 0; k < bodies.size() && k < most_bodies; ++k)
    add_distance_samples(options, lessons, *bodies[k], points, random, samples);
  return samples;
}

}  // namespace

void add_distance_samples(const DistanceOptions& options, const DrapeLessons& lessons, const DrapeBody& body,
                          int points, RandomStream& random, DistanceSamples& samples) {
  const DrapeWorld& world = lessons.set->world;
  const Points &skin = body.sample.body, &cloth = body.sample.drape.truth;
  const std::vector<double> skin_areas = running_areas(skin, world.body_surface.triangles);
  const std::vector<double> cloth_areas = running_areas(cloth, world.surface.triangles);
  const auto first = samples.points.rows();
  samples.points.conservativeResize(first + points, 3);
  samples.normals.conservativeResize(first + points, 3);
  for (int k = 0; k < points; ++k) {
    const bool exact = k % 6 == 0;
    Vec3 at, normal = Vec3::Zero();
    if (k % 3 == 0) {
      const SurfacePoint drawn = draw_on(skin, world.body_surface.triangles, skin_areas, random);
      at = drawn.at;
      if (exact) normal = drawn.normal;
    } else if (k % 3 == 1) {
      at = draw_on(cloth, world.surface.triangles, cloth_areas, random).at;
    } else {
      for (double& value : at) value = options.box * (random.uniform() - 0.5);
    }
    if (k % 3 != 2 && k % 2 == 1) at += noise_of(options.noise, random);
    samples.points.row(first + k) = at.transpose();
    samples.normals.row(first + k) = normal.transpose().cast<float>();
    samples.on_surface.push_back(exact);
    samples.body.push_back(static_cast<int>(samples.queries.size()));
  }
  samples.queries.push_back(body.query);
  samples.conditions.conservativeResize(static_cast<Eigen::Index>(samples.queries.size()),
                                        static_cast<Eigen::Index>(body.condition.size()));
  samples.conditions.bottomRows(1) =
      Eigen::Map<const Eigen::RowVectorXf>(body.condition.data(), static_cast<Eigen::Index>(body.condition.size()));
  const Points own = samples.points.bottomRows(points);
  for (const SignedDistance& found : body.field->ask(own)) samples.distance.push_back(static_cast<float>(found.value));
}

PlainNetwork make_distance_network(const DrapeTrainingOptions& options, const DrapeLessons& lessons) {
  const DrapeBody& any = *lessons.training.front();
  NeuralDistanceShape shape;
  shape.query = any.query.size();
  shape.condition = static_cast<int>(any.condition.size());
  shape.layers = options.distance.layers;
  shape.width = options.distance.width;
  shape.beta = options.distance.beta;
  shape.again_layer = std::min(3, options.distance.layers - 1);
  return make_neural_distance(shape, options.seed + 200);
}

DistanceErrors distance_errors_of(const DistanceOptions& options, const DrapeLessons& lessons,
                                  const PlainNetwork& network) {
  return distance_errors(network, samples_to_watch(options, lessons, lessons.test, 64));
}

std::string distance_text(const DistanceOptions& options, const DrapeLessons& lessons, const PlainNetwork& network) {
  const DistanceErrors errors = distance_errors_of(options, lessons, network);
  const double queries = lessons.set->world.surface.vertex_count;
  return fmt::format(
      "distances by a network of {} numbers on the bodies to measure on: mean error {:.2f} mm, {:.2f} mm within 5 cm "
      "of the surface (of these {:.1f} % on the wrong side), relative {:.1f} %; {:.3f} GFLOP forward for {:.0f} "
      "vertices\n",
      parameter_count(network), 1e3 * errors.absolute, 1e3 * errors.near, errors.wrong_side, errors.relative,
      1e-9 * forward_operations(network, queries), queries);
}

TrainingStage distance_stage(const DrapeTrainingOptions& options, DrapeLessons& lessons, PlainNetwork& network) {
  auto adam = std::make_shared<PlainAdam>();
  auto sums = std::make_shared<std::array<double, 5>>();
  TrainingStage stage{
      "distance", options.distance.stage, "value,surface_gradient,eikonal,bad,error_mm,near_mm,relative_error", {}, {},
      {}};
  stage.step = [=, own = options.distance, &lessons, &network](double rate, RandomStream& random,
                                                               bool shown) -> std::string {
    DistanceSamples samples;
    for (int k = 0; k < own.bodies; ++k)
      add_distance_samples(
          own, lessons,
          *lessons.training[static_cast<std::size_t>(random.below(static_cast<int>(lessons.training.size())))],
          own.points, random, samples);
    const DistanceLosses losses = distance_losses(network, samples, {});
    adam->rate = rate;
    (*sums)[3] += !take_step(*adam, losses.gradient, network);
    (*sums)[0] += losses.value;
    (*sums)[1] += losses.surface_gradient;
    (*sums)[2] += losses.eikonal;
    ++(*sums)[4];
    if (!shown) return "";
    const DistanceErrors errors = distance_errors(network, samples_to_watch(own, lessons, lessons.validation, 8));
    const double n = (*sums)[4];
    std::string line =
        fmt::format("{:.6g},{:.6g},{:.6g},{},{:.4f},{:.4f},{:.2f}", (*sums)[0] / n, (*sums)[1] / n, (*sums)[2] / n,
                    static_cast<int>((*sums)[3]), 1e3 * errors.absolute, 1e3 * errors.near, errors.relative);
    sums->fill(0);
    return line;
  };
  stage.state = [=, &network] {
    StageFile file;
    file.parts.push_back({"distance", network, *adam});
    return file;
  };
  stage.restore = [=, &network](const StageFile& file) {
    if (const StagePart* part = file.find("distance")) {
      network = part->network;
      *adam = part->adam;
    }
  };
  return stage;
}

}  // namespace selvedge
