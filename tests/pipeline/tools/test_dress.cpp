#include "pipeline/tools/dress.hpp"

#include <catch2/catch.hpp>

#include <numbers>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/garments/garment_hdf5.hpp"
#include "tests/pipeline/fake_garment.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_dress {

using Catch::Matchers::Contains;
using fake::farthest;
using fake::Folder;

namespace {

// An OBJ with two groups, of its first and its last triangle.
std::filesystem::path write_grouped(const Folder& folder, const fake::Piece& piece, double scale = 1) {
  std::ofstream out(folder.path / "mesh.obj");
  out.precision(17);
  for (const auto& p : piece.x.rowwise())
    out << "v " << scale * p[0] << " " << scale * p[1] << " " << scale * p[2] << "\n";
  const Eigen::Index last = piece.triangles.rows() - 1;
  for (Eigen::Index t = 0; t <= last; ++t) {
    if (t == 0) out << "g first\n";
    if (t == 1) out << "g rest\n";
    if (t == last) out << "g last\n";
    out << "f " << piece.triangles(t, 0) + 1 << " " << piece.triangles(t, 1) + 1 << " " << piece.triangles(t, 2) + 1
        << "\n";
  }
  return folder.path / "mesh.obj";
}

// The mesh as the reader gives it back; decimals cost the last bits.
Points as_read(const Folder& folder) { return read_mesh(folder.path / "mesh.obj").x; }

const std::vector<int>& members(const Garment& garment, const std::string& group) {
  for (const auto& [name, vertices] : garment.groups)
    if (name == group) return vertices;
  throw std::runtime_error("no group " + group);
}

}  // namespace

TEST_CASE("A skirt is dressed in the zero pose, its waist pinned, its groups kept", "[dress]") {
  const Folder folder("dress_zero");
  const fake::Piece piece = fake::skirt(fake::mannequin(), -0.35, 0.1, 0.02, 40, 14);
  DressRequest request;
  request.mesh = write_grouped(folder, piece, 100);
  request.unit = "cm";
  request.out = folder.path / "skirt.h5";
  const DressReport report = dress(request);
  CHECK(is_clean(report));
  CHECK(report.warnings.empty());
  CHECK(report.components == 1);
  CHECK(report.pinned == std::vector<std::string>{"waist"});
  CHECK(report.least_distance > 0.01);
  CHECK(report.mean_distance > report.least_distance);
  CHECK(report.mean_distance < 0.2);
  const Garment garment = read_garment(request.out);
  CHECK(garment.name == "mesh");
  CHECK(garment.made_for == fake::mannequin().name);
  CHECK(garment.made_in.rotations.rows() == 0);
  CHECK(farthest(garment.skin.rest, 0.01 * as_read(folder)) < 1e-12);
  CHECK(garment.pins == members(garment, "waist"));
  CHECK(garment.pins.size() == 40);
  CHECK(garment.pins.back() == 39);
  CHECK(members(garment, "hem").size() == 40);
  CHECK(members(garment, "first") == std::vector<int>{0, 1, 40});
  CHECK(members(garment, "last").size() == 3);

  request.pins = {"first", "hem"};
  CHECK(dress(request).garment.pins.size() == 43);
  request.pins = {"none"};
  CHECK(dress(request).garment.pins.empty());
  request.pins = {"hemm"};
  CHECK_THROWS_WITH(dress(request), Contains("--pin") && Contains("did you mean `hem`"));
}

TEST_CASE("A mesh whose vertices are there several times is welded, and keeps its look in the file", "[dress][look]") {
  const Folder folder("dress_weld");
  const fake::Piece piece = fake::skirt(fake::mannequin(), -0.35, 0.1, 0.02, 40, 14);
  DressRequest request;
  request.mesh = folder.path / "split.obj";
  request.out = folder.path / "skirt.h5";
  {
    std::ofstream out(request.mesh);
    out.precision(17);
    for (const int v : piece.triangles.reshaped<Eigen::RowMajor>())
      out << "v " << piece.x(v, 0) << " " << piece.x(v, 1) << " " << piece.x(v, 2) << "\nvt 0." << v << " 0.5\n";
    out << "usemtl wool\n";
    for (Eigen::Index t = 0; t < piece.triangles.rows(); ++t) {
      out << "f";
      for (int k = 1; k <= 3; ++k) out << " " << 3 * t + k << "/" << 3 * t + k;
      out << "\n";
    }
  }
  request.weld = true;
  const DressReport report = dress(request);
  CHECK(report.warnings.empty());
  CHECK(report.components == 1);
  const Garment garment = read_garment(request.out);
  REQUIRE(garment.skin.rest.rows() == piece.x.rows());
  REQUIRE(std::ssize(garment.look.vertex) == piece.triangles.size());
  CHECK(garment.look.corner_uv == garment.look.corners);
  CHECK(garment.look.materials == std::vector<LookMaterial>{{"wool"}});
  const Points split = garment.skin.rest(garment.look.vertex, Eigen::all);
  const std::vector<int> corners(piece.triangles.data(), piece.triangles.data() + piece.triangles.size());
  CHECK(farthest(split, piece.x(corners, Eigen::all)) < 1e-9);

  request.weld = false;
  const DressReport apart = dress(request);
  CHECK(apart.components == piece.triangles.rows());
  REQUIRE(apart.warnings.size() == 1);
  const Eigen::Index more = piece.triangles.size() - piece.x.rows();
  CHECK(apart.warnings[0] == "the seams are not welded: --weld joins " + std::to_string(more) + " vertices");
}

