#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/hdf5/checkpoint.hpp"
#include "pipeline/hdf5/hdf5_handles.hpp"
#include "pipeline/run/memory_forms.hpp"
#include "pipeline/run/run_inputs_yaml.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/pipeline/run/sheet_over_ball.hpp"
#include "tests/refusal.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_resume {
using Catch::Matchers::Contains;

namespace {

State stepped(const Setup& setup, Stepper& stepper, const State& from) {
  State to;
  const double dt = 1 / setup.run.fps;
  REQUIRE(testing::frame(setup.scene, stepper, from, setup.drive_at(from.time + dt), dt, to).status ==
          StepStatus::accepted);
  return to;
}

}  // namespace

// A sheet falls on a ball. What a run does next must be in its state, wherever it is stopped: no list that the stepper
// keeps may decide anything.
TEST_CASE("A run that is resumed after any frame of an impact goes on with the same bits", "[resume]") {
  const fake::Folder folder("resume");
  const Setup setup = fake::sheet_over_ball(folder, 0.5, 200);
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  State state = setup.initial;
  constexpr int before = 8, frames = 24;  // the ball is met in frame 9
  while (state.frame < frames) {
    const State next = stepped(setup, *stepper, state);
    if (state.frame >= before) {
      const std::filesystem::path file = folder.path / "checkpoint.h5";
      write_checkpoint(file, state, {setup.config, {}, 0});
      const State read = read_checkpoint(file).state;
      CHECK_NOTHROW(check_fits(file, read, setup.scene));
      CHECK_FALSE(misfit(read.memory, setup.scene));
      const State resumed = stepped(setup, *make_stepper(setup), read);
      INFO("stopped after frame " << state.frame << ": off by " << (resumed.x - next.x).cwiseAbs().maxCoeff());
      CHECK(resumed.x == next.x);
      CHECK(resumed.v == next.v);
    }
    state = next;
  }
}

