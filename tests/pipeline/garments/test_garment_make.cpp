#include "pipeline/garments/garment_make.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "collision/audit/audit.hpp"
#include "collision/geometry/error.hpp"
#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/garments/outfit.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "tests/pipeline/fake_body.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_garment_make {

namespace {

const BodyModel& mannequin() {
  static const BodyModel body = kept_mannequin(cache_folder());
  return body;
}

constexpr double coarse = 0.032;

#ifdef __SANITIZE_ADDRESS__
constexpr bool brief = true;  // under the sanitizers all takes ten times as long
#else
constexpr bool brief = false;
#endif

// All garments at once, worn by a body of that shape.
Audit audit_of(const std::vector<Garment>& garments, const Eigen::VectorXd& shape) {
  Eigen::Index vertices = 0, triangles = 0;
  for (const Garment& garment : garments) {
    vertices += garment.skin.rest.rows();
    triangles += garment.skin.triangles.rows();
  }
  Points x(vertices, 3);
  Triangles all(triangles, 3);
  vertices = triangles = 0;
  for (const Garment& garment : garments) {
    const Eigen::Index n = garment.skin.rest.rows(), m = garment.skin.triangles.rows();
    x.middleRows(vertices, n) = rest_shape(garment, mannequin(), shape);
    all.middleRows(triangles, m) = garment.skin.triangles.array() + static_cast<int>(vertices);
    vertices += n;
    triangles += m;
  }
  const Points skin = shaped(mannequin().skin, shape);
  const Surface cloth = make_surface(static_cast<int>(vertices), all),
                body = make_surface(static_cast<int>(skin.rows()), mannequin().skin.triangles);
  const AuditBody obstacle{&body, &skin};
  return audit(cloth, x, {&obstacle, 1});
}

void check_clean(const Audit& audit) {
  CHECK(audit.self_pairs.empty());
  CHECK(audit.vertex_pairs.empty());
  CHECK(audit.obstacle_pairs.empty());
  CHECK(audit.inside_vertices == 0);
}

// Standard normal, cut off at three.
Eigen::VectorXd random_shape(fake::Dice& dice) {
  Eigen::VectorXd shape(10);
  for (double& s : shape) {
    const double u = dice.number(1e-12, 1), turn = dice.number(0, 2 * std::numbers::pi);
    s = std::clamp(std::sqrt(-2 * std::log(u)) * std::cos(turn), -3.0, 3.0);
  }
  return shape;
}

double least_angle(const SkinnedSurface& skin) {
  double cosine = 0;
  for (const auto& t : skin.triangles.rowwise())
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = row(skin.rest, t[k]), b = row(skin.rest, t[(k + 1) % 3]), c = row(skin.rest, t[(k + 2) % 3]);
      cosine = std::max(cosine, (b - a).normalized().dot((c - a).normalized()));
    }
  return std::acos(cosine) * 180 / std::numbers::pi;
}

const std::vector<int>* group_of(const Garment& garment, const std::string& name) {
  for (const auto& [group, vertices] : garment.groups)
    if (group == name) return &vertices;
  return nullptr;
}

Garment coarse_garment(const std::string& name) {
  GarmentOptions options;
  options.edge = coarse;
  return make_garment(name, mannequin(), options);
}

}  // namespace

TEST_CASE("Garments by code are manifold, clean on any shape, and well shaped", "[garment]") {
  struct Expected {
    int loops, components;
  };
  const std::map<std::string, Expected> expected{{"tshirt", {4, 1}},        {"long_sleeved_shirt", {4, 1}},
                                                 {"tank_top", {4, 1}},      {"trousers", {3, 1}},
                                                 {"wide_trousers", {3, 1}}, {"shorts", {3, 1}},
                                                 {"skirt_short", {2, 1}},   {"skirt_long", {2, 1}},
                                                 {"skirt_flared", {2, 1}},  {"dress_tight", {4, 1}},
                                                 {"dress_flowing", {4, 1}}, {"poncho", {2, 1}},
                                                 {"open_shirt", {4, 2}},    {"vest", {5, 3}},
                                                 {"jacket", {5, 3}}};
  fake::Dice dice{std::mt19937(11)};
  for (const std::string& name : garment_names()) {
    INFO(name);
    const Garment garment = coarse_garment(name);
    const Surface surface = make_surface(static_cast<int>(garment.skin.rest.rows()), garment.skin.triangles);
    REQUIRE(expected.contains(name));
    CHECK(boundary_loops(surface).size() == static_cast<std::size_t>(expected.at(name).loops));
    CHECK(surface.component_count == expected.at(name).components);
    CHECK(least_angle(garment.skin) > (group_of(garment, "collar") ? 8 : 20));
    check_clean(audit_of({garment}, {}));
    for (int k = 0; k < (brief ? 1 : 3); ++k) check_clean(audit_of({garment}, random_shape(dice)));
    CHECK(garment.groups.size() >= 2);
    for (const auto& [group, vertices] : garment.groups) {
      CHECK(!vertices.empty());
      CHECK(std::is_sorted(vertices.begin(), vertices.end()));
      CHECK(std::adjacent_find(vertices.begin(), vertices.end()) == vertices.end());
    }
    const bool hangs = group_of(garment, "shoulder_left") != nullptr;
    CHECK(garment.pins.empty() == hangs);
  }
}

