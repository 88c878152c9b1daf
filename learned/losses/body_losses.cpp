#include "learned/losses/body_losses.hpp"

#include <cmath>

#include "learned/graph/nearest_faces.hpp"

namespace selvedge {
namespace {

// The friction's c |t| and its derivative by t.
struct Slide {
  double value = 0;
  Vec3 slope = Vec3::Zero();
};

Slide slide_of(const Vec3& t, SlopeAxis axis) {
  constexpr double least = 1e-4;  // keeps the slope of the root finite
  const double length = t.norm();
  if (!(length > 0)) return {};
  const Vec3 along = t / length, up = Vec3::Unit(static_cast<int>(axis));
  const double cosine = along.dot(up), part = 1 - cosine * cosine;
  const double factor = std::sqrt(std::abs(part) + least);
  const double turning = (part < 0 ? cosine : -cosine) / factor;
  return {factor * length, factor * along + turning * (up - cosine * along)};
}

int vertices_in(const std::array<int, 3>& sample) { return sample[1] < 0 ? 1 : sample[2] < 0 ? 2 : 3; }

// Samples with a massless vertex take part in no loss.
bool has_mass(const LossGarment& garment, const std::array<int, 3>& sample) {
  for (int i = 0; i < vertices_in(sample); ++i)
    if (!(garment.mass[static_cast<std::size_t>(sample[static_cast<std::size_t>(i)])] > 0)) return false;
  return true;
}

}  // namespace

std::vector<std::array<int, 3>> cloth_samples(const LossGarment& garment, ClothSamples which) {
  std::vector<std::array<int, 3>> samples;
  const Surface& surface = garment.surface;
  for (int v = 0; v < surface.vertex_count; ++v) samples.push_back({v, -1, -1});
  if (which != ClothSamples::vertices)
    for (const auto& ends : surface.edges.rowwise()) samples.push_back({ends[0], ends[1], -1});
  if (which == ClothSamples::faces)
    for (const auto& corners : surface.triangles.rowwise()) samples.push_back({corners[0], corners[1], corners[2]});
  return samples;
}

Points sample_points(const std::vector<std::array<int, 3>>& samples, const Points& x) {
  Points at(static_cast<Eigen::Index>(samples.size()), 3);
  for (Eigen::Index k = 0; k < at.rows(); ++k) {
    const std::array<int, 3>& of = samples[static_cast<std::size_t>(k)];
    const int count = vertices_in(of);
    at.row(k) = x.row(of[0]);
    for (int i = 1; i < count; ++i) at.row(k) += x.row(of[static_cast<std::size_t>(i)]);
    at.row(k) /= count;
  }
  return at;
}

double collision_loss(const LossGarment& garment, const CollisionLoss& options, const std::vector<int>& face,
                      const Surface& body, const Points& body_next, const Points& x, Points* gradient) {
  const bool cubic = options.penalty == DepthPenalty::cubic;
  const std::vector<std::array<int, 3>> samples = cloth_samples(garment, options.samples);
  const Points points = sample_points(samples, x);
  double sum = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (face[k] < 0 || !has_mass(garment, samples[k])) continue;
    const CentroidPlane plane = centroid_plane(body, body_next, face[k]);
    if (!plane.has_area()) continue;
    const double depth = options.thickness - (row(points, static_cast<int>(k)) - plane.centroid).dot(plane.normal);
    if (!(depth > 0)) continue;
    sum += cubic ? depth * depth * depth : 0.5 * depth * depth;
    if (!gradient) continue;
    const int count = vertices_in(samples[k]);
    const Vec3 push = (cubic ? 3 * depth * depth : depth) / count * plane.normal;
    for (int i = 0; i < count; ++i) gradient->row(samples[k][static_cast<std::size_t>(i)]) -= push.transpose();
  }
  return sum;
}

double friction_loss(const LossGarment& garment, const FrictionLoss& options, double strength,
                     const std::vector<int>& before, const std::vector<int>& after, const Surface& body,
                     const Points& body_previous, const Points& body_now, const Points& now, const Points& x,
                     Points* gradient) {
  double sum = 0;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const auto at = static_cast<std::size_t>(v);
    const double grip = garment.mass[at] * options.coefficient * strength;
    if (before[at] < 0 || after[at] < 0 || !(grip > 0)) continue;
    const CentroidPlane start = centroid_plane(body, body_previous, before[at]);
    const CentroidPlane moved = centroid_plane(body, body_now, before[at]),
                        end = centroid_plane(body, body_now, after[at]);
    const Vec3 p = now.row(v).transpose(), q = x.row(v).transpose();
    if (!((p - start.centroid).squaredNorm() < options.squared_radius) ||
        !((q - end.centroid).squaredNorm() < options.squared_radius) || !start.has_area() || !end.has_area())
      continue;
    const Vec3 normal = 0.5 * (start.normal + end.normal), slid = q - (p + (moved.centroid - start.centroid));
    const Slide slide = slide_of(slid - slid.dot(normal) * normal, options.slope);
    sum += grip * slide.value;
    if (gradient) gradient->row(v) += grip * (slide.slope - slide.slope.dot(normal) * normal).transpose();
  }
  return sum;
}

}  // namespace selvedge
