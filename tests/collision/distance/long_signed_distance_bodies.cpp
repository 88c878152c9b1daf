#include <catch2/catch.hpp>

#include <ctime>
#include <random>

#include "collision/distance/signed_distance.hpp"
#include "collision/exact/inside.hpp"
#include "collision/geometry/distance.hpp"
#include "collision/geometry/parallel.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "tests/collision/solids.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::long_signed_distance_bodies {

// A million queries against brute force, and times. Hidden: minutes. Run it with "[distance_long]".

using testing::Solid;

namespace {

Solid mannequin(double elbow, double shoulder) {
  static const BodyModel model = make_mannequin();
  BodyPose pose{Points::Zero(static_cast<Eigen::Index>(model.joints.size()), 3), Vec3::Zero()};
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const auto row_of = static_cast<Eigen::Index>(j);
    if (model.joints[j] == "left_shoulder") pose.rotations.row(row_of) << 0, 0, -shoulder;
    if (model.joints[j] == "right_shoulder") pose.rotations.row(row_of) << 0, 0, shoulder;
    if (model.joints[j] == "left_elbow") pose.rotations.row(row_of) << 0, -elbow, 0;
  }
  Solid made;
  made.surface = make_surface(static_cast<int>(model.skin.rest.rows()), model.skin.triangles);
  made.x = posed(model, Eigen::VectorXd::Zero(10), pose);
  return made;
}

Points points_round(const Solid& solid, int count, double off, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal(0, 1);
  const Vec3 lo = solid.x.colwise().minCoeff(), hi = solid.x.colwise().maxCoeff();
  Points at(count, 3);
  for (int i = 0; i < count; ++i) {
    const auto t =
        static_cast<Eigen::Index>(unit(random) * 0.999999 * static_cast<double>(solid.surface.triangles.rows()));
    double u = unit(random), v = unit(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto corner = [&](int k) { return row(solid.x, solid.surface.triangles(t, k)); };
    Vec3 p = corner(0) + u * (corner(1) - corner(0)) + v * (corner(2) - corner(0));
    p += off * Vec3(normal(random), normal(random), normal(random));
    if (i % 5 == 0) p = lo + Vec3(unit(random), unit(random), unit(random)).cwiseProduct(hi - lo);
    if (i % 5 == 1) p = corner(0) + 0.3 * (i % 2) * (corner(1) - corner(0));
    at.row(i) = p.transpose();
  }
  return at;
}

// Distances by holding every point against every triangle; balls round the triangles spare most of the work.
std::vector<double> brute_distances(const Solid& solid, const Points& at) {
  const int count = static_cast<int>(solid.surface.triangles.rows());
  std::vector<Vec3> centre;
  std::vector<double> radius;
  for (int t = 0; t < count; ++t) {
    const auto corner = [&](int k) { return row(solid.x, solid.surface.triangles(t, k)); };
    centre.push_back((corner(0) + corner(1) + corner(2)) / 3);
    radius.push_back(
        std::max({(corner(0) - centre[t]).norm(), (corner(1) - centre[t]).norm(), (corner(2) - centre[t]).norm()}));
  }
  std::vector<double> result(static_cast<std::size_t>(at.rows()));
  parallel_for(static_cast<int>(at.rows()), 256, [&](int i) {
    const Vec3 p = row(at, i);
    double best = std::numeric_limits<double>::infinity();
    for (int t = 0; t < count; ++t) {
      const double beyond = best + radius[t];
      if ((p - centre[t]).squaredNorm() > beyond * beyond * (1 + 1e-9)) continue;
      const auto corner = [&](int k) { return row(solid.x, solid.surface.triangles(t, k)); };
      best = std::min(best, std::sqrt(point_triangle(p, corner(0), corner(1), corner(2)).squared_distance));
    }
    result[i] = best;
  });
  return result;
}

void hold_against_brute_force(const std::string& name, const Solid& solid, BodyShape shape, int count, double off) {
  DistanceField field(solid.surface, shape);
  field.move_to(solid.x);
  const Points at = points_round(solid, count, off, 9);
  const std::vector<SignedDistance> found = field.ask(at);
  const std::vector<double> expected = brute_distances(solid, at);
  const bool closed = is_closed(solid.surface);
  const std::vector<int> winding = closed ? winding_numbers(solid.surface, solid.x, at) : std::vector<int>();
  double worst = 0;
  int wrong = 0, inside = 0;
  for (int i = 0; i < count; ++i) {
    if (shape == BodyShape::raw || found[i].value > 0)
      worst = std::max(worst, std::abs(std::abs(found[i].value) - expected[i]));
    inside += found[i].value < 0;
    if (expected[i] < 1e-9) continue;
    if (!closed && i % 20 != 0) continue;  // the definition takes every triangle
    wrong +=
        (found[i].value < 0) != (closed ? winding[i] > 0 : exact_winding(solid.surface, solid.x, row(at, i)) > 0.5);
  }
  WARN(name << ": " << count << " queries, " << solid.surface.triangles.rows() << " faces, " << inside
            << " inside, largest difference " << worst << " m, wrong sides " << wrong);
  CHECK(worst < 1e-6);
  if (shape == BodyShape::united || !field.crosses_itself()) CHECK(wrong == 0);
}

// Inside a union nothing on the outside may be nearer: the ball that the distance says is free of outside must be so,
// and just beyond the closest point there must be outside.
void certify_union(const Solid& solid, int count) {
  DistanceField field(solid.surface);
  field.move_to(solid.x);
  REQUIRE(field.crosses_itself());
  const Points at = points_round(solid, count, 0.02, 31);
  const std::vector<SignedDistance> found = field.ask(at);
  std::mt19937 random(8);
  std::normal_distribution<double> normal(0, 1);
  constexpr int samples = 64;
  std::vector<int> of_query;
  std::vector<Vec3> probes;
  for (int i = 0; i < count; ++i) {
    if (!(found[i].value < -1e-6)) continue;
    for (int k = 0; k < samples; ++k) {
      const Vec3 way = Vec3(normal(random), normal(random), normal(random)).normalized();
      of_query.push_back(i);
      probes.push_back(row(at, i) - found[i].value * (1 - 1e-7) * way);
    }
    if (found[i].place != SurfacePlace::face) continue;  // from a crease the gradient need not lead out
    of_query.push_back(~i);
    probes.push_back(found[i].closest + 1e-7 * found[i].gradient);
  }
  Points where(static_cast<Eigen::Index>(probes.size()), 3);
  for (std::size_t k = 0; k < probes.size(); ++k) where.row(static_cast<Eigen::Index>(k)) = probes[k].transpose();
  const std::vector<int> winding = winding_numbers(solid.surface, solid.x, where);
  int nearer = 0, not_out = 0, inside = 0;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    // A probe on a hidden part of the surface winds 0 times.
    if (of_query[k] >= 0)
      nearer += winding[k] <= 0 && field.ask(where.row(static_cast<Eigen::Index>(k))).front().value > 1e-9;
    else
      not_out += winding[k] > 0, ++inside;
  }
  WARN("union of the mannequin: " << inside << " points inside, " << samples << " probes each, nearer outside "
                                  << nearer << ", closest points with no outside beyond " << not_out);
  CHECK(nearer == 0);
  CHECK(not_out == 0);
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void time_queries(const Solid& solid, BodyShape shape) {
  const Points at = points_round(solid, 9723 * 5 / 3, 0.01, 2)(Eigen::seqN(0, 9723), Eigen::all);
  DistanceField field(solid.surface, shape);
  field.move_to(solid.x);
  std::vector<int> faces;
  std::vector<SignedDistance> found;
  double cold = 1, warm = 1, refit = 1, cold_cpu = 1, warm_cpu = 1;
  for (int i = 0; i < 30; ++i) {
    Stopwatch watch;
    field.move_to(solid.x);
    refit = std::min(refit, watch.lap());
    faces.clear();
    double cpu = cpu_seconds();
    watch.lap();
    field.ask(at, faces, found);
    cold = std::min(cold, watch.lap());
    cold_cpu = std::min(cold_cpu, cpu_seconds() - cpu);
    cpu = cpu_seconds();
    watch.lap();
    field.ask(at, faces, found);
    warm = std::min(warm, watch.lap());
    warm_cpu = std::min(warm_cpu, cpu_seconds() - cpu);
  }
  WARN("9723 queries on " << solid.surface.triangles.rows() << " faces, "
                          << (shape == BodyShape::raw ? "raw" : "united")
                          << (field.crosses_itself() ? ", crossing itself" : "") << ": cold " << 1e3 * cold << " ms ("
                          << 1e3 * cold_cpu << " CPU), warm " << 1e3 * warm << " ms (" << 1e3 * warm_cpu
                          << " CPU), refit " << 1e3 * refit << " ms");
}

}  // namespace

