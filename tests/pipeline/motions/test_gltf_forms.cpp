#include <catch2/catch.hpp>
#include <cstring>

#include "pipeline/motions/rig_gltf.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/fake_body.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/motions/fake_gltf.hpp"

namespace selvedge::test_gltf_forms {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

// The values of an accessor without a stride.
template <class Number>
Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values_of(const fake::GltfFile& file,
                                                                                 std::size_t number, int columns) {
  const auto& accessor = file.json["accessors"][number];
  const auto& view = file.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values(accessor["count"].get<int>(), columns);
  std::memcpy(values.data(), file.bytes.data() + view["byteOffset"].get<std::size_t>(),
              sizeof(Number) * static_cast<std::size_t>(values.size()));
  return values;
}

}  // namespace

TEST_CASE("glTF: a body below a mirrored armature is mirrored, and its faces stay outside", "[gltf_forms]") {
  const Folder folder("gltf_mirrored");
  const BodyModel body = fake::body(6, 40, 0, false);
  Clip clip{"swing", 30, {}, {}, {}};
  for (unsigned f = 1; f < 5; ++f) clip.poses.push_back(fake::pose(6, f, 0.6));
  fake::GltfFile file = fake::gltf_of(body, clip, body.joints);
  const GltfRig plain = read_gltf_rig(fake::write(folder, "plain.glb", file.glb()));
  auto& nodes = file.json["nodes"];
  nodes.push_back({{"name", "mirror"}, {"scale", {-1, 1, 1}}, {"children", {0}}});
  file.json["scenes"][0]["nodes"] = {nodes.size() - 1};
  const GltfRig rig = read_gltf_rig(fake::write(folder, "rig.glb", file.glb()));
  const auto mirrored = [](Points x) {
    x.col(0) = -x.col(0);
    return x;
  };
  CHECK((rig.body.skin.rest - mirrored(plain.body.skin.rest)).isZero(1e-6));
  CHECK(rig.body.skin.triangles.col(0) == plain.body.skin.triangles.col(0));
  CHECK(rig.body.skin.triangles.col(1) == plain.body.skin.triangles.col(2));
  const Clip moved = read_gltf_clip(rig, "", 30), moved_plain = read_gltf_clip(plain, "", 30);
  REQUIRE(moved.poses.size() == clip.poses.size());
  for (std::size_t f = 0; f < clip.poses.size(); ++f)
    CHECK((posed(rig.body, {}, moved.poses[f]) - mirrored(posed(plain.body, {}, moved_plain.poses[f]))).isZero(1e-5));
}

TEST_CASE("glTF: accessors that are stored sparsely are read", "[gltf_forms]") {
  const Folder folder("gltf_sparse");
  const BodyModel body = fake::body(4, 12, 0, false);
  fake::GltfFile file = fake::gltf_of(body, {}, body.joints);
  const auto read = [&] { return read_gltf(fake::write(folder, "rig.glb", file.glb())).mesh.x; };
  const Points still = read();
  auto& mesh = file.json["meshes"][0];
  const int count = file.json["accessors"][mesh["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()]["count"];
  // As Blender writes shape keys: the rows that are not stored are 0.
  const Eigen::VectorXi all = Eigen::VectorXi::LinSpaced(count, 0, count - 1);
  const int rows = file.whole(all, "SCALAR", 5123),
            values = file.numbers(Eigen::RowVector3d(0, 0, 8).replicate(count, 1), "VEC3");
  const auto view_of = [&](int accessor) { return file.json["accessors"][accessor]["bufferView"]; };
  auto sparse = nlohmann::ordered_json{{"count", count},
                                       {"indices", {{"bufferView", view_of(rows)}, {"componentType", 5123}}},
                                       {"values", {{"bufferView", view_of(values)}}}};
  file.json["accessors"].push_back({{"componentType", 5126}, {"count", count}, {"type", "VEC3"}, {"sparse", sparse}});
  const std::size_t target = file.json["accessors"].size() - 1;
  mesh["primitives"][0]["targets"] = {{{"POSITION", target}}};
  mesh["weights"] = {0.5};
  CHECK((read().rowwise() - Eigen::RowVector3d(0, 0, 4) - still).isZero(1e-5));
  file.json["accessors"][target].erase("sparse");
  CHECK(read() == still);
  file.json["accessors"][target]["sparse"] = sparse;
  file.json["accessors"][target]["count"] = count - 1;
  CHECK_THROWS_WITH(read(), Contains("target 0") && Contains(std::to_string(count - 1)));
}

TEST_CASE("glTF: meshes with skins of their own follow one armature", "[gltf_forms]") {
  const Folder folder("gltf_skins");
  const BodyModel body = fake::body(4, 12, 0, false);
  fake::GltfFile file = fake::gltf_of(body, {}, body.joints);
  auto& json = file.json;
  json["meshes"].push_back(json["meshes"][0]);
  json["meshes"][1]["name"] = "hair";
  json["nodes"].push_back({{"name", "hair"}, {"mesh", 1}, {"skin", 0}});
  json["scenes"][0]["nodes"].push_back(json["nodes"].size() - 1);
  const auto read = [&] { return read_gltf(fake::write(folder, "rig.glb", file.glb())); };
  const GltfScene one = read();
  // The second mesh gets a skin with the same joints, in reverse order.
  auto skin = json["skins"][0];
  const int n = static_cast<int>(skin["joints"].size());
  std::ranges::reverse(skin["joints"]);
  Eigen::MatrixXd bind =
      values_of<float>(file, skin["inverseBindMatrices"].get<std::size_t>(), 16).cast<double>().colwise().reverse();
  skin["inverseBindMatrices"] = file.numbers(bind, "MAT4");
  json["skins"].push_back(skin);
  json["nodes"].back()["skin"] = 1;
  for (const char* name : {"JOINTS_0", "JOINTS_1"}) {
    auto& joints = json["meshes"][1]["primitives"][0]["attributes"][name];
    const Eigen::MatrixXi numbers = values_of<std::uint16_t>(file, joints.get<std::size_t>(), 4).cast<int>();
    joints = file.whole((n - 1 - numbers.array()).matrix(), "VEC4", 5123);
  }
  const GltfScene two = read();
  CHECK(two.joints == one.joints);
  CHECK(two.mesh.x == one.mesh.x);
  CHECK(two.mesh.groups == one.mesh.groups);
  CHECK(Eigen::MatrixXd(two.weights) == Eigen::MatrixXd(one.weights));
  bind.row(1) *= 2;
  json["skins"][1]["inverseBindMatrices"] = file.numbers(bind, "MAT4");
  CHECK_THROWS_WITH(read(), Contains("skins: bind the joint") && Contains("choose meshes of one skin"));
  CHECK(read_gltf(folder.path / "rig.glb", {{"hair"}, {}}).mesh.groups.size() == 1);
}

TEST_CASE("glTF: buffers in the text and extensions that leave the shape are read in all spellings", "[gltf_forms]") {
  const Folder folder("gltf_text");
  const BodyModel body = fake::body(4, 12, 0, false);
  fake::GltfFile file = fake::gltf_of(body, {}, body.joints);
  const Points wanted = read_gltf(fake::write(folder, "rig.GLB", file.glb())).mesh.x;
  while (file.bytes.size() % 3 != 0) file.bytes += '\0';
  std::string coded;  // base64
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < file.bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) three = three << 8 | static_cast<unsigned char>(file.bytes[i + k]);
    for (int k = 3; k >= 0; --k) coded += digits[three >> 6 * k & 63];
    if (i % 57 == 0) coded += '\n';
  }
  file.json["extensionsRequired"] = {"KHR_lights_punctual", "KHR_texture_transform", "VRMC_vrm"};
  for (const std::string type : {"application/octet-stream", "application/gltf-buffer", ""}) {
    file.json["buffers"] = nlohmann::ordered_json::array(
        {{{"byteLength", file.bytes.size()}, {"uri", "data:" + type + ";base64, " + coded}}});
    CHECK(read_gltf(fake::write(folder, "rig.gltf", file.json.dump())).mesh.x == wanted);
  }
  file.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  CHECK_THROWS_WITH(read_gltf(fake::write(folder, "rig.gltf", file.json.dump())), Contains("asks for EXT_mesh"));
}

