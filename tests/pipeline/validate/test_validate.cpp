#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <set>

#include "collision/geometry/error.hpp"
#include "pipeline/shapes/generate_strip.hpp"
#include "pipeline/validate/known_answers.hpp"
#include "pipeline/validate/validate.hpp"
#include "tests/pipeline/fake_run.hpp"

namespace selvedge::test_validate {

namespace {

// Of all triangles in their flat coordinates [rad].
double smallest_angle(const Mesh& mesh) {
  double least = std::numbers::pi;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Eigen::RowVector2d at = mesh.uv.row(mesh.triangles(t, k)),
                               a = mesh.uv.row(mesh.triangles(t, (k + 1) % 3)) - at,
                               b = mesh.uv.row(mesh.triangles(t, (k + 2) % 3)) - at;
      least = std::min(least, std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
    }
  return least;
}

}  // namespace

TEST_CASE("the elastica has the master curve of the literature") {
  const std::vector<std::pair<double, double>> curve{{0.1, 0.012500}, {1, 0.124562}, {2, 0.246673}, {5, 0.585721},
                                                     {10, 1.0668},    {20, 1.8639},  {50, 3.7056},  {100, 5.8881}};
  for (const auto& [gamma, ratio] : curve) {
    const Cantilever c = elastica(gamma);
    CHECK(c.H / c.W == Approx(ratio).epsilon(5e-5));
    CHECK(c.H * c.H + c.W * c.W < 1);
  }
  CHECK(elastica(1e-4).H / elastica(1e-4).W == Approx(1e-4 / 8).epsilon(1e-6));
  CHECK(elastica(1e4).H > 0.95);
}

TEST_CASE("catenary, vibration and buckling have their known numbers") {
  for (const auto& [ratio, sag] : std::vector<std::pair<double, double>>{{1.01, 0.06145},
                                                                         {1.05, 0.13930},
                                                                         {1.1, 0.20030},
                                                                         {1.2, 0.29234},
                                                                         {1.5, 0.50263},
                                                                         {2, 0.79639},
                                                                         {3, 1.33416}})
    CHECK(catenary_sag(ratio) == Approx(sag).epsilon(1e-4));
  CHECK(clamped_free_root(1) == Approx(1.87510).epsilon(1e-5));
  CHECK(std::pow(clamped_free_root(2) / clamped_free_root(1), 2) == Approx(6.2669).epsilon(1e-4));
  CHECK(std::abs(clamped_free_mode(clamped_free_root(2), 0.783)) < 5e-3);  // its node
  CHECK(lateral_buckling_gamma(0) == Approx(18.18).epsilon(2e-3));
  CHECK(lateral_buckling_gamma(0.3) == Approx(14.51).epsilon(2e-3));
  CHECK(lateral_buckling_gamma(0.5) == Approx(11.13).epsilon(2e-3));
}

TEST_CASE("strips at any angle to their mesh are whole, straight and of well-shaped triangles") {
  for (const Triangulation cut : {Triangulation::one_diagonal, Triangulation::alternating, Triangulation::unstructured})
    for (const double degrees : {0.0, 20.0, 45.0, 70.0, 90.0, 135.0, 201.0}) {
      StripShape shape;
      shape.length = 0.1;
      shape.width = 0.03;
      shape.angle = degrees * std::numbers::pi / 180;
      shape.sheet.triangulation = cut;
      shape.clamp = shape.grip = true;
      const Mesh mesh = make_strip(shape);
      CAPTURE(static_cast<int>(cut), degrees);
      CHECK(smallest_angle(mesh) > 10 * std::numbers::pi / 180);
      double area = 0;
      for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
        const Eigen::RowVector2d a = mesh.uv.row(mesh.triangles(t, 1)) - mesh.uv.row(mesh.triangles(t, 0)),
                                 b = mesh.uv.row(mesh.triangles(t, 2)) - mesh.uv.row(mesh.triangles(t, 0));
        area += 0.5 * (a.x() * b.y() - a.y() * b.x());
      }
      const double length = mesh.uv.col(0).maxCoeff() - mesh.uv.col(0).minCoeff();
      CHECK(length > shape.length);
      CHECK(area == Approx(length * shape.width).epsilon(1e-9));
      CHECK(mesh.uv.col(1).minCoeff() == Approx(0).margin(1e-12));
      CHECK(mesh.uv.col(1).maxCoeff() == Approx(shape.width));
      const Surface surface = make_surface(static_cast<int>(mesh.uv.rows()), mesh.triangles);
      CHECK(std::set<int>(surface.component.begin(), surface.component.end()).size() == 1);
      CHECK(mesh.groups[1].second.size() >= 5);
    }
}

TEST_CASE("validation: bad input is an error that says what is there") {
  const fake::Folder folder("validate_errors");
  const auto message = [&](std::vector<std::string> cases, std::vector<std::string> overrides) {
    ValidateRequest request;
    request.cases = std::move(cases);
    request.overrides = std::move(overrides);
    request.out = folder.path;
    try {
      validate(request);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(message({"cantilver"}, {}).find("did you mean `cantilever`") != std::string::npos);
  CHECK(message({"cantilever"}, {"gama=1"}).find("did you mean `gamma`") != std::string::npos);
  CHECK(message({"cantilever"}, {"gamma=x"}).find("not a number") != std::string::npos);
  CHECK(message({"cantilever"}, {"gamma=-1"}).find("above 0") != std::string::npos);
  CHECK(message({"cantilever"}, {"mesh=square"}).find("alternating") != std::string::npos);
  CHECK(message({"cantilever"}, {"gamma"}).find("parameter=value") != std::string::npos);
}

TEST_CASE("physics has its known answers, in the short form") {
  const fake::Folder folder("validate_short");
  ValidateRequest request;
  request.short_form = true;
  request.out = folder.path;
  request.cases = {"cantilever", "greenhill", "lateral", "end_shear", "hanging",
                   "stretch",    "catenary",  "incline", "pin",       "turn"};
  const std::vector<ValidationRow> rows = validate(request);
  CHECK(rows.size() >= 17);
  for (const ValidationRow& row : rows) {
    CAPTURE(row.name, row.parameters, row.quantity, row.measured, row.bound);
    CHECK((row.passed || !row.counts));
  }
  for (const char* name : {"validate.txt", "validate.csv", "validate.json", "validate.md"})
    CHECK(std::filesystem::file_size(folder.path / name) > 100);
}

TEST_CASE("validation: order of convergence, and a case that is too coarse to count fails nothing") {
  const fake::Folder folder("validate_order");
  ValidateRequest request;
  request.cases = {"cantilever"};
  request.overrides = {"resolution=10,20", "gamma=1", "mesh=one_diagonal", "angle=0"};
  request.out = folder.path;
  const std::vector<ValidationRow> rows = validate(request);
  REQUIRE(rows.size() == 2);
  CHECK_FALSE(rows[0].counts);
  CHECK_FALSE(rows[0].order);
  REQUIRE(rows[1].order);
  CHECK(*rows[1].order > 1);
  CHECK_FALSE(rows[1].counts);
  CHECK_FALSE(passed(rows));  // nothing was judged
}

}  // namespace selvedge::test_validate
