#include "pipeline/garments/mesh_frame.hpp"

#include <catch2/catch.hpp>

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

// Nearly as wide as it is long, so that most of it is as near to the body with the other axis up.
fake::Piece flared_skirt(const BodyModel& body) {
  fake::Piece skirt = fake::skirt(body, -0.46, 0.11, 0.02, 40, 16);
  for (Eigen::Index v = 0; v < skirt.x.rows(); ++v)
    for (const int k : {0, 2}) skirt.x(v, k) *= 1 + (k == 0 ? 2.5 : 3.5) * (0.11 - skirt.x(v, 1));
  return skirt;
}

}  // namespace

TEST_CASE("unit and axis of a garment's file are known from where it lies on the body", "[mesh_frame]") {
  const BodyModel& body = fake::mannequin();
  const std::vector<fake::Piece> pieces{fake::skirt(body, -0.35, 0.1, 0.02, 40, 14), flared_skirt(body),
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
        const auto found = clear_frame(fitting_frames(x, body.skin.rest, body.skin.triangles));
        REQUIRE(found);
        CHECK(frame_text(*found) == frame_text(meant));
        // What is given is not asked.
        for (const FrameFit& fit : fitting_frames(x, body.skin.rest, body.skin.triangles, "cm", Up::z))
          CHECK(frame_text(fit.frame) == "cm, z up");
      }
}

TEST_CASE("what lies on the body in several ways is not guessed", "[mesh_frame]") {
  // A cube round a cube looks the same with either axis up.
  Points cube(8, 3);
  for (int v = 0; v < 8; ++v) cube.row(v) << (v & 1) - 0.5, (v / 2 & 1) - 0.5, (v / 4) - 0.5;
  Triangles faces(12, 3);
  faces << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5;
  const Points shell = 1.05 * cube;
  const std::vector<FrameFit> fits = fitting_frames(shell, cube, faces);
  REQUIRE(fits.size() > 1);
  CHECK_FALSE(clear_frame(fits));
  CHECK_FALSE(clear_frame({}));
  CHECK(frame_text(clear_frame(fitting_frames(shell, cube, faces, "m", Up::z)).value()) == "m, z up");
}

}  // namespace selvedge::test_mesh_frame
