#include "collision/distance/exposed_faces.hpp"

#include <algorithm>

#include "collision/contour/segments.hpp"
#include "collision/distance/pseudonormals.hpp"
#include "collision/geometry/corners.hpp"
#include "collision/geometry/disjoint_sets.hpp"

namespace selvedge {
namespace {

using Polygon = std::vector<Vec3>;
using Crossed = std::vector<std::vector<int>>;  // for each triangle those that cross it

constexpr double just_outside = 1e-9;  // of the surface's size

Crossed crossed_triangles(const Surface& surface, const Segments& found) {
  Crossed by(static_cast<std::size_t>(surface.triangles.rows()));
  for (const Segment& segment : found.segments) {
    by[segment.triangle[0]].push_back(segment.triangle[1]);
    by[segment.triangle[1]].push_back(segment.triangle[0]);
  }
  return by;
}

// Cuts each convex polygon that the plane through p crosses in two.
void cut_polygons(const Vec3& p, const Vec3& normal, std::vector<Polygon>& polygons) {
  std::vector<Polygon> parts;
  for (const Polygon& polygon : polygons) {
    Polygon below, above;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 &at = polygon[i], &next = polygon[(i + 1) % polygon.size()];
      const double here = normal.dot(at - p), there = normal.dot(next - p);
      if (here <= 0) below.push_back(at);
      if (here >= 0) above.push_back(at);
      if ((here < 0 && there > 0) || (here > 0 && there < 0)) {
        const Vec3 between = at + here / (here - there) * (next - at);
        below.push_back(between);
        above.push_back(between);
      }
    }
    if (below.size() > 2) parts.push_back(std::move(below));
    if (above.size() > 2) parts.push_back(std::move(above));
  }
  polygons = std::move(parts);
}

std::vector<Polygon> cut_triangle(const Surface& surface, const Points& x, int t, const std::vector<int>& by) {
  std::vector<Polygon> polygons{
      {row(x, surface.triangles(t, 0)), row(x, surface.triangles(t, 1)), row(x, surface.triangles(t, 2))}};
  for (const int other : by)
    if (const Vec3 normal = face_normal(surface, x, other); !normal.isZero(0))
      cut_polygons(row(x, surface.triangles(other, 0)), normal, polygons);
  return polygons;
}

Vec3 mean_of(const Polygon& polygon) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& corner : polygon) sum += corner;
  return sum / static_cast<double>(polygon.size());
}

// Sets of triangles without crossings, connected by edges, with the largest triangle of each.
struct Regions {
  std::vector<int> of_triangle;  // -1: crossed
  std::vector<int> largest;
};

Regions find_regions(const Surface& surface, const Points& x, const Crossed& crossed) {
  const int count = static_cast<int>(surface.triangles.rows());
  DisjointSets sets(count);
  for (const auto& pair : surface.edge_triangles)
    if (pair[1] >= 0 && crossed[pair[0]].empty() && crossed[pair[1]].empty()) sets.join(pair[0], pair[1]);
  Regions regions{sets.numbers(), std::vector<int>(static_cast<std::size_t>(sets.count()), -1)};
  std::vector<double> area(regions.largest.size(), -1);
  for (int t = 0; t < count; ++t) {
    if (!crossed[t].empty()) {
      regions.of_triangle[t] = -1;
      continue;
    }
    const double size = twice_area(surface.triangles, x, t).squaredNorm();
    const int region = regions.of_triangle[t];
    if (size > area[region]) {
      area[region] = size;
      regions.largest[region] = t;
    }
  }
  return regions;
}

// One polygon of a crossed triangle, or the largest triangle of a region.
struct Sample {
  int triangle;
  Polygon polygon;  // empty: the whole triangle
};

void add_pieces(const Sample& sample, ExposedFaces& faces) {
  for (std::size_t i = 2; i < sample.polygon.size(); ++i)
    faces.pieces.push_back({sample.polygon[0], sample.polygon[i - 1], sample.polygon[i]});
}

ExposedFaces classify(const Surface& surface, const Points& x, const Crossed& crossed, const Regions& regions,
                      double step, const WindsRound& winds_round) {
  std::vector<Sample> samples;
  for (const int t : regions.largest)
    if (t >= 0) samples.push_back({t, {}});
  const std::size_t first_piece = samples.size();
  for (int t = 0; t < static_cast<int>(crossed.size()); ++t)
    if (!crossed[t].empty())
      for (Polygon& polygon : cut_triangle(surface, x, t, crossed[t])) samples.push_back({t, std::move(polygon)});

  Points at(static_cast<Eigen::Index>(samples.size()), 3);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto [a, b, c] = corners_of(surface, x, samples[i].triangle);
    const Vec3 middle = mean_of(samples[i].polygon.empty() ? Polygon{a, b, c} : samples[i].polygon);
    at.row(static_cast<Eigen::Index>(i)) = (middle + step * face_normal(surface, x, samples[i].triangle)).transpose();
  }
  const std::vector<char> covered = winds_round(at);

  ExposedFaces faces;
  std::vector<char> region_hidden(regions.largest.size(), false);
  for (std::size_t i = 0; i < first_piece; ++i) region_hidden[regions.of_triangle[samples[i].triangle]] = covered[i];
  faces.kind.assign(crossed.size(), ExposedFaces::Kind::whole);
  faces.cut_place.assign(crossed.size(), -1);
  for (std::size_t t = 0; t < crossed.size(); ++t)
    if (crossed[t].empty() && region_hidden[regions.of_triangle[t]]) faces.kind[t] = ExposedFaces::Kind::hidden;
  for (std::size_t i = first_piece; i < samples.size(); ++i) {
    const int t = samples[i].triangle;
    if (faces.cut_place[t] < 0) {
      faces.cut_place[t] = static_cast<int>(faces.piece_begin.size());
      faces.piece_begin.push_back(static_cast<int>(faces.pieces.size()));
      faces.kind[t] = ExposedFaces::Kind::hidden;
    }
    if (covered[i]) continue;
    faces.kind[t] = ExposedFaces::Kind::cut;
    add_pieces(samples[i], faces);
  }
  faces.piece_begin.push_back(static_cast<int>(faces.pieces.size()));
  return faces;
}

}  // namespace

ExposedFaces find_exposed(const Surface& surface, const Points& x, const Bvh& tree, const QuietParts& parts,
                          const WindsRound& winds_round) {
  const SheetView sheet{&surface, &x, &tree, &parts.quiet};
  const Segments found = find_segments(std::span(&sheet, 1));
  const Crossed crossed = crossed_triangles(surface, found);
  const Regions regions = find_regions(surface, x, crossed);
  if (found.segments.empty() && regions.largest.size() < 2) return {};
  const Vec3 size = x.colwise().maxCoeff() - x.colwise().minCoeff();
  ExposedFaces faces = classify(surface, x, crossed, regions, just_outside * size.norm(), winds_round);
  if (std::ranges::none_of(faces.kind, [](auto kind) { return kind != ExposedFaces::Kind::hidden; })) return {};
  if (std::ranges::all_of(faces.kind, [](auto kind) { return kind == ExposedFaces::Kind::whole; })) return {};
  faces.hidden.resize(faces.kind.size());
  std::ranges::transform(faces.kind, faces.hidden.begin(),
                         [](auto kind) { return kind == ExposedFaces::Kind::hidden; });
  return faces;
}

}  // namespace selvedge
