#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "collision/search/intersections.hpp"
#include "pipeline/drapes/drape_set.hpp"
#include "pipeline/drapes/drape_training_options.hpp"
#include "pipeline/drapes/stage_file_hdf5.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/refusal.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_drape_set {

using fake::Folder;

namespace {

DrapePath some_path(int joints, int vertices) {
  DrapePath path;
  RandomStream random{3};
  path.shape = draw_body_shape(random, 10, 1);
  path.style = draw_style(random, 1);
  for (int k = 0; k < 2; ++k) {
    path.rotations.push_back(Points::Constant(joints, 3, 0.1 * k));
    path.x.push_back(Points::Constant(vertices, 3, 1.5 + k));
  }
  path.dropped["not at rest"] = 2;
  path.poses_redrawn = 5;
  path.seconds = 1.25;
  return path;
}

std::string error_of(const std::filesystem::path& file, int joints, int vertices) {
  return testing::refusal([&] { read_drape_path(file, joints, vertices); });
}

}  // namespace

TEST_CASE("drapes: a path is read back as it was written, and no other way", "[drapes]") {
  const Folder folder("drape_path");
  const DrapePath path = some_path(24, 7);
  const std::filesystem::path file = drape_path_file(folder.path, 3);
  write_drape_path(file, path);
  const DrapePath read = read_drape_path(file, 24, 7);
  CHECK(read.shape == path.shape);
  CHECK(read.style == path.style);
  CHECK(read.rotations == path.rotations);
  CHECK(read.x == path.x);
  CHECK(read.dropped == path.dropped);
  CHECK(read.poses_redrawn == 5);
  CHECK(read.seconds == 1.25);
  CHECK(error_of(file, 24, 5).find("not a multiple of 5") != std::string::npos);
  CHECK(error_of(fake::write(folder, "text.h5", "no file of ours"), 24, 7) != "");
}

TEST_CASE("drapes: styles change what they say, and keep the cloth free of itself", "[drapes]") {
  DrapeOptions options;
  options.edge = 0.045;
  const DrapeWorld world = make_drape_world(options);
  const Eigen::VectorXd shape = Eigen::VectorXd::Zero(10);
  const Points plain = styled_rest(world, shape, {0, 0, 0, 0});
  CHECK(plain == rest_shape(world.garment, world.body, shape));
  const auto extent = [](const Points& x, int axis) { return x.col(axis).maxCoeff() - x.col(axis).minCoeff(); };
  CHECK(extent(styled_rest(world, shape, {0, 1, 0, 0}), 1) > 1.05 * extent(plain, 1));
  CHECK(extent(styled_rest(world, shape, {0, 0, 1, 0}), 0) > 1.05 * extent(plain, 0));
  CHECK((styled_rest(world, shape, {1, 0, 0, 0}) - plain).rowwise().norm().maxCoeff() > 0.01);
  CHECK((styled_rest(world, shape, {0, 0, 0, 1}) - plain).rowwise().norm().maxCoeff() > 0.01);
  IntersectionCache own, cloth, body;
  for (const Style& style : {Style{1, 1, 1, 1}, Style{1, 0, 1, 0}, Style{0, 1, 0, 1}}) {
    const Points x = styled_rest(world, shape, style);
    CHECK(intersecting_pairs(world.surface, x, own).empty());
    CHECK(intersecting_pairs(world.surface, x, cloth, world.body_surface, world.body.skin.rest, body).empty());
  }
}

TEST_CASE("drapes: frames of vertices are the skinning of the garment", "[drapes]") {
  DrapeOptions options;
  options.edge = 0.045;
  const DrapeWorld world = make_drape_world(options);
  RandomStream random{11};
  const Eigen::VectorXd shape = draw_body_shape(random, 10, 0.7);
  const BodyPose pose = draw_pose(random, world.body.joints, 1);
  const std::vector<VertexFrame> frames = vertex_frames(world, shape, pose);
  const Points rest = shaped(world.garment.skin, shape), posed = skinned(world.garment, world.body, shape, pose);
  for (int v = 0; v < rest.rows(); v += 17) {
    const VertexFrame& frame = frames[static_cast<std::size_t>(v)];
    CHECK((frame.leftCols<3>() * row(rest, v) + frame.col(3) - row(posed, v)).norm() < 1e-12);
  }
}