namespace {

// A run of the fake scene that is stopped after its frame 5, made once.
const std::filesystem::path& stopped_run() {
  static const fake::Folder folder("stopped_run");
  static const bool made = [] {
    fake::FallingStepper stepper;
    return fake::run(fake::setup(), stepper, folder.path, false, 5).end == RunEnd::interrupted;
  }();
  REQUIRE(made);
  return folder.path;
}

// Puts a dataset in the place of another; without a shape it is only taken away.
void replace(const std::filesystem::path& file, const std::string& field, hid_t type, const std::vector<hsize_t>& shape,
             const void* data) {
  const h5::Handle open(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  REQUIRE(open.id() >= 0);
  H5Ldelete(open.id(), field.c_str(), H5P_DEFAULT);
  if (shape.empty()) return;
  const h5::Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const h5::Handle made(H5Dcreate2(open.id(), field.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                        H5Dclose);
  REQUIRE(made.id() >= 0);
  if (data) H5Dwrite(made.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
}

// What the run says when it is resumed after `damage` to a copy of it; nothing: it goes on.
std::string refusal(const std::function<void(const std::filesystem::path& folder)>& damage,
                    const Setup& setup = fake::setup()) {
  const fake::Folder folder("refused_run");
  for (const char* name : {"run.h5", "checkpoint.h5"})
    std::filesystem::copy_file(stopped_run() / name, folder.path / name);
  damage(folder.path);
  fake::FallingStepper stepper;
  try {
    fake::run(setup, stepper, folder.path, true);
  } catch (const Error& error) {
    CHECK_FALSE(std::filesystem::exists(folder.path / "resumed.h5"));
    return error.what();
  }
  return {};
}

std::string refused_field(const std::string& file, const std::string& field, hid_t type,
                          const std::vector<hsize_t>& shape, const void* data) {
  return refusal([&](const std::filesystem::path& folder) { replace(folder / file, field, type, shape, data); });
}

std::string refused_state(const std::function<void(State&)>& change) {
  return refusal([&](const std::filesystem::path& folder) {
    Checkpoint read = read_checkpoint(folder / "checkpoint.h5");
    change(read.state);
    write_checkpoint(folder / "checkpoint.h5", read.state, read.inputs);
  });
}

}  // namespace

TEST_CASE("A checkpoint is refused whose arrays have another type, rank or length than the scene's", "[resume]") {
  CHECK(refusal([](const auto&) {}).empty());
  const std::vector<double> numbers(75, 0.5);
  const std::vector<std::int8_t> small(75, 1);
  const int minus = -1, many = 13, seven = 7;
  const double never = 1e30, late = 0.5, nowhere = std::nan("");
  const auto field = [](const std::string& name, hid_t type, const std::vector<hsize_t>& shape, const void* data) {
    return refused_field("checkpoint.h5", name, type, shape, data);
  };
  CHECK_THAT(field("x", H5T_NATIVE_INT8, {25, 3}, small.data()),
             Contains("checkpoint.h5: x") && Contains("8-bit integers, not 64-bit floating-point"));
  CHECK_THAT(field("x", H5T_NATIVE_DOUBLE, {24, 3}, numbers.data()),
             Contains("checkpoint.h5: x") && Contains("24 rows") && Contains("25 vertices"));
  CHECK_THAT(field("x", H5T_NATIVE_DOUBLE, {25, 2}, numbers.data()), Contains("25 x 2"));
  CHECK_THAT(field("v", H5T_NATIVE_DOUBLE, {75}, numbers.data()), Contains("1 dimensions, not 2"));
  CHECK_THAT(field("obstacle_0", H5T_NATIVE_DOUBLE, {3, 3}, numbers.data()),
             Contains("obstacle_0") && Contains("3 rows") && Contains("`still`") && Contains("4 vertices"));
  CHECK_THAT(field("obstacle_1", H5T_NATIVE_DOUBLE, {}, nullptr),
             Contains("are 1 obstacle,") && Contains("the scene has 2"));
  CHECK_THAT(field("frame", H5T_NATIVE_INT, {1}, &minus), Contains("frame") && Contains("is -1"));
  CHECK_THAT(field("frame", H5T_NATIVE_INT, {1}, &many), Contains("is 13") && Contains("12 frames"));
  CHECK_THAT(field("frame", H5T_NATIVE_DOUBLE, {1}, &late), Contains("floating-point numbers, not"));
  CHECK_THAT(field("time", H5T_NATIVE_DOUBLE, {1}, &never), Contains("time") && Contains("1e+30"));
  CHECK_THAT(field("time", H5T_NATIVE_DOUBLE, {1}, &nowhere), Contains("nan"));
  CHECK_THAT(field("time", H5T_NATIVE_DOUBLE, {1}, &late), Contains("0.5 s") && Contains("frame 5"));
  CHECK_THAT(field("pinched", H5T_NATIVE_INT, {1}, &seven), Contains("pinched") && Contains("is 7"));
  CHECK_THAT(field("cut_out", H5T_NATIVE_INT, {1}, &seven), Contains("cut_out"));
  CHECK_THAT(field("cut_out", H5T_NATIVE_INT, {1}, &minus), Contains("cut_out"));
  CHECK_THAT(refusal([](const std::filesystem::path& folder) {
               std::filesystem::resize_file(folder / "checkpoint.h5", 3000);
             }),
             Contains("checkpoint.h5"));
}

TEST_CASE("A checkpoint is refused whose numbers no scene has", "[resume]") {
  CHECK_THAT(refused_state([](State& s) { s.x(2, 1) = 1e30; }), Contains("row 2") && Contains("1e+30"));
  CHECK_THAT(refused_state([](State& s) { s.v(2, 1) = std::nan(""); }), Contains("checkpoint.h5: v"));
  CHECK_THAT(refused_state([](State& s) { s.obstacles[1](0, 0) = -1e30; }), Contains("obstacle_1"));
  CHECK_THAT(refused_state([](State& s) { s.x(2, 1) += 1e-3; }), Contains("frames/x") && Contains("different runs"));
  CHECK_THAT(refused_state([](State& s) { s.obstacles[1](0, 0) += 1; }), Contains("obstacles/1/x"));
}

TEST_CASE("A block of memory is refused that its stepper has not left in the scene", "[resume]") {
  struct Known {
    const char* name;
    Eigen::Index rows, columns;
    RowsOf rows_of;
    bool positions;
  };
  const auto misfit_of = [](const MemoryBlock& block) { return misfit({block}, fake::scene()).value_or(""); };
  for (const Known& k :
       {Known{"bdf2.h", 1, 1, RowsOf::none, false}, Known{"bdf2.x", 25, 3, RowsOf::vertices, true},
        Known{"bdf2.v", 25, 3, RowsOf::vertices, false}, Known{"bdf2.contact", 25, 1, RowsOf::vertices, false},
        Known{"energy.from_nowhere", 1, 1, RowsOf::none, false}, Known{"carried.target", 25, 3, RowsOf::vertices, true},
        Known{"carried.motion", 25, 3, RowsOf::vertices, false},
        Known{"carried.target_before", 25, 3, RowsOf::vertices, true},
        Known{"carried.motion_before", 25, 3, RowsOf::vertices, false},
        Known{"recovering.last_clean", 25, 3, RowsOf::vertices, true},
        Known{"recovering.last_clean_obstacles", 8, 3, RowsOf::obstacle_vertices, true},
        Known{"resting.seconds", 1, 1, RowsOf::cloths, false}, Known{"resting.place", 25, 3, RowsOf::vertices, true},
        Known{"resting.air", 2, 3, RowsOf::none, false}, Known{"hybrid.trust", 1, 3, RowsOf::none, false},
        Known{"learned.velocity", 25, 3, RowsOf::vertices, false},
        Known{"learned.previous", 25, 3, RowsOf::vertices, true},
        Known{"learned.body_previous", 8, 3, RowsOf::obstacle_vertices, true}}) {
    INFO(k.name);
    const auto block = [&](Eigen::Index rows, Eigen::Index columns) {
      return MemoryBlock{k.name, MemoryRows::Ones(rows, columns), k.rows_of, k.positions};
    };
    CHECK(misfit_of(block(k.rows, k.columns)).empty());
    CHECK_THAT(misfit_of(block(k.rows + 1, k.columns)), Contains(k.name) && Contains("in the scene"));
    CHECK_THAT(misfit_of(block(k.rows, k.columns + 1)), Contains("in the scene"));
    CHECK_THAT(misfit_of(block(0, k.columns)), Contains("in the scene"));
    MemoryBlock other = block(k.rows, k.columns);
    other.positions = !other.positions;
    CHECK_FALSE(misfit_of(other).empty());
    other = block(k.rows, k.columns);
    other.rows(0, 0) = 1e30;
    CHECK_THAT(misfit_of(other), Contains("1e+30"));
  }
  CHECK_FALSE(misfit_of({"hybrid.trust", MemoryRows::Constant(1, 3, 0.5)}).empty());
  CHECK_FALSE(misfit_of({"own.block", MemoryRows::Zero(3, 1), RowsOf::triangles}).empty());
  CHECK(misfit_of({"own.block", MemoryRows::Zero(32, 1), RowsOf::triangles}).empty());
  CHECK_THAT(refused_state([](State& s) {
               s.memory = {{"bdf2.x", MemoryRows::Zero(3, 3), RowsOf::vertices, true}};
             }),
             Contains("memory") && Contains("`bdf2.x` is 3 x 3, in the scene 25 x 3"));
  CHECK_THAT(refused_state([](State& s) {
               s.memory = {{"a.b", MemoryRows::Zero(3, 3), static_cast<RowsOf>(9)}};
             }),
             Contains("memory_rows_of"));
}

TEST_CASE("A trajectory is refused that is of another scene than the checkpoint", "[resume]") {
  const auto field = [](const std::string& name, hid_t type, const std::vector<hsize_t>& shape, const void* data) {
    return refused_field("run.h5", name, type, shape, data);
  };
  const std::vector<int> ints(4096, 1);
  const std::vector<float> floats(4096, 1);
  const std::vector<double> doubles(4096, 1);
  const std::int64_t few = 3, minus = -4;
  CHECK_THAT(refusal([](const std::filesystem::path& folder) {
               Scene other = fake::scene(4);
               TrajectoryWriter writer(folder / "run.h5", trajectory_info(other, fake::setup().config, "falling", 30));
               for (int k = 0; k < 9; ++k) writer.append(fake::frame(other, k));
               writer.close();
             }),
             Contains("run.h5: cloth/rest") && Contains("has 16 vertices") && Contains("the scene has 25"));
  CHECK_THAT(refusal([](const std::filesystem::path& folder) {
               const h5::Handle open(H5Fopen((folder / "run.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
               H5Ldelete(open.id(), "obstacles", H5P_DEFAULT);
               H5Ldelete(open.id(), "frames/switched_off", H5P_DEFAULT);
             }),
             Contains("run.h5: obstacles") && Contains("has 0 obstacles, the scene has 2"));
  CHECK_THAT(field("obstacles/1", 0, {}, nullptr), Contains("frames/switched_off"));
  CHECK_THAT(field("frames/switched_off", H5T_NATIVE_INT, {12, 3}, ints.data()), Contains("frames/switched_off"));
  CHECK_THAT(field("frames/x", H5T_NATIVE_INT, {12, 25, 3}, ints.data()), Contains("frames/x") && Contains("integers"));
  CHECK_THAT(field("frames/x", H5T_NATIVE_FLOAT, {12, 75}, floats.data()), Contains("frames/x"));
  CHECK_THAT(field("frames/x", H5T_NATIVE_FLOAT, {12, 24, 3}, floats.data()), Contains("frames/x"));
  CHECK_THAT(field("frames/x", H5T_NATIVE_FLOAT, {12, 25, 3}, floats.data()), Contains("other positions in frame 5"));
  CHECK_THAT(field("frames/report", H5T_NATIVE_DOUBLE, {12}, doubles.data()), Contains("frames/report"));
  CHECK_THAT(field("frames/bad_triangles", H5T_NATIVE_INT, {12, 2}, ints.data()), Contains("frames/bad_triangles"));
  CHECK_THAT(field("obstacles/1/x", H5T_NATIVE_FLOAT, {12, 3, 3}, floats.data()),
             Contains("obstacles/1") && Contains("names a vertex"));
  CHECK_THAT(field("obstacles/1/x", H5T_NATIVE_FLOAT, {2, 4, 3}, floats.data()), Contains("obstacles/1/x"));
  CHECK_THAT(field("cloth/rest", H5T_NATIVE_FLOAT, {25, 3}, floats.data()), Contains("other places at rest"));
  CHECK_THAT(field("cloth/rest", H5T_NATIVE_INT, {25, 3}, ints.data()), Contains("integers"));
  CHECK_THAT(field("cloth/pins", H5T_NATIVE_INT, {1}, ints.data()), Contains("has 1 pins, the scene has 0"));
  CHECK_THAT(field("fps", H5T_NATIVE_DOUBLE, {1}, doubles.data()),
             Contains("fps") && Contains("is 1, in the scene 30"));
  CHECK_THAT(field("frames_complete", H5T_NATIVE_INT64, {1}, &few), Contains("counts 3 frames"));
  CHECK_THAT(field("frames_complete", H5T_NATIVE_INT64, {1}, &minus), Contains("counts -4 frames"));
}

TEST_CASE("A run is resumed only with the files that it began with", "[resume]") {
  const fake::Folder folder("changed_files");
  const std::string scene =
      "cloths: [{mesh: cloth.obj}]\n"
      "obstacles: [{sequence: {pattern: f%02d.obj, first: 1, fps: 30}}, {mesh: still.ply, translate: [9, 0, 0]}]\n"
      "run: {frames: 6}\n";
  const std::string sheet = "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n";
  const auto body = [](double y) { return fmt::format("v 0 {0} 0\nv 1 {0} 0\nv 0 {0} 1\nf 1 3 2\n", y); };
  fake::write(folder, "cloth.obj", sheet);
  for (int k = 1; k < 4; ++k) fake::write(folder, fmt::format("f{:02d}.obj", k), body(-2 + 0.01 * k));
  fake::write(folder, "still.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
              "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 0 1\n3 0 2 1\n");
  const std::filesystem::path file = fake::write(folder, "scene.yaml", scene);
  const auto run = [&](bool resume, int frames) {
    const Setup setup = read_setup(file);
    return fake::run(setup, *make_stepper(setup), folder.path / "out", resume, frames);
  };
  std::vector<std::string> names;
  for (const InputFile& input : run_inputs(read_setup(file)).files) names.push_back(input.name);
  std::ranges::sort(names);
  CHECK(names == std::vector<std::string>{"cloth.obj", "f01.obj", "f02.obj", "f03.obj", "still.ply"});
  for (const std::string& changed : names) {
    INFO(changed);
    REQUIRE(run(false, 2).end == RunEnd::interrupted);
    const std::string before = fake::whole(folder.path / changed);
    fake::write(folder, changed, before + "\n");  // the same mesh
    CHECK_THROWS_WITH(run(true, 1 << 30), Contains("checkpoint.h5") && Contains("`" + changed + "` has changed"));
    fake::write(folder, changed, before);
    CHECK(run(true, 1 << 30).end == RunEnd::finished);
  }
  REQUIRE(run(false, 2).end == RunEnd::interrupted);
  fake::write(folder, "f04.obj", body(-1.9));
  CHECK_THROWS_WITH(run(true, 1 << 30), Contains("`f04.obj`"));
}

TEST_CASE("A run is resumed only with what code has made of its files", "[resume]") {
  Setup other = fake::setup();
  other.scene.rest_triangle[3] *= 1 + 1e-12;
  CHECK_THAT(refusal([](const auto&) {}, other), Contains("cloth/rest_triangles"));
  other = fake::setup();
  other.drive_at = [inner = other.drive_at](double time) {
    Drive drive = inner(time);
    drive.obstacles[1](2, 1) += 1e-9;
    return drive;
  };
  CHECK_THAT(refusal([](const auto&) {}, other), Contains("scene_hash"));
  other = fake::setup();
  other.config = "run: {frames: 13}\n";
  CHECK_THAT(refusal([](const auto&) {}, other), Contains("`run: {frames: 12}` then, `run: {frames: 13}` now"));
}

// Folders that outsiders have broken; see their README.
TEST_CASE("The folders of the cases are refused with file and field", "[resume]") {
  const std::filesystem::path cases = source_root() / ".." / "shared" / "cases" / "resume_files";
  if (!std::filesystem::exists(cases)) {
    WARN("skipped: " << cases << " is not there");
    return;
  }
  const fake::Folder folder("resume_cases");
  std::filesystem::copy(cases, folder.path / "c", std::filesystem::copy_options::recursive);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path / "c"))
    std::filesystem::permissions(entry.path(), std::filesystem::perms::owner_all);
  std::filesystem::permissions(folder.path / "c", std::filesystem::perms::owner_all);
  const Setup setup = read_setup(folder.path / "c" / "long.yaml");
  const auto refused = [&](const std::string& out, const std::string& checkpoint) -> std::string {
    const std::filesystem::path place = folder.path / "c" / out;
    if (!checkpoint.empty())
      std::filesystem::copy_file(folder.path / "c" / checkpoint, place / "checkpoint.h5",
                                 std::filesystem::copy_options::overwrite_existing);
    RunRequest request;
    request.out = place;
    return testing::refusal([&] { resume_scene(setup, *make_stepper(setup), request); });
  };
  CHECK_THAT(refused("ol", ""), Contains("ol/"));
  CHECK_THAT(refused("without_obstacles", ""), Contains("without_obstacles/"));
  for (const char* name : {"frame_negative.h5", "x_1e30.h5", "x_int8.h5"})
    CHECK_THAT(refused("without_obstacles", name), Contains("checkpoint.h5"));
}

}  // namespace selvedge::test_resume
