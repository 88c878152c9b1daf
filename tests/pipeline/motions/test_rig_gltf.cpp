#include <sys/stat.h>

#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_hdf5.hpp"
#include "pipeline/bodies/body_outward.hpp"
#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/motions/clip_procedural.hpp"
#include "pipeline/motions/rig_gltf.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/tools/convert_body.hpp"
#include "tests/pipeline/fake_body.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/motions/fake_gltf.hpp"

namespace selvedge::test_rig_gltf {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

Clip some_motion(int joints, int frames) {
  Clip clip{"swing", 30, {}, {}, {}};
  for (int f = 0; f < frames; ++f) clip.poses.push_back(fake::pose(joints, static_cast<unsigned>(f + 1), 0.6));
  return clip;
}

// Where the corners of triangles are: vertices may be numbered otherwise.
Points corners(const Points& x, const Triangles& triangles) {
  Points all(triangles.size(), 3);
  for (Eigen::Index i = 0; i < triangles.size(); ++i) all.row(i) = x.row(triangles.data()[i]);
  return all;
}

void same_poses(const BodyModel& body, const Clip& clip, const GltfRig& rig, const Clip& read, double tolerance) {
  REQUIRE(read.poses.size() == clip.poses.size());
  for (std::size_t f = 0; f < clip.poses.size(); ++f) {
    const Points wanted = corners(posed(body, {}, clip.poses[f]), body.skin.triangles);
    const Points found = corners(posed(rig.body, {}, read.poses[f]), rig.body.skin.triangles);
    CHECK((found - wanted).cwiseAbs().maxCoeff() < tolerance);
  }
}

// One more mesh of the same skin, which lies in the same space.
void add_mesh(const BodyModel& body, const std::string& name, fake::GltfFile& file) {
  const fake::GltfFile own = fake::gltf_of(body, {}, body.joints);
  nlohmann::ordered_json mesh = own.json["meshes"][0];
  const std::size_t accessors = file.json["accessors"].size(), views = file.json["bufferViews"].size();
  for (nlohmann::ordered_json view : own.json["bufferViews"]) {
    view["byteOffset"] = view["byteOffset"].get<std::size_t>() + file.bytes.size();
    file.json["bufferViews"].push_back(view);
  }
  for (nlohmann::ordered_json accessor : own.json["accessors"]) {
    accessor["bufferView"] = accessor["bufferView"].get<std::size_t>() + views;
    file.json["accessors"].push_back(accessor);
  }
  for (nlohmann::ordered_json& primitive : mesh["primitives"]) {
    for (auto& [what, number] : primitive["attributes"].items()) number = number.get<std::size_t>() + accessors;
    primitive["indices"] = primitive["indices"].get<std::size_t>() + accessors;
  }
  mesh["name"] = name;
  file.json["meshes"].push_back(mesh);
  file.json["nodes"].push_back({{"name", name}, {"mesh", 1}, {"skin", 0}});
  file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size() - 1);
  file.bytes += own.bytes;
}

std::vector<std::string> mixamo_names() {
  std::vector<std::string> names = {"Hips"};
  for (const char* name :
       {"UpLeg", "UpLeg",    "Spine",    "Leg",  "Leg", "Spine1", "Foot",    "Foot",    "Spine2", "ToeBase", "ToeBase",
        "Neck",  "Shoulder", "Shoulder", "Head", "Arm", "Arm",    "ForeArm", "ForeArm", "Hand",   "Hand"})
    names.emplace_back(name);
  std::vector<std::string> all;
  int pair = 0;
  for (const std::string& name : names) {
    const bool single = name.starts_with("Spine") || name == "Hips" || name == "Neck" || name == "Head";
    all.push_back("mixamorig:" + std::string(single ? "" : pair++ % 2 == 0 ? "Left" : "Right") + name);
  }
  return all;
}

}  // namespace