TEST_CASE("A mesh in a pose and shape comes back there to a nanometre, and rests there", "[dress]") {
  const Folder folder("dress_posed");
  const BodyModel& body = fake::mannequin();
  Eigen::VectorXd shape(3);
  shape << 1, -0.5, 0.7;
  BodyPose pose{Points::Zero(24, 3), Vec3(0, 0, 0)};
  pose.rotations.row(16) << 0, 0, -0.7;
  pose.rotations.row(17) << 0, 0.2, 0.7;
  pose.rotations.row(1) << -0.4, 0, 0;
  fake::Piece piece = fake::piece_of(
      body, [](const Vec3& p) { return p.y() > -0.05 && p.y() < 0.5 && std::abs(p.x()) < 0.5; }, 0);
  const Surface surface = make_surface(static_cast<int>(body.skin.rest.rows()), body.skin.triangles);
  const Points there = posed(body, shape, pose);
  piece.x = (there + 0.01 * vertex_normals(surface, there))(piece.from, Eigen::all);
  DressRequest request;
  request.mesh = write_grouped(folder, piece);
  request.out = folder.path / "shirt.h5";
  request.shape = {1, -0.5, 0.7};
  request.rotations = {"left_shoulder=0,0,-0.7", "right_shoulder=0, 0.2, 0.7", "left_hip=-0.4,0,0"};
  for (const std::string fit : {"loose", "tight"}) {
    request.fit = fit;
    const DressReport report = dress(request);
    CHECK(report.reposed < 1e-9);
    CHECK(report.pinned.empty());
    CHECK(report.body_pairs + report.inside_vertices == 0);
    CHECK(report.mean_distance == Approx(0.01).margin(0.002));
    const Garment garment = read_garment(request.out);
    CHECK(farthest(skinned(garment, body, shape, pose), as_read(folder)) < 1e-9);
    CHECK(farthest(rest_shape(garment, body, shape), as_read(folder)) < 1e-9);
    for (const std::string name : {"neck", "hem", "cuff_left", "cuff_right"})
      CHECK_FALSE(members(garment, name).empty());
  }
  // Where the cloth is tight it lies as close to the body in the zero pose and shape.
  const Garment tight = read_garment(request.out);
  CHECK((tight.skin.rest - body.skin.rest(piece.from, Eigen::all)).rowwise().norm().mean() ==
        Approx(0.01).margin(0.004));

  request.rotations = {"left_shoulder=0,0,-40.107045659 deg", "right_shoulder=0, 0.2, 0.7", "left_hip=-0.4,0,0"};
  CHECK(farthest(dress(request).garment.skin.rest, tight.skin.rest) < 1e-6);
}

TEST_CASE("A mesh on a body in a clip's pose", "[dress]") {
  const Folder folder("dress_clip");
  const BodyModel& body = fake::mannequin();
  DressRequest request;
  request.out = folder.path / "band.h5";
  request.pose = "squat";
  request.time = 1;
  // The body's own surface there: found by dressing nothing else than itself.
  fake::Piece piece = fake::trunk(body, -0.05, 0.3, 0);
  request.mesh = write_grouped(folder, piece);
  request.unit = "m";
  request.up = Up::y;
  const BodyPose pose = dress(request).garment.made_in;
  CHECK(pose.rotations.rows() == 24);
  CHECK(pose.translation.y() > 0.3);
  piece.x = posed(body, {}, pose)(piece.from, Eigen::all);
  write_grouped(folder, piece);
  request.fit = "tight";
  const DressReport report = dress(request);
  CHECK(report.reposed < 1e-9);
  CHECK(farthest(report.garment.skin.rest, body.skin.rest(piece.from, Eigen::all)) < 1e-6);
}