TEST_CASE("signed distance, long: times", "[.long][distance_times]") {
  time_queries(mannequin(0, 0), BodyShape::raw);
  time_queries(mannequin(0, 0), BodyShape::united);
  time_queries(mannequin(2.5, 1.35), BodyShape::united);
}

TEST_CASE("signed distance, long: a million queries against brute force", "[.long][distance_long]") {
  hold_against_brute_force("mannequin", mannequin(0, 0), BodyShape::raw, 200000, 0.01);
  hold_against_brute_force("mannequin through itself, outside", mannequin(2.5, 1.35), BodyShape::united, 200000, 0.01);
  certify_union(mannequin(2.5, 1.35), 3000);
  hold_against_brute_force("needles", testing::rod(300, 0.02, 2), BodyShape::united, 200000, 0.005);
  hold_against_brute_force("mannequin with holes", testing::without_some(mannequin(0, 0), 301), BodyShape::raw, 200000,
                           0.01);
  const auto path = fake::open_data() / "makehuman" / "body.obj";
  if (!std::filesystem::exists(path)) {
    WARN("skipped: no MakeHuman body");
    return;
  }
  const Mesh mesh = read_mesh(path);
  const Solid body{make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles), mesh.x};
  hold_against_brute_force("MakeHuman's body", body, BodyShape::raw, 200000, 0.01);
}

}  // namespace selvedge::long_signed_distance_bodies
