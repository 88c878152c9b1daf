#include "pipeline/garments/worn_part.hpp"

#include <catch2/catch.hpp>

#include "pipeline/scene/make_stepper.hpp"
#include "tests/pipeline/fake_garment.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_worn_part {

using Catch::Matchers::Contains;

namespace {

// What of the mannequin's surface lies between two heights, a centimetre farther out. Its soles are at -0.94 m, its
// head is 1.7 m higher.
Points worn_between(double low, double high, double half_width = 0.3) {
  return fake::piece_of(
             fake::mannequin(),
             [&](const Vec3& p) { return p.y() > low && p.y() < high && std::abs(p.x()) < half_width; }, 0.01)
      .x;
}

Points lower(const Points& x, double by) { return x.rowwise() - Eigen::RowVector3d(0, by, 0); }

// On a heap: all of it between the soles and a height above them.
Points heaped(Points x, double height) {
  const double low = x.col(1).minCoeff(), high = x.col(1).maxCoeff();
  x.col(1) = (-0.94 + height * (x.col(1).array() - low) / (high - low)).matrix();
  return x;
}

}  // namespace

TEST_CASE("A garment that has left its body is told from one that slides, swings or is lifted", "[worn_part]") {
  const Points& body = fake::mannequin().skin.rest;
  const Points trousers = worn_between(-0.88, 0.1), skirt = worn_between(-0.3, 0.1), dress = worn_between(-0.4, 0.4),
               hat = worn_between(0.62, 0.9), sock = worn_between(-0.95, -0.7);
  for (const Points& garment : {trousers, skirt, dress, hat, sock}) {
    const WornPart part = worn_part(garment, body);
    REQUIRE_FALSE(part.places.empty());
    CHECK(share_worn(part, garment, body).all == 1);
    CHECK_FALSE(has_left(part, lower(garment, 0.05), body));
    CHECK(has_left(part, lower(garment, 17), body));
    // On a body that moves, and left behind by it.
    const Points away = body.rowwise() + Eigen::RowVector3d(3, 0, 1);
    CHECK_FALSE(has_left(part, garment.rowwise() + Eigen::RowVector3d(3, 0, 1), away));
    CHECK(has_left(part, garment, away));
  }
  // Down round the ankles, and down on the shoulders.
  CHECK(has_left(worn_part(trousers, body), heaped(trousers, 0.2), body));
  CHECK(has_left(worn_part(skirt, body), heaped(skirt, 0.1), body));
  CHECK(has_left(worn_part(dress, body), heaped(dress, 0.1), body));
  CHECK(has_left(worn_part(hat, body), lower(hat, 0.3), body));
  // A dress on the hips is still on the body, a top is not.
  CHECK_FALSE(has_left(worn_part(dress, body), lower(dress, 0.35), body));
  CHECK(has_left(worn_part(worn_between(0.2, 0.4), body), lower(worn_between(0.2, 0.4), 0.4), body));
  // A skirt that swings up to the waist all round.
  Points swung = skirt;
  for (Eigen::Index v = 0; v < swung.rows(); ++v) {
    const double down = 0.1 - swung(v, 1), wide = std::hypot(swung(v, 0), swung(v, 2));
    swung.row(v) += down * Eigen::RowVector3d(0.7 * swung(v, 0) / wide, 0.3, 0.7 * swung(v, 2) / wide);
  }
  CHECK_FALSE(has_left(worn_part(skirt, body), swung, body));
}

TEST_CASE("What does not lie on a body cannot leave it", "[worn_part]") {
  const Points& body = fake::mannequin().skin.rest;
  const Points scarf = fake::grid_points(9).rowwise() + Eigen::RowVector3d(2, 0, 0);
  const WornPart part = worn_part(scarf, body);
  CHECK(part.places.empty());
  CHECK_FALSE(has_left(part, lower(scarf, 17), body));
}

TEST_CASE("A watched garment has left since the first frame of those that end without it", "[worn_part]") {
  const Points& body = fake::mannequin().skin.rest;
  const Points hat = worn_between(0.62, 0.9);
  WornWatch watch{"hat", "head", worn_part(hat, body)};
  for (int frame = 0; frame < 10; ++frame) {
    watch.see(frame, lower(hat, frame == 3 || frame > 6 ? 1 : 0), body);
    CHECK(watch.left_in == (frame == 3 ? 3 : frame > 6 ? 7 : -1));
  }
  CHECK(slid_off_text(watch) == "garment `hat` has slid off its body `head`, in frame 7");
}

TEST_CASE("A run says in which frame a garment has left its body, and is not clean", "[worn_part]") {
  const fake::Folder folder("slid_off");
  const BodyModel& body = fake::mannequin();
  const fake::Piece piece = fake::piece_of(
      body, [](const Vec3& p) { return p.y() > 0.66; }, 0.005);
  write_garment(folder.path / "hat.h5",
                {"hat", attached(piece.x, piece.triangles, body, Fit::tight), {}, {}, {}, body.name});
  // The body stands, then it sinks faster than its hat falls.
  const auto ran = [&](const std::string& motion) {
    const Setup setup = read_setup(fake::write(folder, "scene.yaml",
                                               "cloths: [{garment: hat.h5}]\n"
                                               "obstacles: [{name: person, body: {model: mannequin}" +
                                                   motion + "}]\nrun: {frames: 9}\n"));
    return fake::run(setup, *make_stepper(setup), folder.path / "out");
  };
  const RunSummary sunk = ran(", motion: {keyframes: [{time: 0.1}, {time: 0.2, translate: [0, -0.8, 0]}]}");
  REQUIRE(sunk.slid_off.size() == 1);
  CHECK((sunk.slid_off[0].left_in >= 4 && sunk.slid_off[0].left_in <= 6));
  CHECK_FALSE(is_clean(sunk));
  CHECK_THAT(summary_text(sunk), Contains("`cloth0` has slid off its body `person`"));
  CHECK_THAT(summary_json(sunk), Contains("\"slid_off\": [\n"));
  CHECK(ran("").slid_off.empty());
}

}  // namespace selvedge::test_worn_part