TEST_CASE("drapes: a stage of a training is read back to the bit", "[drapes]") {
  const Folder folder("drape_stage");
  StageFile stage;
  stage.config = "seed: 1\n";
  stage.step = 12;
  stage.seconds = 3.5;
  stage.random = 0xFEDCBA9876543210;
  stage.csv = "step\n";
  stage.parts.push_back({"g", make_plain_network({4, {6, 6, 1}, Bend::softplus, 50, 1, 2}, 5), {}});
  stage.parts[0].adam.steps = 3;
  stage.parts[0].adam.first = stage.parts[0].adam.second = parameters_of(stage.parts[0].network);
  stage.numbers["mean"] = {1, 2.5};
  write_stage_file(folder.path / "s.h5", stage);
  const StageFile read = read_stage_file(folder.path / "s.h5");
  CHECK(read.config == stage.config);
  CHECK(read.step == 12);
  CHECK(read.random == stage.random);
  CHECK(read.csv == stage.csv);
  CHECK(read.numbers == stage.numbers);
  REQUIRE(read.find("g"));
  CHECK(parameters_of(read.find("g")->network) == parameters_of(stage.parts[0].network));
  CHECK(read.find("g")->network.bend == Bend::softplus);
  CHECK(read.find("g")->network.again_layer == 1);
  CHECK(read.find("g")->adam.second == stage.parts[0].adam.second);
  CHECK(!read.find("h"));
}

TEST_CASE("drapes: the shipped files are of their kinds, and unknown rows are refused", "[drapes]") {
  const std::filesystem::path training = config_folder() / "training";
  CHECK(is_drape_training(training / "refu.yaml"));
  CHECK(!is_drape_training(training / "tiny.yaml"));
  CHECK(read_drape_training(training / "refu.yaml").rows.size() >= 4);
  CHECK(read_drape_training(training / "refu_gcnn.yaml").from_scratch);
  CHECK(read_drape_training(training / "refu_clips.yaml").backbone.kind == BackboneKind::perceptron);
  const DrapeOptions clips = read_drape_options(config_folder() / "data" / "drape_clips_17.yaml");
  CHECK(clips.training == 17 * 8);
  CHECK(clips.test == 17 * 4);
  CHECK_THROWS_AS(read_drape_options(config_folder() / "data" / "drape_clips_5.yaml", {"clips=[wlak]"}), Error);
  CHECK_THROWS_AS(read_drape_options(config_folder() / "data" / "drape_clips_5.yaml", {"test_clips=[]"}), Error);
  CHECK_THROWS_AS(read_drape_training(training / "refu.yaml", {"rows=[lerned]"}), Error);
  CHECK(read_drape_options(config_folder() / "data" / "drape.yaml").name == "drape");
  CHECK_THROWS_AS(read_drape_options(config_folder() / "data" / "drape.yaml", {"garment=tshrt"}), Error);
}

namespace {

const std::filesystem::path repulsion_page_file = source_root() / "docs" / "repulsion.md";
const std::string drape_reference_begins = "<!-- written by: selvedge_tests \"[write-docs]\" -->\n";
std::string drape_references() { return "\n" + drape_reference() + drape_training_reference(); }

}  // namespace

TEST_CASE("docs/repulsion.md has the tables as the program has them", "[drapes]") {
  const std::string text = fake::whole(repulsion_page_file);
  const std::size_t at = text.find(drape_reference_begins);
  REQUIRE(at != std::string::npos);
  CHECK(text.substr(at + drape_reference_begins.size()) == drape_references());
}

TEST_CASE("docs/repulsion.md is written anew", "[.][write-docs]") {
  const std::string text = fake::whole(repulsion_page_file);
  std::ofstream(repulsion_page_file) << text.substr(0,
                                                    text.find(drape_reference_begins) + drape_reference_begins.size())
                                     << drape_references();
}

}  // namespace selvedge::test_drape_set