TEST_CASE("glTF: a rigged body and its motion come back from below an armature of another unit", "[rig_gltf]") {
  const Folder folder("gltf_back");
  const BodyModel body = fake::body(6, 40, 0, false);
  const Clip clip = some_motion(6, 5);
  const auto path = fake::write(folder, "rig.glb", fake::gltf_of(body, clip, body.joints).glb());
  const GltfRig rig = read_gltf_rig(path);
  CHECK(rig.body.name == "rig");
  CHECK(rig.body.skin.rest.rows() == 40);  // corners at one place are one vertex
  CHECK(std::ranges::is_permutation(rig.body.joints, body.joints));
  CHECK((corners(rig.body.skin.rest, rig.body.skin.triangles) - corners(body.skin.rest, body.skin.triangles))
            .cwiseAbs()
            .maxCoeff() < 2e-6);
  const Points wanted = joint_positions(body, {}), found = joint_positions(rig.body, {});
  for (int j = 0; j < found.rows(); ++j) {
    const auto at = std::ranges::find(body.joints, rig.body.joints[static_cast<std::size_t>(j)]) - body.joints.begin();
    CHECK((found.row(j) - wanted.row(at)).norm() < 2e-6);
  }
  same_poses(body, clip, rig, read_gltf_clip(rig, "", 30), 1e-5);
  CHECK(read_gltf_clip(rig, "swing", 60).poses.size() == 9);  // 4 / 30 s, both ends
  CHECK_THROWS_WITH(read_gltf_clip(rig, "walk", 30), Contains("no animation `walk`") && Contains("swing"));
}

TEST_CASE("glTF: the meshes of a body are chosen by name, and its file keeps them", "[rig_gltf]") {
  const Folder folder("gltf_meshes");
  const BodyModel body = fake::body(6, 40, 0, false);
  BodyModel inner = body;
  inner.skin.rest.array() *= 0.5;
  fake::GltfFile file = fake::gltf_of(body, {}, body.joints);
  add_mesh(inner, "joints", file);
  const auto path = fake::write(folder, "rig.glb", file.glb());
  BodyRequest request{path, {}, {}, "m", folder.path / "body.h5"};
  const BodyReport all = convert_body(request);
  CHECK(all.meshes == std::vector<std::string>{"skin", "joints"});
  CHECK(all.vertices == 80);
  REQUIRE_FALSE(all.crossings.between.empty());  // random triangles
  const auto text = std::ranges::find_if(all.crossings.between, [](const auto& one) { return one.a != one.b; });
  CHECK(text != all.crossings.between.end());
  const BodyModel read = read_body(request.out);
  REQUIRE(read.meshes.size() == 2);
  CHECK(read.meshes[1].first == "joints");
  CHECK(read.meshes[1].second.size() == 40);
  CHECK(own_crossings(read, {}).pairs() == all.crossings.pairs());
  CHECK_THAT(body_text(all), Contains("crosses itself") && Contains("`skin` with `joints`"));
  CHECK_THAT(body_json(all), Contains("\"own_pairs\"") && Contains("\"with\": \"joints\""));

  request.meshes.without = {"joints"};
  const BodyReport without = convert_body(request);
  request.meshes = {{"skin"}, {}};
  const BodyReport only = convert_body(request);
  CHECK(without.vertices == 40);
  CHECK(without.crossings.pairs() == only.crossings.pairs());
  CHECK(without.crossings.pairs() < all.crossings.pairs());
  request.meshes = {{}, {"Joints"}};
  CHECK_THROWS_WITH(convert_body(request), Contains("no mesh `Joints`") && Contains("skin, joints"));
  request.meshes = {{}, {"skin", "joints"}};
  CHECK_THROWS_WITH(convert_body(request), Contains("no triangles"));
}

TEST_CASE("glTF: an animation is taken at a rate that meets its keys, and a late begin is said", "[rig_gltf]") {
  const Folder folder("gltf_rate");
  const BodyModel body = fake::body(6, 40, 0, false);
  const auto rate = [&](double fps, double later, std::vector<std::string>& warnings) {
    Clip clip = some_motion(6, 5);
    clip.fps = fps;
    GltfRig rig = read_gltf_rig(fake::write(folder, "rig.glb", fake::gltf_of(body, clip, body.joints).glb()));
    for (GltfTrack& track : rig.scene.animations[0].tracks) track.times.array() += later;
    return gltf_rate(rig, "", warnings);
  };
  std::vector<std::string> warnings;
  CHECK(rate(30, 0, warnings) == 60);
  CHECK(rate(24, 0, warnings) == 72);
  CHECK(rate(25, 0, warnings) == 75);
  CHECK(warnings.empty());
  CHECK(rate(24, 1.0 / 24, warnings) == 72);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("begins at 0.04167 s") && Contains("first_frame: 3"));
  CHECK(rate(101.7, 0, warnings) == 240);
  CHECK_THAT(warnings.back(), Contains("no steady rate"));
}

