#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "pipeline/measures/fit_girth.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/tools/fit_report.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_fit {

namespace {

constexpr int round = 48;

// A grid round the y axis, open at both ends.
Points tube_points(double radius, double height, int along) {
  Points x(round * along, 3);
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < round; ++i) {
      const double angle = 2 * std::numbers::pi * i / round;
      x.row(j * round + i) << radius * std::cos(angle), height * (double(j) / (along - 1) - 0.5),
          radius * std::sin(angle);
    }
  return x;
}

Triangles tube_triangles(int along) {
  Triangles triangles(2 * round * (along - 1), 3);
  int t = 0;
  for (int j = 0; j + 1 < along; ++j)
    for (int i = 0; i < round; ++i) {
      const int a = j * round + i, b = j * round + (i + 1) % round;
      triangles.row(t++) << a, a + round, b;
      triangles.row(t++) << b, a + round, b + round;
    }
  return triangles;
}

// A tube of radius 45 mm worn on a cylinder of 50 mm, 0.5 mm off it.
struct StretchedTube {
  static constexpr double rest_radius = 0.045, skin = 0.05, worn = 0.0505;
  Scene scene;
  Points x = tube_points(worn, 0.2, 12), body = tube_points(skin, 0.4, 9);
  StretchedTube() {
    scene.rest_is_flat = true;
    add_cloth(scene, tube_points(rest_radius, 0.2, 12), tube_triangles(12), {}, "tube");
    add_obstacle(scene, static_cast<int>(body.rows()), tube_triangles(9), false, "leg");
  }
  FitMeasures measured(const FitRegions& regions) const {
    return measure_fit(scene, x, Vec3::Zero(), scene.obstacles[0].surface, body, regions, 4e-3);
  }
  double strain() const { return worn / rest_radius - 1; }
  // Of St. Venant-Kirchhoff, stretched round and as long as it was [N/m], over the radius.
  double pressure() const {
    const Material material;
    const double stretch = worn / rest_radius, green = (stretch * stretch - 1) / 2;
    return stretch * (2 * material.lame_mu + material.lame_lambda) * green / worn;
  }
};

const std::string scene_text = R"(
cloths:
  - tube: {radius: 45 mm, height: 0.12, resolution: [40, 9]}
    name: cuff
    start: {stretch: [1.16, 1, 1.16]}
    material: {youngs_modulus: 1000, poisson: 0.3, mass_damping: 20}
obstacles:
  - name: arm
    capsule: {radius: 50 mm, length: 0.4, edge: 6 mm}
contact: {friction: 0}
gravity: [0, 0, 0]
run: {frames: 16}
)";

}  // namespace

TEST_CASE("fit: a stretched tube round a cylinder has the ease, strain and pressure T / r of the formula") {
  const StretchedTube tube;
  const FitMeasures found = tube.measured(whole_body(tube.body));
  REQUIRE(found.rows.size() == 1);
  const FitRow& row = found.rows[0];
  const double ease = 2 * std::numbers::pi * (tube.rest_radius - tube.skin);
  CHECK(row.vertices == 12 * round);
  CHECK(row.ease.value() == Approx(ease).epsilon(0.01));
  CHECK(row.least_ease.value() == Approx(ease).epsilon(0.02));
  CHECK(row.gap == Approx(tube.worn - tube.skin).epsilon(0.05));
  CHECK(row.strain == Approx(tube.strain()).epsilon(0.02));
  CHECK(row.strain_99 == Approx(tube.strain()).epsilon(0.02));
  CHECK(row.contact == 1);
  CHECK(row.pressure.value() == Approx(tube.pressure()).epsilon(0.02));
  CHECK(row.pressure_99.value() == Approx(tube.pressure()).epsilon(0.05));
  CHECK(found.pressure.minCoeff() > 0.9 * tube.pressure());
  CHECK(found.strain.maxCoeff() == Approx(tube.strain()).epsilon(0.02));
}