TEST_CASE("Pose blend shapes are taken back too", "[dress]") {
  BodyModel body = fake::mannequin();
  body.skin.pose_directions = 1e-2 * Eigen::MatrixXd::Random(body.skin.rest.rows() * 3, 9 * 23);
  Eigen::VectorXd shape = Eigen::VectorXd::Constant(4, 0.5);
  BodyPose pose{0.3 * Points::Random(24, 3), Vec3(1, 2, 3)};
  const JointTransforms transforms = joint_transforms(body, joint_positions(body, shape), pose);
  SkinnedSurface there = body.skin;
  there.rest = posed(body.skin, shape, pose, transforms);
  CHECK(farthest(unposed(there, shape, pose, transforms), body.skin.rest) < 1e-12);
}

TEST_CASE("What a garment crosses is counted", "[dress]") {
  const Folder folder("dress_dirty");
  const fake::Piece piece = fake::trunk(fake::mannequin(), -0.05, 0.3, -0.02);
  DressRequest request;
  request.mesh = write_grouped(folder, piece);
  request.out = folder.path / "band.h5";
  request.unit = "m";
  request.up = Up::y;
  const DressReport report = dress(request);
  CHECK_FALSE(is_clean(report));
  CHECK(report.inside_vertices == piece.x.rows());
  CHECK(std::filesystem::exists(request.out));
  write_grouped(folder, piece, 100);  // in cm, taken for m
  const DressReport huge = dress(request);
  REQUIRE(huge.warnings.size() == 1);
  CHECK_THAT(huge.warnings[0], Contains("--unit cm --up y would put it there"));
}

TEST_CASE("Unit and axis are guessed from the body, and said", "[dress]") {
  const Folder folder("dress_guessed");
  fake::Piece piece = fake::skirt(fake::mannequin(), -0.35, 0.1, 0.02, 40, 14);
  const Points meant = piece.x;
  piece.x.col(1) = -meant.col(2);
  piece.x.col(2) = meant.col(1);
  DressRequest request;
  request.mesh = write_grouped(folder, piece, 100);
  request.out = folder.path / "skirt.h5";
  const DressReport guessed = dress(request);
  CHECK(is_clean(guessed));
  CHECK(guessed.warnings.empty());
  CHECK(frame_text(guessed.frame) == "cm, z up");
  CHECK_THAT(dress_text(guessed), Contains("unit and axis") && Contains("cm, z up, guessed: so it lies on the body") &&
                                      Contains("--unit cm --up z says the same"));
  CHECK_THAT(dress_json(guessed), Contains("\"unit\":\"cm\"") || Contains("\"unit\": \"cm\""));
  CHECK(farthest(guessed.garment.skin.rest, meant) < 1e-9);
  request.unit = "cm";
  CHECK(frame_text(dress(request).frame) == "cm, z up");
  request.up = Up::z;
  const DressReport given = dress(request);
  CHECK(given.frame_reason.empty());
  CHECK(farthest(given.garment.skin.rest, guessed.garment.skin.rest) == 0);
  // Nowhere near the body in any way: said, and not called clean.
  piece.x.rowwise() += Eigen::RowVector3d(9000, 0, 0);
  write_grouped(folder, piece);
  request.unit.reset();
  request.up.reset();
  const DressReport nowhere = dress(request);
  CHECK_FALSE(is_clean(nowhere));
  CHECK_THAT(nowhere.frame_reason, Contains("in no unit"));
}

TEST_CASE("A mesh that lies on the body equally well in two ways is refused, with the cure", "[dress]") {
  const Folder folder("dress_ambiguous");
  // A tube along x through the middle of the hips is the same tube with either axis up.
  fake::Piece tube = fake::skirt(fake::mannequin(), -0.35, 0.1, 0.02, 24, 6);
  for (int v = 0; v < tube.x.rows(); ++v) {
    const double angle = std::numbers::pi / 12 * (v % 24);
    tube.x.row(v) << 0.08 * (v / 24) - 0.2, 0.18 * std::cos(angle), 0.18 * std::sin(angle);
  }
  DressRequest request;
  request.mesh = write_grouped(folder, tube);
  request.out = folder.path / "tube.h5";
  CHECK_THROWS_WITH(dress(request), Contains("m, y up") && Contains("m, z up") && Contains("--unit m --up y") &&
                                        Contains("--unit m --up z"));
  CHECK_FALSE(std::filesystem::exists(request.out));
  request.unit = "m";
  CHECK_THROWS_WITH(dress(request), Contains("m, y up") && Contains("m, z up"));
  request.up = Up::z;
  CHECK(dress(request).frame_reason.empty());
}

