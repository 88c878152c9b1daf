#include "pipeline/garments/mesh_frame.hpp"

#include <catch2/catch.hpp>

#include <numbers>

#include "pipeline/config/config_units.hpp"
#include "tests/pipeline/fake_garment.hpp"

namespace selvedge::test_mesh_frame {

namespace {

// Coordinates as a file would have them that is meant so.
Points in_file(const Points& x, const MeshFrame& frame) {
  Points turned = x / metres_per_unit(frame.unit);
  if (frame.up == Up::y) return turned;
  const Points y_up = turned;
  turned.col(1) = -y_up.col(2);
  turned.col(2) = y_up.col(1);
  return turned;
}

}  // namespace

TEST_CASE("unit and axis of a garment's file are known from where it lies on the body", "[mesh_frame]") {
  const BodyModel& body = fake::mannequin();
  const std::vector<fake::Piece> pieces{fake::skirt(body, -0.35, 0.1, 0.02, 40, 14),
                                        fake::trunk(body, -0.05, 0.3, 0.02),
                                        fake::piece_of(
                                            body, [](const Vec3& p) { return p.y() > -0.05 && p.y() < 0.5; }, 0.02)};
  for (const fake::Piece& piece : pieces)
    for (const char* unit : {"m", "dm", "cm", "mm", "in"})
      for (const Up up : {Up::y, Up::z}) {
        const MeshFrame meant{unit, up};
        const Points x = in_file(piece.x, meant);
        INFO(frame_text(meant));
        CHECK((in_metres(x, meant) - piece.x).cwiseAbs().maxCoeff() < 1e-12);
        const auto found = clear_frame(fitting_frames(x, piece.triangles, body.skin.rest, body.skin.triangles));
        REQUIRE(found);
        CHECK(frame_text(*found) == frame_text(meant));
        // Vertices in no triangle do not count.
        Points stray(x.rows() + 1, 3);
        stray << x, Eigen::RowVector3d::Constant(50 * x.cwiseAbs().maxCoeff());
        const auto again = clear_frame(fitting_frames(stray, piece.triangles, body.skin.rest, body.skin.triangles));
        REQUIRE(again);
        CHECK(frame_text(*again) == frame_text(meant));
        // What is given is not asked.
        for (const FrameFit& fit : fitting_frames(x, piece.triangles, body.skin.rest, body.skin.triangles, "cm", Up::z))
          CHECK(frame_text(fit.frame) == "cm, z up");
      }
}

TEST_CASE("a wide skirt, about as near to the body with the other axis up, does not cross it", "[mesh_frame]") {
  const BodyModel& body = fake::mannequin();
  for (const double hem : {0.3, 0.45, 0.6, 0.75})
    for (const Up up : {Up::y, Up::z}) {
      constexpr int around = 48, rows = 12;
      fake::Piece skirt = fake::skirt(body, -0.4, 0.08, 0.02, around, rows);
      for (Eigen::Index v = 0; v < skirt.x.rows(); ++v) {
        const double down = static_cast<double>(v / around) / static_cast<double>(skirt.x.rows() / around - 1);
        const double angle = 2 * std::numbers::pi * static_cast<double>(v % around) / around;
        const double radius = 0.17 + (hem - 0.17) * down;
        skirt.x.row(v) << radius * std::cos(angle), 0.08 - 0.48 * down, radius * std::sin(angle);
      }
      const MeshFrame meant{"cm", up};
      INFO(frame_text(meant) << ", hem " << hem);
      const auto found =
          clear_frame(fitting_frames(in_file(skirt.x, meant), skirt.triangles, body.skin.rest, body.skin.triangles));
      REQUIRE(found);
      CHECK(frame_text(*found) == frame_text(meant));
    }
}

TEST_CASE("what lies on the body in several ways is not guessed", "[mesh_frame]") {
  // A cube round a cube looks the same with either axis up.
  Points cube(8, 3);
  for (int v = 0; v < 8; ++v) cube.row(v) << (v & 1) - 0.5, (v / 2 & 1) - 0.5, (v / 4) - 0.5;
  Triangles faces(12, 3);
  faces << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5;
  const Points shell = 1.05 * cube;
  const std::vector<FrameFit> fits = fitting_frames(shell, faces, cube, faces);
  REQUIRE(fits.size() > 1);
  CHECK_FALSE(clear_frame(fits));
  CHECK_FALSE(clear_frame({}));
  CHECK(frame_text(clear_frame(fitting_frames(shell, faces, cube, faces, "m", Up::z)).value()) == "m, z up");
}

}  // namespace selvedge::test_mesh_frame