TEST_CASE("fit: regions have their own rows; cloth that does not go round tells no ease, cloth away no pressure") {
  StretchedTube tube;
  const int half = static_cast<int>(tube.body.rows()) / 2;
  FitRegions regions{{{"low", Vec3::UnitY()}, {"high", Vec3::UnitY()}}, {}};
  for (int v = 0; v < tube.body.rows(); ++v) regions.of_vertex.push_back(v < half ? 0 : 1);
  for (int v = 0; v < tube.x.rows(); ++v)
    if (tube.x(v, 1) > 0) tube.x(v, 0) *= 1.4, tube.x(v, 2) *= 1.4;
  const FitMeasures found = tube.measured(regions);
  REQUIRE(found.rows.size() == 2);
  CHECK(found.rows[0].region == "low");
  CHECK(found.rows[1].region == "high");
  CHECK(found.rows[0].pressure.has_value());
  CHECK(found.rows[1].contact < 0.2);
  CHECK(found.rows[1].gap > 0.015);
  CHECK(found.rows[0].vertices + found.rows[1].vertices == tube.x.rows());

  // A cut along the tube: its section ends.
  const CutPlane plane{Vec3::UnitY(), -0.05};
  const auto girth = [&](const Vec3& middle) {
    return girth_at_rest(tube.scene, tube.scene.cloths[0], tube.x, plane, middle);
  };
  CHECK(girth(Vec3::Zero()).value() == Approx(2 * std::numbers::pi * tube.rest_radius).epsilon(0.005));
  CHECK(!girth({0.06, 0, 0}).has_value());  // beside the tube
  Scene open;
  const Triangles all = tube_triangles(12);
  std::vector<int> kept;
  for (int t = 0; t < all.rows(); ++t)
    if (t / 2 % round != 3) kept.push_back(t);
  add_cloth(open, tube_points(tube.rest_radius, 0.2, 12), all(kept, Eigen::all));
  CHECK(!girth_at_rest(open, open.cloths[0], tube.x, plane, Vec3::Zero()).has_value());
}

TEST_CASE("fit: a tube that was simulated until it rests presses with T / r, and its page has colours and table") {
  const fake::Folder folder("fit_run");
  const Setup setup = read_setup(fake::write(folder, "scene.yaml", scene_text));
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  fake::run(setup, *stepper, folder.path / "out");
  const FitReport report = fit({folder.path / "out", {}, {}, {}, -1, 0, folder.path / "fit.html"});
  REQUIRE(report.measures.rows.size() == 1);
  const FitRow& row = report.measures.rows[0];
  CHECK(report.body == "arm");
  CHECK(report.frame == 16);
  CHECK(row.cloth == "cuff");
  // Stretched round alone, its ends being free.
  const double radius = 0.05 + row.gap, stretch = radius / 0.045, green = (stretch * stretch - 1) / 2;
  const double along = std::sqrt(1 - 2 * 0.3 * green), pressure = stretch * 1000 * green / along / radius;
  CHECK(row.ease.value() == Approx(2 * std::numbers::pi * (0.045 - 0.05)).epsilon(0.05));
  CHECK(row.strain == Approx(stretch - 1).epsilon(0.05));
  CHECK(row.pressure.value() == Approx(pressure).epsilon(0.05));
  const std::string page = fake::whole(folder.path / "fit.html");
  for (const std::string part : {"\"name\":\"pressure\"", "pressure Pa", "\"arm\""})
    CHECK(page.find(part) != std::string::npos);
  CHECK(nlohmann::json::parse(fit_json(report))["rows"][0]["pressure"] == row.pressure.value());
  CHECK(fit_text(report).find("cuff") != std::string::npos);
}

TEST_CASE("fit: what is not there is named") {
  const fake::Folder folder("fit_errors");
  const Setup setup = read_setup(fake::write(folder, "scene.yaml", scene_text), {"run.frames=1"});
  fake::FallingStepper stepper;
  fake::run(setup, stepper, folder.path / "out");
  const std::filesystem::path run = folder.path / "out" / "run.h5";
  using Catch::Contains;
  CHECK_THROWS_WITH(fit({run, {}, {}, {}, 7, 0, {}}), Contains("frame 7") && Contains("0 to 1"));
  CHECK_THROWS_WITH(fit({run, {}, "leg", {}, -1, 0, {}}), Contains("`leg`") && Contains("arm"));
  const auto other = fake::write(folder, "other.yaml", "cloths: [{rectangle: {edge: 0.5}}]\n");
  CHECK_THROWS_WITH(fit({run, other, {}, {}, -1, 0, {}}), Contains("other cloths"));
  std::filesystem::copy(run, folder.path / "alone.h5");
  CHECK_THROWS_WITH(fit({folder.path / "alone.h5", {}, {}, {}, -1, 0, {}}), Contains("--scene"));
  const auto regions = [&](const std::string& text) {
    return FitRequest{run, {}, {}, fake::write(folder, "regions.json", text), -1, 0, {}};
  };
  CHECK_THROWS_WITH(fit(regions("{\"arm\": [0, 1, 99999]}")), Contains("`arm` names 99999"));
  CHECK_THROWS_WITH(fit(regions("{\"arm\": [0, -1]}")), Contains("`arm` names -1"));
  CHECK_THROWS_WITH(fit(regions("{\"arm\": [0, 1.5]}")), Contains("`arm` names 1.5"));
  CHECK_THROWS_WITH(fit(regions("{\"arm\": 3}")), Contains("`arm` is no list"));
  CHECK_THROWS_WITH(fit(regions("[1, 2]")), Contains("no segmentation"));
  CHECK_THROWS_WITH(fit(regions("{\"arm\": [0")), Contains("is no JSON"));
  CHECK(fit(regions("{\"all\": [0, 1, 2]}")).measures.rows.empty());
}

}  // namespace selvedge::test_fit