TEST_CASE("A mesh whose seams are not welded is told how many vertices --weld joins", "[dress]") {
  const Folder folder("dress_weld");
  const fake::Piece skirt = fake::skirt(fake::mannequin(), -0.35, 0.1, 0.02, 40, 14);
  // Front and back as panels of their own: a quad column belongs to the half that it lies in.
  fake::Piece cut{Points(0, 3), skirt.triangles, {}};
  std::vector<Eigen::RowVector3d> x;
  std::vector<std::vector<int>> copy(2, std::vector<int>(static_cast<std::size_t>(skirt.x.rows()), -1));
  for (Eigen::Index t = 0; t < skirt.triangles.rows(); ++t) {
    const std::size_t half = t / 2 % 40 < 20 ? 0 : 1;
    for (int k = 0; k < 3; ++k) {
      int& n = copy[half][static_cast<std::size_t>(skirt.triangles(t, k))];
      if (n < 0) {
        n = static_cast<int>(x.size());
        x.push_back(skirt.x.row(skirt.triangles(t, k)));
      }
      cut.triangles(t, k) = n;
    }
  }
  cut.x.resize(static_cast<Eigen::Index>(x.size()), 3);
  for (std::size_t v = 0; v < x.size(); ++v) cut.x.row(static_cast<Eigen::Index>(v)) = x[v];
  REQUIRE(cut.x.rows() == skirt.x.rows() + 28);
  DressRequest request;
  request.mesh = write_grouped(folder, cut);
  request.out = folder.path / "skirt.h5";
  const DressReport loose = dress(request);
  CHECK(loose.components == 2);
  CHECK(loose.weldable == 28);
  CHECK(loose.self_pairs > 0);
  REQUIRE(loose.warnings.size() == 1);
  CHECK(loose.warnings[0] == "the seams are not welded: --weld joins 28 vertices");
  request.weld = true;
  const DressReport welded = dress(request);
  CHECK(is_clean(welded));
  CHECK(welded.components == 1);
  CHECK(welded.welded == 28);
  CHECK(welded.warnings.empty());
  CHECK_THAT(dress_text(welded), Contains("28 vertices joined to others"));
  CHECK(welded.garment.skin.rest.rows() == skirt.x.rows());
  request.weld_within = 0.5;
  CHECK_THROWS_WITH(dress(request), Contains("half"));
}

TEST_CASE("What is wrong with a request is named", "[dress]") {
  const Folder folder("dress_faulty");
  DressRequest request;
  request.mesh = write_grouped(folder, fake::trunk(fake::mannequin(), 0, 0.2, 0.01));
  request.out = folder.path / "band.h5";
  const auto complaint = [&](const auto& change) {
    DressRequest changed = request;
    change(changed);
    try {
      dress(changed);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(complaint([](auto& r) { r.body = "manequin"; }), Contains("--body manequin") && Contains("missing file"));
  CHECK_THAT(complaint([](auto& r) { r.pose = "wlak"; }), Contains("--pose wlak") && Contains("did you mean `walk`"));
  CHECK_THAT(complaint([](auto& r) { r.shape.assign(11, 1); }), Contains("--shape") && Contains("at most 10"));
  CHECK_THAT(complaint([](auto& r) { r.shape = {1e12}; }), Contains("--shape") && Contains("absurdly large"));
  CHECK_THAT(complaint([](auto& r) {
               r.pose = "walk";
               r.time = 1e9;
             }),
             Contains("--time 1e+09: is beyond the clip") && Contains("it ends at"));
  CHECK_THAT(complaint([](auto& r) { r.rotations = {"left_sholder=0,0,1"}; }),
             Contains("--rotate") && Contains("did you mean `left_shoulder`"));
  CHECK_THAT(complaint([](auto& r) { r.rotations = {"left_shoulder=0,1"}; }), Contains("three numbers"));
  CHECK_THAT(complaint([](auto& r) { r.rotations = {"left_shoulder=0,1,x"}; }), Contains("not a number"));
  CHECK_THAT(complaint([](auto& r) { r.unit = "ft"; }), Contains("--unit"));
  CHECK_THAT(complaint([](auto& r) { r.out.replace_extension(".obj"); }), Contains("band.obj") && Contains(".h5"));
  CHECK_THAT(complaint([](auto& r) { r.pins = {"waists"}; }), Contains("--pin") && Contains("did you mean `waist`"));
  CHECK_THAT(complaint([](auto& r) { r.mesh = "absent.obj"; }), Contains("absent.obj"));
  CHECK_FALSE(std::filesystem::exists(request.out));
}

}  // namespace selvedge::test_dress