TEST_CASE("glTF: extensions of files may be in capitals", "[gltf_forms]") {
  const Folder folder("gltf_capitals");
  const BodyModel body = fake::body(4, 12, 0, false);
  fake::write(folder, "RIG.GLB", fake::gltf_of(body, {}, body.joints).glb());
  const auto scene = fake::write(folder, "scene.yaml",
                                 "cloths: [{rectangle: {size: [1, 1], edge: 0.5}}]\n"
                                 "obstacles: [{body: {model: RIG.GLB}}]\n");
  CHECK(read_setup(scene).scene.obstacles.size() == 1);
}

TEST_CASE("glTF: meshes that the file does not show, or that hang on a joint, are left out and named", "[gltf_forms]") {
  const Folder folder("gltf_hidden");
  const BodyModel body = fake::body(4, 12, 0, false);
  fake::GltfFile file = fake::gltf_of(body, {}, body.joints);
  auto& json = file.json;
  const auto read = [&](const NameChoice& choice) {
    return read_gltf(fake::write(folder, "rig.vrm", file.glb()), choice).mesh;
  };
  const Mesh plain = read({});
  CHECK(plain.warnings.empty());
  json["meshes"].push_back(json["meshes"][0]);
  json["meshes"][1]["name"] = "spare";
  json["nodes"].push_back({{"name", "spare"}, {"mesh", 1}, {"skin", 0}});
  const auto number = json["nodes"].size() - 1;
  const auto scene = json["scenes"][0]["nodes"];
  for (const char* how : {"in no scene", "hidden", "below a hidden one"}) {
    INFO(how);
    if (how[0] == 'h') {
      json["scenes"][0]["nodes"].push_back(number);
      json["nodes"][number]["extensions"]["KHR_node_visibility"]["visible"] = false;
    } else if (how[0] == 'b') {
      json["nodes"].push_back(json["nodes"][number]);
      json["nodes"].back().erase("mesh");
      json["nodes"].back().erase("skin");
      json["nodes"].back()["children"] = {number};
      json["nodes"][number].erase("extensions");
      json["scenes"][0]["nodes"].back() = number + 1;
    }
    const Mesh mesh = read({});
    CHECK(mesh.x == plain.x);
    REQUIRE(mesh.warnings.size() == 1);
    CHECK_THAT(mesh.warnings[0], Contains("rig.vrm: mesh `spare` is left out") && Contains("does not show it"));
    CHECK(read({{"spare"}, {}}).warnings.empty());
  }
  // The same mesh on a joint, without a skin.
  json["scenes"][0]["nodes"] = scene;
  json["nodes"][number].erase("skin");
  json["nodes"].erase(json["nodes"].size() - 1);
  json["nodes"][json["skins"][0]["joints"][0].get<std::size_t>()]["children"].push_back(number);
  const Mesh mesh = read({});
  CHECK(mesh.x == plain.x);
  REQUIRE(mesh.warnings.size() == 1);
  CHECK_THAT(mesh.warnings[0], Contains("`spare` is left out: it hangs on a joint and has no skin"));
}

}  // namespace selvedge::test_gltf_forms
