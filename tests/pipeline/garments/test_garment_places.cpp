#include "pipeline/garments/garment_places.hpp"

#include <catch2/catch.hpp>

#include "tests/pipeline/fake_garment.hpp"

namespace selvedge::test_garment_places {

namespace {

// A tube from a to b, `radius` wide, its rings square to the line between them; open at both ends.
fake::Piece tube(const Vec3& a, const Vec3& b, double radius, int around = 24, int rings = 6) {
  fake::Piece piece;
  piece.x.resize(around * rings, 3);
  const Vec3 along = (b - a).normalized();
  const Vec3 u = along.unitOrthogonal(), w = along.cross(u);
  for (int r = 0; r < rings; ++r)
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      piece.x.row(r * around + k) =
          (a + (b - a) * r / (rings - 1) + radius * (std::cos(angle) * u + std::sin(angle) * w)).transpose();
    }
  piece.triangles.resize(2 * around * (rings - 1), 3);
  for (int r = 0; r + 1 < rings; ++r)
    for (int k = 0; k < around; ++k) {
      const int c = r * around + k, d = r * around + (k + 1) % around;
      piece.triangles.row(2 * c) << c, d, c + around;
      piece.triangles.row(2 * c + 1) << c + around, d, d + around;
    }
  return piece;
}

fake::Piece both(const fake::Piece& a, const fake::Piece& b) {
  fake::Piece piece;
  piece.x.resize(a.x.rows() + b.x.rows(), 3);
  piece.x << a.x, b.x;
  piece.triangles.resize(a.triangles.rows() + b.triangles.rows(), 3);
  piece.triangles << a.triangles, (b.triangles.array() + static_cast<int>(a.x.rows())).matrix();
  return piece;
}

std::vector<NamedLoop> loops_of(const fake::Piece& piece, const std::vector<std::string>& taken = {}) {
  const BodyModel& body = fake::mannequin();
  return named_loops(attached(piece.x, piece.triangles, body, Fit::loose), body, taken);
}

// Names in order of the alphabet; with * those that hold up.
std::vector<std::string> names(const std::vector<NamedLoop>& loops) {
  std::vector<std::string> all;
  for (const NamedLoop& loop : loops) all.push_back(loop.name + (loop.holds_up ? "*" : ""));
  std::ranges::sort(all);
  return all;
}

using Names = std::vector<std::string>;

double height(const fake::Piece& piece, const std::vector<NamedLoop>& loops, const std::string& name) {
  for (const NamedLoop& loop : loops)
    if (loop.name == name) return piece.x(loop.vertices, 1).mean();
  return std::nan("");
}

}  // namespace

TEST_CASE("Boundaries of shirts, trousers and skirts are named by place", "[garment_places]") {
  const BodyModel& body = fake::mannequin();
  const auto worn = [&](const auto& chosen) { return fake::piece_of(body, chosen, 0.01); };
  const fake::Piece shirt = worn([](const Vec3& p) { return p.y() > -0.05 && p.y() < 0.5 && std::abs(p.x()) < 0.5; });
  const std::vector<NamedLoop> of_shirt = loops_of(shirt);
  CHECK(names(of_shirt) == Names{"cuff_left", "cuff_right", "hem", "neck"});
  CHECK(height(shirt, of_shirt, "neck") > 0.4);
  CHECK(height(shirt, of_shirt, "hem") < 0);
  for (const NamedLoop& loop : of_shirt)
    if (loop.name == "cuff_left") CHECK(shirt.x(loop.vertices, 0).minCoeff() > 0.4);

  CHECK(names(loops_of(worn([](const Vec3& p) { return p.y() < 0.05 && p.y() > -0.8; }))) ==
        Names{"leg_left", "leg_right", "waist*"});
  CHECK(names(loops_of(fake::skirt(body, -0.4, 0.1, 0.02, 48, 16))) == Names{"hem", "waist*"});
  // A tank top ends where the arms begin, and a tube top has nothing to hang from.
  CHECK(names(loops_of(worn([](const Vec3& p) { return p.y() > 0.05 && p.y() < 0.54 && std::abs(p.x()) < 0.2; }))) ==
        Names{"cuff_left", "cuff_right", "hem", "neck"});
  CHECK(names(loops_of(fake::trunk(body, 0.05, 0.3, 0.01))) == Names{"hem", "waist*"});
  CHECK(names(loops_of(tube({0, 0.5, 0}, {0, -0.6, 0}, 0.5))) == Names{"hem", "neck"});
}

TEST_CASE("Pieces that are not joined have names of their own", "[garment_places]") {
  const BodyModel& body = fake::mannequin();
  const fake::Piece skirts =
      both(fake::skirt(body, -0.4, 0.1, 0.02, 48, 16), fake::skirt(body, -0.3, 0.1, 0.05, 48, 16));
  CHECK(names(loops_of(skirts, {"hem"})) == Names{"hem_2", "hem_3", "waist*", "waist_2*"});
  const fake::Piece sock = tube({0.134, -0.6, -0.02}, {0.134, -0.8, -0.02}, 0.08);
  CHECK(names(loops_of(sock)) == Names{"leg_left", "leg_left_2"});
  const fake::Piece sleeve = tube({-0.4, 0.445, -0.02}, {-0.7, 0.445, -0.02}, 0.1);
  CHECK(names(loops_of(sleeve)) == Names{"cuff_right", "cuff_right_2"});
  // Something flat before the chest.
  fake::Piece patch;
  patch.x.resize(4, 3);
  patch.x << -0.05, 0.2, 0.2, 0.05, 0.2, 0.2, 0.05, 0.3, 0.2, -0.05, 0.3, 0.2;
  patch.triangles.resize(2, 3);
  patch.triangles << 0, 1, 2, 0, 2, 3;
  CHECK(names(loops_of(patch)) == Names{"opening"});
}

TEST_CASE("Joints of other names belong to the region of their parents", "[garment_places]") {
  BodyModel body = fake::mannequin();
  for (std::string& name : body.joints)
    if (name == "left_elbow" || name == "left_wrist") name += " of another rig";
  const fake::Piece sleeve = tube({0.5, 0.445, -0.02}, {0.7, 0.445, -0.02}, 0.1);
  const SkinnedSurface skin = attached(sleeve.x, sleeve.triangles, body, Fit::loose);
  CHECK(names(named_loops(skin, body, {})) == Names{"cuff_left", "cuff_left_2"});
  // Without shoulders nothing is known to hang, so that all is held.
  for (std::string& name : body.joints) name = "bone " + name;
  const fake::Piece skirt = fake::skirt(body, -0.4, 0.1, 0.02, 48, 16);
  CHECK(names(named_loops(attached(skirt.x, skirt.triangles, body, Fit::loose), body, {})) == Names{"hem", "waist*"});
}

}  // namespace selvedge::test_garment_places