TEST_CASE("glTF: parts of a body that touch are joined only where they move alike", "[rig_gltf]") {
  const Folder folder("gltf_touching");
  // The second half repeats the first one's vertices and triangles, turned over.
  BodyModel body = fake::body(4, 12, 0, false);
  const Eigen::Index n = body.skin.rest.rows(), m = body.skin.triangles.rows();
  body.skin.rest = Points(body.skin.rest.replicate(2, 1));
  body.regressor.conservativeResize(body.regressor.rows(), 2 * n);
  body.skin.triangles = Triangles(body.skin.triangles.replicate(2, 1));
  body.skin.triangles.bottomRows(m) = (body.skin.triangles.topRows(m).rowwise().reverse().array() + n).matrix();
  std::vector<Eigen::Triplet<double>> weights;
  for (int v = 0; v < 2 * n; ++v) weights.emplace_back(v, v < n ? 1 : 2, 1.0);
  const auto joined = [&] {
    body.skin.weights = SkinWeights(2 * n, 4);
    body.skin.weights.setFromTriplets(weights.begin(), weights.end());
    const auto path = fake::write(folder, "rig.glb", fake::gltf_of(body, {}, body.joints).glb());
    return read_gltf(path).mesh;
  };
  CHECK(joined().x.rows() == 2 * n);
  CHECK(joined().triangles.rows() == 2 * m);
  for (int v = 0; v < 2 * n; ++v) weights[v] = {v, 1, 1.0};
  CHECK(joined().x.rows() == n);
}

TEST_CASE("glTF: morph targets count as the file has them, and their animation is said to be left out", "[rig_gltf]") {
  const Folder folder("gltf_morphs");
  const BodyModel body = fake::body(6, 40, 0, false);
  fake::GltfFile file = fake::gltf_of(body, some_motion(6, 5), body.joints);
  auto& primitive = file.json["meshes"][0]["primitives"][0];
  const Points still = read_gltf(fake::write(folder, "still.glb", file.glb())).mesh.x;
  const int count = file.json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()]["count"];
  const int target = file.numbers(Eigen::RowVector3d(0, 0, 8).replicate(count, 1), "VEC3");
  primitive["targets"] = {{{"POSITION", target}}, {{"POSITION", target}}};
  const auto rig = [&] { return read_gltf_rig(fake::write(folder, "morph.glb", file.glb())); };
  CHECK(rig().scene.mesh.x == still);
  file.json["meshes"][0]["weights"] = {0.25, 0.5};
  CHECK((rig().scene.mesh.x.rowwise() - Eigen::RowVector3d(0, 0, 6) - still).isZero(1e-5));
  auto& node = *std::ranges::find_if(file.json["nodes"], [](const auto& one) { return one.contains("mesh"); });
  node["weights"] = {1, 0};
  CHECK((rig().scene.mesh.x.rowwise() - Eigen::RowVector3d(0, 0, 8) - still).isZero(1e-5));

  const auto animated = [&](double last) {
    fake::GltfFile moved = file;
    auto& animation = moved.json["animations"][0];
    const int values = moved.numbers((Eigen::VectorXd(4) << 1, 0, last, 0).finished(), "SCALAR");
    const int times = moved.numbers(Eigen::Vector2d(0, 0.1), "SCALAR");
    const auto number = std::distance(file.json["nodes"].begin(), std::ranges::find(file.json["nodes"], node));
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()}, {"target", {{"node", number}, {"path", "weights"}}}});
    animation["samplers"].push_back({{"input", times}, {"output", values}});
    std::vector<std::string> warnings;
    gltf_rate(read_gltf_rig(fake::write(folder, "moved.glb", moved.glb())), "", warnings);
    return warnings;
  };
  CHECK(animated(1).empty());
  REQUIRE(animated(0.5).size() == 1);
  CHECK_THAT(animated(0.5)[0], Contains("morph targets"));
}

