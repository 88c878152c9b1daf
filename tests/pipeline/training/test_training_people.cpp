#include <catch2/catch.hpp>

#include <array>

#include "learned/network/weights_hdf5.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/tools/convert_body.hpp"
#include "pipeline/training/training_checkpoint_hdf5.hpp"
#include "pipeline/weights/import_weights.hpp"
#include "tests/pipeline/fake_checkpoint.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/motions/fake_bvh.hpp"
#include "tests/pipeline/motions/fake_gltf.hpp"
#include "tests/pipeline/training/own_data.hpp"

namespace selvedge::test_training_people {

using fake::Folder;
using fake::has;
using fake::OwnData;
using fake::weights_of;
using fake::write_amass;

namespace {

const OwnData& own_data() {
  static const OwnData data("training_people");
  return data;
}

// A short swing of hips and knees.
Clip swing(int frames) {
  Clip clip{"swing", 30, {}, {}, {}};
  for (int f = 0; f < frames; ++f) {
    BodyPose pose{Points::Zero(24, 3)};
    pose.rotations(smpl::hip, 0) = pose.rotations(smpl::knee, 0) = 0.3 * std::sin(0.3 * f);
    clip.poses.push_back(pose);
  }
  return clip;
}

fake::Rig bvh_swing(int frames) {
  fake::Rig rig{fake::mixamo, 100 * fake::skeleton(), {}};
  for (int f = 0; f < frames; ++f) {
    Points degrees = Points::Zero(24, 3);
    degrees(smpl::hip, 0) = 20 * std::sin(0.3 * f);
    rig.frames.push_back(degrees);
  }
  return rig;
}

// A person of so many garments, and of bodies with so many clips.
void add_person(TrainingWorld& world, int garments, const std::vector<int>& clips) {
  TrainingPerson& person = world.people.emplace_back();
  const int number = static_cast<int>(world.people.size()) - 1;
  for (int k = 0; k < garments; ++k) {
    person.wear.push_back(static_cast<int>(world.wear.size()));
    world.wear.emplace_back().person = number;
  }
  for (const int count : clips) {
    person.bodies.push_back(static_cast<int>(world.bodies.size()));
    TrainingBody& body = world.bodies.emplace_back();
    body.person = number;
    body.weight = count;
    for (int k = 0; k < count; ++k) {
      body.clips.emplace_back();
      body.clips.back().motion.poses.resize(90);
    }
  }
}

// A training that resumes from a checkpoint has the same bits as the one that went on.
void check_resumed(Trainer& whole, const TrainingOptions& options, const std::filesystem::path& file, int steps) {
  write_training_checkpoint(file, whole, {"a\n", "b\n", 0, 0, 0});
  for (int k = 0; k < steps; ++k) train_step(whole);
  TrainingHistory history;
  const auto resumed = read_training_checkpoint(file, options, history);
  for (int k = 0; k < steps; ++k) train_step(*resumed);
  CHECK(weights_of(*resumed) == weights_of(whole));
}

}  // namespace

TEST_CASE("training people: a SMPL file, AMASS files and an OBJ are trained on, and resumed with the same bits",
          "[training]") {
  const OwnData& own = own_data();
  const TrainingOptions options = read_training(own.training);
  auto whole = make_trainer(options);
  const TrainingWorld& world = whole->maker->world;
  REQUIRE(world.people.size() == 1);
  CHECK(world.people[0].name == "anna");
  REQUIRE(world.bodies.size() == 1);
  CHECK(world.bodies[0].clips[0].name == "moves/kick");
  CHECK(world.bodies[0].clips[0].motion.poses.size() == 20);           // 40 at 60 a second
  CHECK(world.wear[0].garments[0].skin.rest.col(1).maxCoeff() < 0.5);  // metres
  CHECK_FALSE(world.wear[0].garments[0].pins.empty());                 // the waist
  for (int k = 0; k < 4; ++k) train_step(*whole);
  const auto file = own.folder.path / "checkpoint.h5";
  check_resumed(*whole, options, file, 4);
  TrainingHistory history;

  // A clip that has changed is named.
  const auto kick = own.folder.path / "moves" / "kick.npz", before = own.folder.path / "kick_before.npz";
  std::filesystem::copy_file(kick, before);
  write_amass(kick, 40, 0.4);
  CHECK_THROWS_WITH(read_training_checkpoint(file, options, history),
                    Catch::Contains("kick.npz") && Catch::Contains("has changed since the run began"));
  std::filesystem::rename(before, kick);
  CHECK(read_training_checkpoint(file, options, history)->counts.step == 4);
}

TEST_CASE("training people: a garment whose seams are not welded is named", "[training]") {
  const OwnData own("training_people_seams");
  const Mesh skirt = fake::small_skirt();
  Points loose(3 * skirt.triangles.rows(), 3);
  Triangles apart(skirt.triangles.rows(), 3);
  for (Eigen::Index t = 0; t < apart.rows(); ++t)
    for (Eigen::Index k = 0; k < 3; ++k) {
      loose.row(3 * t + k) = 100 * skirt.x.row(skirt.triangles(t, k));
      apart(t, k) = static_cast<int>(3 * t + k);
    }
  write_obj(own.folder.path / "loose.obj", loose, apart);
  const auto warnings = [&](const std::string& garment) {
    const TrainingOptions options = read_training(
        own.write("", "seams.yaml"), {"samples.people=[{name: anna, body: {model: body.npz}, clips: [walk], wear: "
                                      "[{garments: [{file: " +
                                      garment + ", unit: cm}]}]}]"});
    return fake::lines(make_trainer(options)->maker->world.warnings);
  };
  CHECK_THAT(warnings("loose.obj"), Catch::Contains("not welded") && Catch::Contains("weld: true"));
  CHECK_THAT(warnings("loose.obj, weld: true"), !Catch::Contains("not welded"));
  CHECK_THAT(warnings("skirt.obj"), !Catch::Contains("not welded"));
}

TEST_CASE("training people: one clip at the body is that clip in the list", "[training]") {
  const OwnData own("training_people_one_clip");
  const std::string wear = "wear: [{garments: [{file: skirt.obj, unit: cm}]}]";
  const auto poses = [&](const std::string& body, const std::string& clips) {
    const TrainingOptions options = read_training(
        own.write("", "one.yaml"), {"samples.people=[{name: anna, body: {" + body + "}, " + clips + wear + "}]"});
    const auto whole = make_trainer(options);
    REQUIRE(whole->maker->world.bodies[0].clips.size() == 1);
    return whole->maker->world.bodies[0].clips[0].motion;
  };
  for (const std::string clip : {"walk", "moves/kick.npz"}) {
    INFO(clip);
    const Clip at_body = poses("model: body.npz, clip: " + clip, ""),
               in_list = poses("model: body.npz", "clips: [" + clip + "], ");
    REQUIRE(at_body.poses.size() == in_list.poses.size());
    CHECK(at_body.poses.back().rotations == in_list.poses.back().rotations);
  }
}

TEST_CASE("training people: a glTF rig with its animation, and a body file with a BVH clip", "[training]") {
  const OwnData own("training_people_files");
  const BodyModel body = fake::small_body();
  fake::write(own.folder, "rig.glb", fake::gltf_of(body, swing(24), body.joints).glb());
  const BodyReport made = convert_body({own.folder.path / "body.npz", {}, {}, "m", own.folder.path / "body.h5"});
  CHECK(made.lacks.empty());
  fake::write(own.folder, "swing.bvh", fake::text_of(bvh_swing(24), std::vector<Vec3>(24, Vec3(0, 98, 0))));
  const std::string wear = "wear: [{garments: [{file: skirt.obj, unit: cm}]}]";
  const TrainingOptions options = read_training(
      own.write("", "files.yaml"), {"samples.people=[{name: rig, body: {model: rig.glb, clip: rig.glb}, " + wear +
                                    "}, {name: walker, body: {model: body.h5}, clips: [swing.bvh, {clip: rig.glb, "
                                    "animation: swing, name: theirs}], " +
                                    wear + "}]"});
  auto whole = make_trainer(options);
  const TrainingWorld& world = whole->maker->world;
  REQUIRE(world.bodies.size() == 2);
  CHECK(world.people[0].body.skin.rest.rows() == body.skin.rest.rows());
  CHECK(world.bodies[0].clips[0].motion.poses.size() == 24);
  CHECK(world.bodies[1].clips[0].name == "swing");
  // Both move the skirt, each as its file says.
  for (const int person : {0, 1}) {
    const PointsF first = skinned_frame(whole->maker->world, person, person, 0, 0).cloth,
                  later = skinned_frame(whole->maker->world, person, person, 0, 5).cloth;
    CHECK(first.allFinite());
    CHECK((later - first).rowwise().norm().maxCoeff() > 0.02);
  }
  for (int k = 0; k < 4; ++k) CHECK(train_step(*whole).adam.taken);
  const auto file = own.folder.path / "files.h5";
  check_resumed(*whole, options, file, 2);
  TrainingHistory history;
  fake::write(own.folder, "swing.bvh", fake::text_of(bvh_swing(25), std::vector<Vec3>(25, Vec3(0, 98, 0))));
  CHECK_THROWS_WITH(read_training_checkpoint(file, options, history), Catch::Contains("swing.bvh"));
}

TEST_CASE("training people: imported checkpoints go on learning on one's own data", "[training]") {
  const OwnData& own = own_data();
  for (const std::string kind : {"hood", "contourcraft"}) {
    INFO(kind);
    const ImportedWeights imported = read_published_weights(
        fake::write_checkpoint(own.folder.path / (kind + ".pth"), fake::published_tensors(kind, 8, 3)));
    WeightFile file;
    file.architecture = imported.architecture;
    file.weights = imported.weights;
    write_weight_file(own.folder.path / (kind + ".h5"), file);
    const auto base =
        config_folder() / "training" / "published" / (kind == "hood" ? "fine_tune.yaml" : "contourcraft_final.yaml");
    std::string text = fake::whole(own.write(""));
    text.replace(0, text.find("steps:"), "base: " + base.string() + "\nweights: " + kind + ".h5\nwidth: 8\n");
    const TrainingOptions options = read_training(fake::write(own.folder, "tune.yaml", text), {"samples.shapes=1"});
    auto trainer = make_trainer(options);
    NetworkWeights theirs = imported.weights;
    std::vector<float> all;
    for (const WeightArray& array : weight_arrays(imported.architecture, theirs))
      all.insert(all.end(), array.data, array.data + array.rows * array.columns);
    CHECK(weights_of(*trainer) == all);
    train_step(*trainer);
    CHECK(trainer->counts.step + trainer->counts.bad == 1);
  }
}

TEST_CASE("training people: errors name place and cure", "[training]") {
  const OwnData& own = own_data();
  const std::string clip = "samples.people.anna.clips=", wear = "samples.people.anna.wear=";
  CHECK(has(own.error({clip + "['moves/none*.npz']"}), "finds no .bvh, .npz, .glb or .gltf file"));
  CHECK(has(own.error({clip + "[moves/lost.npz]"}), "names the missing file"));
  CHECK(has(own.error({clip + "[]"}), "has no clip"));
  write_amass(own.folder.path / "glance.npz", 2, 0.3);  // a sixtieth of a second
  CHECK(has(own.error({clip + "[glance.npz]"}), "has fewer than two poses, at 30 a second"));
  write_amass(own.folder.path / "spun.npz", 40, 1e8);
  CHECK(has(own.error({clip + "[spun.npz]"}), "moves the body absurdly far in frame 1"));
  CHECK(has(own.error({clip + "[walk, walk]"}), "the name `walk` of another"));
  CHECK(has(own.error({wear + "[{garments: [skirt.obj]}]"}), "is not worn"));
  CHECK(has(own.error({wear + "[{garments: [{file: skirt.obj, unit: cm, on: anna}]}]"}), "leave it out"));
  CHECK(has(own.error({"samples.people.anna.body.model=body.npy"}), "body.npy"));
  CHECK(has(own.error({}, "  split: {test: [swing]}\n"), "`swing` names nothing of `people`"));
  CHECK(has(own.error({}, "  split: {test: [anna]}\n"), "names no garment"));
  CHECK(has(own.error({}, "  split: {test: ['moves/*']}\n"), "has nothing to train on"));
  CHECK(own.error({}).empty());
}

TEST_CASE("training people: patterns find files beside a training file that is named without a folder", "[training]") {
  const OwnData& own = own_data();
  write_amass(own.folder.path / "sway.npz", 40, 0.3);
  own.write("");
  const std::string clips_are = "samples.people.anna.clips=";
  const std::filesystem::path before = std::filesystem::current_path();
  for (const char* pattern : {"sway*.npz", "./sway*.npz", "*way.npz", "moves/*.npz", "./moves/*.npz"}) {
    INFO(pattern);
    std::filesystem::current_path(own.folder.path);
    const std::string told = testing::refusal([&] { read_training("own.yaml", {clips_are + "['" + pattern + "']"}); });
    std::filesystem::current_path(before);
    CHECK(told.empty());
  }
}

TEST_CASE("training people: a pattern takes files of clips alone, each with a name of its own", "[training]") {
  const OwnData& own = own_data();
  const std::filesystem::path folder = own.folder.path / "both";
  std::filesystem::create_directories(folder);
  write_amass(folder / "turn.npz", 40, 0.3);
  write_amass(folder / "wave.npz", 40, 0.3);
  std::filesystem::copy_file(folder / "turn.npz", folder / "turn.copy.npz");
  fake::write(own.folder, "both/turn.bvh", "HIERARCHY");
  fake::write(own.folder, "both/README.txt", "where they are from");
  const std::string clips_are = "samples.people.anna.clips=";
  own.write("");
  const TrainingOptions options = read_training(own.training, {clips_are + "['both/*']"});
  std::vector<std::string> names;
  for (const Config& clip : options.samples.people[0]["clips"].items) names.push_back(clip["name"].text());
  CHECK(names == std::vector<std::string>{"both/turn.bvh", "both/turn.copy", "both/turn.npz", "both/wave"});
  CHECK(has(own.error({clips_are + "['both/*.txt']"}), "finds no .bvh, .npz, .glb or .gltf file"));
  CHECK(has(own.error({clips_are + "['both/w*.npz', 'both/wave.npz']"}), "take each once"));
  // A pattern of many stars is no search of all ways to match it.
  const std::string stars = "['both/" + std::string(40, '*') + "a*a*a*a*a*a*a*a*a*a*a*a*b']";
  CHECK(has(own.error({clips_are + stars}), "finds no .bvh"));
}

TEST_CASE("training people: a configuration that is written reads back", "[training]") {
  const OwnData& own = own_data();
  const TrainingOptions options = read_training(own.write("  split: {validation: ['*swing']}\n"));
  const std::string text = training_yaml(options);
  TrainingOptions again = read_training(fake::write(own.folder, "again.yaml", text));
  CHECK(training_yaml(again) == text);
}

TEST_CASE("training people: roll-outs are drawn by weight, and by RandomStream::below where all weigh the same",
          "[training]") {
  TrainingWorld world;
  add_person(world, 2, {3, 1});
  add_person(world, 1, {2});
  world.people[1].weight = 3;
  world.wear[1].weight = 4;
  TrainingOptions options;
  std::array<int, 2> of_people{}, of_wear{}, of_bodies{};
  constexpr int draws = 4000;
  for (int k = 0; k < draws; ++k) {
    const RollRequest drawn = draw_roll(options, world, static_cast<std::uint64_t>(k), 1);
    const int person = world.wear[static_cast<std::size_t>(drawn.wear)].person;
    CHECK(world.bodies[static_cast<std::size_t>(drawn.body)].person == person);
    ++of_people[static_cast<std::size_t>(person)];
    if (person == 1) continue;
    ++of_wear[static_cast<std::size_t>(drawn.wear)];
    ++of_bodies[static_cast<std::size_t>(drawn.body)];
  }
  CHECK(of_people[1] == Approx(0.75 * draws).epsilon(0.05));
  CHECK(of_wear[1] == Approx(0.8 * of_people[0]).epsilon(0.1));
  CHECK(of_bodies[0] == Approx(0.75 * of_people[0]).epsilon(0.1));

  TrainingWorld plain;
  add_person(plain, 3, {5, 5});
  for (std::uint64_t k = 0; k < 50; ++k) {
    RandomStream random = stream_of(8 * options.seed + 1, k);
    const RollRequest drawn = draw_roll(options, plain, k, 1);
    CHECK(drawn.wear == random.below(3));
    CHECK(drawn.body == random.below(2));
    CHECK(drawn.clip == random.below(5));
  }
}

TEST_CASE("training people: the folder of soft tissue is bounded, and so is what is in memory", "[training]") {
  const OwnData& own = own_data();
  const Folder folder("training_flesh");
  TrainingWorld world = make_training_world(read_training(own.write(""), {"samples.flesh=true"}).samples, 1);
  world.cache = folder.path;
  const PointsF before = skinned_frame(world, 0, 0, 0, 3).body;
  skinned_frame(world, 0, 0, 1, 3);
  CHECK(world.tissue_bytes > 0);
  world.most_tissue = 0;  // the next look forgets, after writing
  CHECK(skinned_frame(world, 0, 0, 0, 3).body == before);
  CHECK_FALSE(world.bodies[0].clips[1].tissue);
  const auto files = [&] { return std::distance(std::filesystem::directory_iterator(folder.path / "tissue"), {}); };
  CHECK(files() == 2);
  skinned_frame(world, 0, 0, 0, 5);
  write_soft_tissue(world, 1);
  CHECK(files() == 0);
}

}  // namespace selvedge::test_training_people