TEST_CASE("A garment is the same each time, symmetric, and as fine as asked", "[garment]") {
  const Garment one = coarse_garment("tshirt"), two = coarse_garment("tshirt");
  CHECK(one.skin.rest == two.skin.rest);
  CHECK(one.skin.triangles == two.skin.triangles);
  const std::vector<int>*left = group_of(one, "cuff_left"), *right = group_of(one, "cuff_right");
  REQUIRE((left && right));
  CHECK(left->size() == right->size());
  for (const int v : *left) CHECK(one.skin.rest(v, 0) == Approx(0.37));
  const Surface surface = make_surface(static_cast<int>(one.skin.rest.rows()), one.skin.triangles);
  double sum = 0;
  for (const auto& edge : surface.edges.rowwise())
    sum += (one.skin.rest.row(edge[0]) - one.skin.rest.row(edge[1])).norm();
  CHECK(sum / static_cast<double>(surface.edges.rows()) == Approx(coarse).epsilon(0.1));
}

TEST_CASE("Pockets are stitched along their sides and lower edge to the nearest vertex behind", "[garment]") {
  for (const auto& [name, pockets] : {std::pair{"open_shirt", 1}, {"vest", 2}, {"jacket", 2}}) {
    INFO(name);
    const Garment garment = coarse_garment(name);
    const Points& x = garment.skin.rest;
    const std::vector<int>*pocket = group_of(garment, "pocket"), *collar = group_of(garment, "collar");
    REQUIRE(pocket);
    const auto has = [](const std::vector<int>* group, int v) {
      return group && std::binary_search(group->begin(), group->end(), v);
    };
    const Surface surface = make_surface(static_cast<int>(x.rows()), garment.skin.triangles);
    std::set<int> expected, stitched;
    for (const std::vector<int>& loop : boundary_loops(surface)) {
      if (!has(pocket, loop[0])) continue;
      const auto height = [&](int v) { return x(v, 1); };
      const double top = x(std::ranges::max(loop, {}, height), 1);
      const auto across = [&](int v) { return x(v, 0); };
      const auto [left, right] = std::ranges::minmax(loop, {}, across);
      for (const int v : loop)  // all but what is on the upper edge between its corners
        if (x(v, 1) < top - 0.01 || x(v, 0) < x(left, 0) + 1e-3 || x(v, 0) > x(right, 0) - 1e-3) expected.insert(v);
    }
    for (const auto& [a, b, rest_length] : garment.stitches) {
      stitched.insert(a);
      CHECK((has(pocket, a) && !has(pocket, b) && !has(collar, b)));
      CHECK(rest_length == Approx((x.row(b) - x.row(a)).norm()));
      CHECK(rest_length < coarse);
      for (int v = 0; v < x.rows(); ++v)
        if (!has(pocket, v) && !has(collar, v)) CHECK((x.row(v) - x.row(a)).norm() > rest_length - 1e-9);
    }
    CHECK(stitched == expected);
    CHECK(stitched.size() == garment.stitches.size());
    CHECK(stitched.size() >= static_cast<std::size_t>(7 * pockets));
  }
  CHECK(coarse_garment("tshirt").stitches.empty());
}

TEST_CASE("Small outfits are clean on any shape", "[garment]") {
  const Wardrobe wardrobe = read_wardrobe(config_folder() / "outfits.yaml");
  std::vector<std::size_t> validation, training;
  fake::Dice dice{std::mt19937(5)};
  for (const Outfit& outfit : wardrobe.outfits) {
    INFO(outfit.name);
    (outfit.validation ? validation : training).push_back(outfit.garments.size());
    if (brief && outfit.garments.size() > 2) continue;
    const std::vector<Garment> garments = kept_outfit(cache_folder(), outfit, mannequin(), outfit.small_edge);
    Eigen::Index vertices = 0;
    for (const Garment& garment : garments) {
      vertices += garment.skin.rest.rows();
      CHECK(least_angle(garment.skin) > (group_of(garment, "collar") ? 5 : 20));
    }
    CHECK(vertices >= 2000);
    CHECK(vertices <= 6000);
    check_clean(audit_of(garments, {}));
    check_clean(audit_of(garments, random_shape(dice)));
  }
  std::sort(validation.begin(), validation.end());
  CHECK(validation == std::vector<std::size_t>{2, 2, 3, 3, 5});
  CHECK(training.size() == 3);
}

TEST_CASE("Wrong garments and wardrobes are refused", "[garment]") {
  CHECK_THROWS_AS(make_garment("toga", mannequin()), Error);
  GarmentOptions options;
  options.edge = 0.2;
  CHECK_THROWS_AS(make_garment("tshirt", mannequin(), options), Error);
  const std::vector<std::string> jacket{"jacket"};
  CHECK_THROWS_AS(make_garment("poncho", mannequin(), {}, jacket), Error);
  const fake::Folder folder("wardrobe");
  const auto refused = [&](const std::string& text) {
    CHECK_THROWS_AS(read_wardrobe(fake::write(folder, "outfits.yaml", text)), Error);
  };
  refused("garments: [{name: toga, split: training}]\noutfits: []\n");
  refused("garments: [{name: tshirt, split: training}, {name: tshirt, split: validation}]\noutfits: []\n");
  refused("garments: [{name: tshirt, split: training}]\noutfits: []\n");
}

}  // namespace selvedge::test_garment_make