TEST_CASE("glTF: a person's joints get SMPL's names, and scenes play the file's animation", "[rig_gltf]") {
  const Folder folder("gltf_person");
  const BodyModel whole = make_mannequin();
  BodyModel body = whole;
  // Without hands, which a Mixamo rig calls otherwise: they go with the wrists.
  const int joints = smpl::joints - 2;
  SkinWeights weights = body.skin.weights.leftCols(joints);
  for (int v = 0; v < weights.rows(); ++v) weights.coeffRef(v, smpl::wrist) += whole.skin.weights.coeff(v, smpl::hand);
  for (int v = 0; v < weights.rows(); ++v)
    weights.coeffRef(v, smpl::wrist + 1) += whole.skin.weights.coeff(v, smpl::hand + 1);
  body.skin.weights = weights;
  body.skin.weights.prune(0.0);
  body.skin.shape_directions.resize(body.skin.shape_directions.rows(), 0);
  body.skin.pose_directions.resize(body.skin.pose_directions.rows(), 0);
  body.regressor = SkinWeights(body.regressor.topRows(joints));
  body.joints.resize(joints);
  body.parents.resize(joints);
  Clip clip = make_clip("walk", joint_positions(whole, {}), whole.skin.rest.col(1).minCoeff());
  clip.poses.resize(10);
  for (BodyPose& pose : clip.poses) pose = matched(pose, clip.joints, body.joints);

  const auto path = fake::write(folder, "person.glb", fake::gltf_of(body, clip, mixamo_names()).glb());
  const GltfRig rig = read_gltf_rig(path);
  std::vector<std::string> wanted = body.joints;
  CHECK(std::ranges::is_permutation(rig.body.joints, wanted));
  CHECK(is_closed(make_surface(static_cast<int>(rig.body.skin.rest.rows()), rig.body.skin.triangles)));
  same_poses(body, clip, rig, read_gltf_clip(rig, "", 30), 1e-5);

  const BodyReport report = convert_body({path, {}, {}, "m", folder.path / "person.h5"});
  CHECK(report.closed);
  CHECK(report.t_pose);
  CHECK(report.animations == std::vector<std::string>{"walk"});
  const auto scene = [&](const std::string& obstacle) {
    return read_setup(fake::write(folder, "scene.yaml",
                                  "cloths:\n  - {rectangle: {size: [0.3, 0.3], resolution: 3}, translate: [0, 3, 0]}\n"
                                  "obstacles:\n  - {name: person, body: " +
                                      obstacle + "}\n"));
  };
  for (const std::string model : {"person.glb", "person.h5"}) {
    const Setup setup = scene("{model: " + model + ", clip: person.glb, room: 0}");
    for (const int frame : {0, 4, 9}) {
      const Points found = corners(setup.drive_at(frame / 30.0).obstacles.at(0), rig.body.skin.triangles);
      const Points x = corners(posed(body, {}, clip.poses[static_cast<std::size_t>(frame)]), body.skin.triangles);
      CHECK((found - x).cwiseAbs().maxCoeff() < 1e-5);
    }
  }
  CHECK_NOTHROW(scene("{model: person.glb, clip: squat, blend_in: 1}"));  // by SMPL's names
  CHECK_THROWS_WITH(scene("{model: mannequin, clip: person.glb}"), Contains("another skeleton"));
  CHECK_THROWS_WITH(scene("{model: person.glb, clip: walk, animation: walk}"), Contains("no glTF file"));
}

TEST_CASE("glTF: buffers are opened below the file's folder, nothing else is", "[rig_gltf]") {
  const Folder folder("gltf_paths");
  const BodyModel body = fake::body(4, 12, 0, false);
  const fake::GltfFile good = fake::gltf_of(body, some_motion(4, 3), body.joints);
  const std::filesystem::path own = folder.path / "own";
  std::filesystem::create_directories(own / "sub");
  fake::write(folder, "outside.bin", good.bytes);
  fake::write(folder, "own/sub/a b.bin", good.bytes);
  std::filesystem::create_symlink("../outside.bin", own / "link.bin");
  REQUIRE(::mkfifo((own / "pipe.bin").c_str(), 0600) == 0);
  const auto read = [&](const std::string& uri, const std::string& image = "") {
    fake::GltfFile file = good;
    file.json["buffers"] = {{{"byteLength", good.bytes.size()}, {"uri", uri}}};
    if (!image.empty()) file.json["images"] = {{{"uri", image}}};
    return read_gltf(fake::write(folder, "own/a.gltf", file.json.dump()));
  };
  for (const std::string uri : {"sub/a b.bin", "sub/a%20b.bin", "sub/../sub/a b.bin", "./sub/a%20%62.bin"})
    CHECK(read(uri).mesh.x.rows() == 12);
  for (const std::string uri : {"../outside.bin", "sub/../../outside.bin", "%2e%2e/outside.bin", "..%2Foutside.bin",
                                "link.bin", "/etc/passwd", "pipe.bin", "sub", "."}) {
    INFO(uri);
    CHECK_THROWS_WITH(read(uri), Contains("a.gltf: buffer 0") && Contains("names"));
  }
  CHECK_THROWS_WITH(read((folder.path / "outside.bin").string()), Contains("outside.bin`, which is not below"));
  CHECK_THROWS_WITH(read("absent.bin"), Contains("absent.bin"));
  // An image is never opened: one that is a pipe would never end.
  for (const std::string image : {"pipe.bin", "../outside.bin", "/etc/passwd"})
    CHECK(read("sub/a b.bin", image).mesh.x.rows() == 12);
}

