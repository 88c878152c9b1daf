#include <catch2/catch.hpp>
#include <fstream>

#include "pipeline/hdf5/checkpoint.hpp"
#include "pipeline/weights/import_weights.hpp"
#include "tests/frame.hpp"
#include "tests/learned/learned_scenes.hpp"
#include "tests/learned/parity_pack.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_learned_parity {

namespace {

constexpr double frame_dt = 1.0 / 30;

// The recorded cloths as one cloth of a scene, with the body as its obstacle.
Scene recorded_scene(const parity::Case& recorded) {
  double area_sum = 0, mass_sum = 0;
  for (const RestTriangle& triangle : flattened(recorded.scene.rest, recorded.scene.cloth.triangles))
    area_sum += area(triangle);
  for (const double mass : recorded.scene.mass) mass_sum += mass;
  Material material;
  material.density = mass_sum / area_sum;
  material.lame_mu = recorded.npz.numbers("lame_mu").values[0] * 4.7e-4;
  material.lame_lambda = recorded.npz.numbers("lame_lambda").values[0] * 4.7e-4;
  material.bending_model = BendingModel::hinge;
  material.bending = recorded.npz.numbers("bending_coeff").values[0];
  Scene scene;
  add_cloth(scene, recorded.scene.rest, recorded.scene.cloth.triangles, material, "recorded");
  for (int v = 0; v < scene.surface.vertex_count; ++v)
    if (recorded.scene.types[static_cast<std::size_t>(v)] == pinned_vertex) scene.pins.push_back(v);
  if (recorded.state.body.rows() > 0) scene.obstacles.push_back({"body", recorded.scene.body, true});
  return scene;
}

LearnedOptions recorded_options(const parity::Case& recorded) {
  LearnedOptions options;
  options.centres = recorded.centres;
  for (std::size_t v = 0; v < recorded.scene.body_types.size(); ++v)
    if (recorded.scene.body_types[v] == omitted_body_vertex)
      options.omitted_body_vertices.push_back(static_cast<int>(v));
  return options;
}

Drive recorded_drive(const parity::Case& recorded, const Scene& scene) {
  Drive drive;
  drive.pins = Points(static_cast<Eigen::Index>(scene.pins.size()), 3);
  for (std::size_t k = 0; k < scene.pins.size(); ++k)
    drive.pins.row(static_cast<Eigen::Index>(k)) = recorded.state.target.row(scene.pins[k]);
  drive.obstacles = {recorded.state.body_target};
  return drive;
}

// Steps from `state` through the recorded steps and compares each with what the authors' code computed.
void follow(const std::string& checkpoint, const std::vector<std::string>& steps, State state, const Scene& scene,
            const LearnedOptions& options) {
  const ImportedWeights network = read_published_weights(parity::folder() / checkpoint);
  const auto stepper = make_learned_stepper(scene, network.architecture, network.weights, options);
  for (const std::string& step : steps) {
    const parity::Case recorded = parity::load(step);
    State to;
    REQUIRE(testing::frame(scene, *stepper, state, recorded_drive(recorded, scene), frame_dt, to).status ==
            StepStatus::accepted);
    INFO(step);
    CHECK((to.x - parity::points(recorded.npz, "pred_pos")).cwiseAbs().maxCoeff() < 3e-7);
    state = to;
  }
}

}  // namespace

TEST_CASE("The learned stepper follows HOOD's recorded roll-out from its start", "[learned]") {
  if (!parity::is_here()) return;
  const parity::Case start = parity::load("hood_step0");
  const Scene scene = recorded_scene(start);
  State state;
  state.x = parity::points(start.npz, "cloth_pos_before_push");
  state.v = Points::Zero(state.x.rows(), 3);
  state.obstacles = {start.state.body};
  follow("hood_w16.pth", {"hood_step1", "hood_step2"}, state, scene, recorded_options(start));
}

TEST_CASE("The learned stepper follows ContourCraft's recorded roll-out from its start", "[learned]") {
  if (!parity::is_here()) return;
  const parity::Case start = parity::load("ccraft_fold_step0");
  const Scene scene = recorded_scene(start);
  State state;
  state.x = start.state.x;
  state.v = start.state.velocity / frame_dt;
  state.obstacles = {start.state.body};
  follow("ccraft_w16.pth", {"ccraft_fold_step0", "ccraft_fold_step1"}, state, scene, recorded_options(start));
}

TEST_CASE("A checkpoint keeps what a learned stepper remembers", "[learned]") {
  const fake::Folder folder("learned_checkpoint");
  const fake::LearnedCase run = fake::learned_case(fake::grid(6, 6), fake::grid(4, 4), {0.001, 0, 0}, 2);
  const fake::NarrowNetwork network = fake::narrow_network("hood");
  const auto step = [&](const State& from, int frame) {
    State to;
    REQUIRE(testing::frame(run.scene, *make_learned_stepper(run.scene, network.architecture, network.weights), from,
                           run.drives[static_cast<std::size_t>(frame)], frame_dt, to)
                .status == StepStatus::accepted);
    return to;
  };
  const State first = step(run.state, 0);
  write_checkpoint(folder.path / "c.h5", first, {});
  const State read = read_checkpoint(folder.path / "c.h5").state;
  CHECK(fake::same_state(first, read));
  CHECK(fake::same_state(step(first, 1), step(read, 1)));
}

TEST_CASE("A process that steps with a network maps no libtorch", "[learned]") {
  const fake::LearnedCase run = fake::learned_case(fake::grid(3, 4), {}, {0, 0, 0}, 1);
  const fake::NarrowNetwork network = fake::narrow_network("hood");
  State to;
  testing::frame(run.scene, *make_learned_stepper(run.scene, network.architecture, network.weights), run.state,
                 run.drives[0], frame_dt, to);
  std::string line;
  int lines = 0;
  for (std::ifstream maps("/proc/self/maps"); std::getline(maps, line); ++lines)
    CHECK(line.find("libtorch") == std::string::npos);
  CHECK(lines > 0);
}

}  // namespace selvedge::test_learned_parity
