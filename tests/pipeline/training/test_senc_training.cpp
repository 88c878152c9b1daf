#include <catch2/catch.hpp>

#include <cmath>

#include "collision/geometry/error.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/training/hung_sheet.hpp"
#include "pipeline/training/training_checkpoint_hdf5.hpp"
#include "pipeline/training/training_watch.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/training/tiny_training.hpp"

namespace selvedge::test_senc_training {

using fake::Folder;

namespace {

// The garment and clip of `tiny`, with the network and the losses of SENC.
TrainingOptions narrow_senc() {
  TrainingOptions options = fake::tiny_training();
  options.name = "senc";
  options.architecture = "small_senc";
  options.width = 8;
  options.message_steps = 2;
  options.steps = 20;
  options.pool.states = 3;
  options.optimiser.warm_up = 6;
  options.samples.forces = {10, 0.5, 0.3};
  options.objective.volume.weight = {0, 3e4, 0.5, 0.5};
  return options;
}

void write_weights(const std::filesystem::path& path, const Trainer& trainer) {
  WeightFile file;
  file.architecture = trainer.architecture;
  file.weights = trainer.network.weights;
  write_weight_file(path, file);
}

RollMaker& senc_maker() {
  static RollMaker maker{narrow_senc(), trained_architecture(narrow_senc()).features, fake::tiny_maker().world, {}};
  return maker;
}

}  // namespace

TEST_CASE("training with forces: directions cover the sphere, and wind and sheets have their shares", "[training]") {
  TrainingOptions options = narrow_senc();
  options.samples.forces.sheet_share = 0.05;
  Vec3 sum = Vec3::Zero();
  double squares = 0, most = 0;
  int wind = 0, sheets = 0;
  constexpr int count = 3000;
  for (std::uint64_t k = 0; k < count; ++k) {
    const RollRequest request = draw_roll(options, senc_maker().world, k, 1);
    if (request.sheet != HungStart::none) CHECK_FALSE(request.with_body);
    sum += request.force.normalized();
    squares += request.force.normalized().y() * request.force.normalized().y();
    most = std::max(most, request.force.norm());
    wind += request.wind;
    sheets += request.sheet == HungStart::flat;
  }
  CHECK(sum.norm() / count < 0.05);
  CHECK(squares / count == Approx(1.0 / 3).margin(0.03));
  CHECK(most > 9.9);
  CHECK(most <= 10);
  CHECK(std::abs(wind - count / 2) < 100);
  CHECK(std::abs(sheets - count / 20) < 40);
  options.samples.forces.strongest = 0;
  CHECK(draw_roll(options, senc_maker().world, 5, 1).force.isZero(0));
}

TEST_CASE("training with forces: the state has the acceleration that the energy takes in place of gravity",
          "[training]") {
  RollMaker& maker = senc_maker();
  RollRequest request;
  request.first_frame = 30;
  request.frames = 3;
  request.sheet = HungStart::flat;
  request.with_body = false;
  request.force = {0, 0, 4};
  RollingState state;
  begin_roll(make_roll(maker, request), state);
  CHECK((state.now.acceleration.rowwise() - Eigen::RowVector3d(0, -9.81, 4)).cwiseAbs().maxCoeff() < 1e-12);

  // A wind that is as strong on triangles that face it.
  request.wind = true;
  maker.options.samples.noise = 0;
  begin_roll(make_roll(maker, request), state);
  const Points& a = state.now.acceleration;
  CHECK(a.col(2).minCoeff() == Approx(4));
  CHECK(a.col(2).maxCoeff() == Approx(4));
  CHECK((a.col(1).array() + 9.81).abs().maxCoeff() < 1e-12);

  // Energy and gradient: forces, and no gravity.
  const FrameMaking making{maker.features, maker.options.objective, 2, 1};
  const SeenPositions seen = seen_positions(state.roll.scene->rest, state.now, making.features);
  const std::vector<LossTerm> terms =
      add_losses(inputs_of(state, seen, state.now.x, 1), making.losses, state.losses, nullptr);
  const auto has = [&](const char* name) {
    return std::ranges::any_of(terms, [&](const LossTerm& term) { return term.name == name; });
  };
  CHECK(has("forces"));
  CHECK_FALSE(has("gravity"));
  CHECK(has("volume"));
  // A sheet has no inside: no fan closes it.
  CHECK(state.roll.scene->losses.closed.loops.empty());

  // Networks without such inputs know gravity alone.
  begin_roll(make_roll(fake::tiny_maker(), {.first_frame = 30, .frames = 3}), state);
  CHECK(state.now.acceleration.rows() == 0);
}

TEST_CASE("training with forces: a hung sheet is whole, flat and pinned at its upper edge", "[training]") {
  const HungSheet sheet = hung_sheet(0.05);
  const Surface surface = make_surface(static_cast<int>(sheet.rest.rows()), sheet.triangles);
  double area = 0;
  for (Eigen::Index t = 0; t < sheet.triangles.rows(); ++t) {
    const Vec3 twice = (row(sheet.rest, sheet.triangles(t, 1)) - row(sheet.rest, sheet.triangles(t, 0)))
                           .cross(row(sheet.rest, sheet.triangles(t, 2)) - row(sheet.rest, sheet.triangles(t, 0)));
    CHECK(twice.z() > 0);
    area += twice.norm() / 2;
  }
  CHECK(area == Approx(0.25));
  CHECK(surface.vertex_count == 121);
  REQUIRE(sheet.pins.size() == 11);
  for (const int pin : sheet.pins) CHECK(sheet.rest(pin, 1) == sheet.rest.col(1).maxCoeff());
}

TEST_CASE("training of SENC begins as the network that it starts from, and what is resumed has the same bits",
          "[training]") {
  const Folder folder("train_senc");
  TrainingOptions blind = narrow_senc();
  blind.architecture = "small_contour";
  blind.samples.forces = {};
  blind.objective.volume.weight = {0, 0};
  auto before = make_trainer(blind);
  write_weights(folder.path / "hood.h5", *before);

  TrainingOptions options = narrow_senc();
  options.weights = (folder.path / "hood.h5").string();
  auto trainer = make_trainer(options);
  const FeatureTables& tables = trainer->network.weights.tables;
  CHECK(tables.node.mean.end()[-2] == Approx(-9.81f).margin(4));  // of the accelerations
  CHECK(tables.node.deviation.end()[-2] > 0.5f);
  CHECK(tables.node.mean.front() == before->network.weights.tables.node.mean.front());
  RollingState state;
  NextCloth old_frame, new_frame;
  begin_roll(make_roll(senc_maker(), {.first_frame = 30, .frames = 3}), state);
  REQUIRE(predict(*before, frame_making(*before), state, old_frame));
  REQUIRE(predict(*trainer, frame_making(*trainer), state, new_frame));
  CHECK((old_frame.x - new_frame.x).cwiseAbs().maxCoeff() < 1e-6);

  for (int k = 0; k < 6; ++k) train_step(*trainer);
  write_training_checkpoint(folder.path / "checkpoint.h5", *trainer, {});
  TrainingHistory history;
  auto resumed = read_training_checkpoint(folder.path / "checkpoint.h5", options, history);
  bool volume = false;
  for (int k = 0; k < 12; ++k) {
    const SampleRecord one = train_step(*trainer).samples[0], other = train_step(*resumed).samples[0];
    CHECK(one.sum == other.sum);
    for (const LossTerm& term : one.terms) volume |= term.name == "volume";
  }
  CHECK(volume);

  // What it was trained with cannot be left out again, and forces need a network that sees them.
  blind.weights = (folder.path / "senc.h5").string();
  write_weights(blind.weights, *trainer);
  CHECK_THROWS_AS(make_trainer(blind), Error);
  blind.samples.forces.strongest = 1;
  CHECK_THROWS_WITH(trained_architecture(blind), Catch::Contains("sees no forces"));
}

TEST_CASE("training of SENC shows the network edges in space, and it learns from them", "[training]") {
  TrainingOptions options = narrow_senc();
  options.space.radius = 0.06;  // the garment of `tiny` is coarse
  REQUIRE_FALSE(options.contact.edges);
  auto trainer = make_trainer(options);
  const std::vector<std::string>& keys = trainer->architecture.steps[0].edge_keys;
  REQUIRE(keys.back() == "space_edge");
  const int width = trainer->architecture.width;
  const FeatureRows before = trainer->network.weights.steps[0].node.layers[0].weight.rightCols(width);
  for (int k = 0; k < 8; ++k) train_step(*trainer);
  CHECK(trainer->network.weights.steps[0].node.layers[0].weight.rightCols(width) != before);

  const auto pairs_in = [&](bool edges, bool cloth_contact, bool still) {
    RollMaker maker{options, trainer->architecture.features, fake::tiny_maker().world, {}};
    maker.options.contact.edges = edges;
    RollingState state;
    RollRequest request{.first_frame = 30, .frames = 3, .still = still};
    request.cloth_contact = cloth_contact;
    begin_roll(make_roll(maker, request), state);
    Graph graph;
    REQUIRE(raw_graph_of(frame_making(*trainer), trainer->network.weights.tables, state, graph));
    return state.found.space_pairs.pairs.size();
  };
  CHECK(pairs_in(false, false, false) > 0);
  CHECK(pairs_in(true, true, false) > 0);
  CHECK(pairs_in(true, false, false) == 0);  // a roll-out without contact of cloth with cloth
  CHECK(pairs_in(false, false, true) == 0);  // while the cloth falls to rest
}

}  // namespace selvedge::test_senc_training