TEST_CASE("glTF: what is wrong is named", "[rig_gltf]") {
  const Folder folder("gltf_wrong");
  const BodyModel body = fake::body(4, 12, 0, false);
  const fake::GltfFile good = fake::gltf_of(body, some_motion(4, 3), body.joints);
  const auto refused = [&](const std::string& bytes, const std::string& words) {
    const auto path = fake::write(folder, "bad.glb", bytes);
    CHECK_THROWS_WITH(read_gltf_clip(read_gltf_rig(path), "", 30), Contains("bad.glb") && Contains(words));
  };
  const auto changed = [&](const std::string& pointer, const nlohmann::ordered_json& value, const std::string& words) {
    fake::GltfFile file = good;
    file.json[nlohmann::ordered_json::json_pointer(pointer)] = value;
    INFO(pointer);
    refused(file.glb(), words);
  };
  const std::string whole = good.glb();
  refused("", "bad.glb: is no glTF");
  refused("glTF", "no glTF");
  refused(whole.substr(0, whole.size() / 2), "no glTF");
  refused(whole.substr(0, whole.size() - 8), "no glTF");
  CHECK_THROWS_WITH(read_gltf(folder.path / "nowhere.glb"), Contains("is not there"));

  const auto& attributes = good.json["meshes"][0]["primitives"][0]["attributes"];
  const std::string position = std::to_string(attributes["POSITION"].get<int>()),
                    joints = std::to_string(attributes["JOINTS_0"].get<int>());
  changed("/extensionsRequired", {"KHR_draco_mesh_compression"}, "KHR_draco_mesh_compression");
  changed("/nodes/6/skin", -1, "is not used by any mesh");
  changed("/nodes/1/children", {2, 6}, "two parents");
  changed("/meshes/0/primitives/0/mode", 1, "triangles");
  changed("/accessors/" + position + "/count", 100000, "beyond its buffer");
  changed("/accessors/" + position + "/byteOffset", 4000000000u, "beyond its buffer");
  changed("/accessors/" + position + "/type", "VEC2", "2 numbers a row, not 3");
  changed("/accessors/" + position + "/bufferView", 99, "names entry 99");
  changed("/accessors/" + position + "/componentType", 7, "bad.glb");
  changed("/skins/0/joints", {1, 2}, "beyond the skin's 2");
  changed("/nodes/2/scale", {1, 1, 2}, "scaled");
  changed("/nodes/3/scale", {2, 2, 2}, "scaled");
  changed("/nodes/0/matrix", {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "Armature");
  changed("/animations/0/samplers/0/input", 0, "times");
  changed("/animations/0/channels/0/target/node", 77, "names entry 77");
  changed("/animations", nlohmann::ordered_json::array(), "no animations");

  fake::GltfFile file = good;  // a joint goes where another should
  auto& channels = file.json["animations"][0]["channels"];
  CHECK((channels[3]["target"]["node"] == 3 && channels[3]["target"]["path"] == "translation"));
  channels[3]["sampler"] = channels[1]["sampler"];
  refused(file.glb(), "against its parent");

  file = good;
  const auto view = file.json["accessors"][attributes["WEIGHTS_0"].get<std::size_t>()]["bufferView"].get<std::size_t>();
  const auto begin = file.json["bufferViews"][view]["byteOffset"].get<std::size_t>();
  std::fill_n(file.bytes.begin() + static_cast<std::ptrdiff_t>(begin), 16, '\0');
  const auto second =
      file.json["accessors"][attributes["WEIGHTS_1"].get<std::size_t>()]["bufferView"].get<std::size_t>();
  std::fill_n(file.bytes.begin() +
                  static_cast<std::ptrdiff_t>(file.json["bufferViews"][second]["byteOffset"].get<std::size_t>()),
              16, '\0');
  refused(file.glb(), "no weights at vertex 0");
}

}  // namespace selvedge::test_rig_gltf
