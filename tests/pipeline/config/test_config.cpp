#include <numbers>

#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "pipeline/config/config_text.hpp"
#include "pipeline/scene/config_scene.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/tools/scene_pages.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_config {

using Catch::Matchers::Contains;
using fake::Folder;
using fake::whole;

namespace {

const std::string sheet = "cloths:\n  - rectangle: {resolution: 4}\n";

// The message with which a scene is refused; empty if it is read.
std::string refusal(const std::string& scene, const std::vector<std::string>& overrides = {}) {
  const Folder folder("config");
  try {
    read_setup(fake::write(folder, "scene.yaml", scene), overrides);
    return {};
  } catch (const Error& e) {
    return e.what();
  }
}

// Returns the message, which has all of the words.
std::string check_refused(const std::string& scene, const std::vector<std::string>& words) {
  const std::string message = refusal(scene);
  INFO(scene << " -> " << message);
  for (const std::string& word : words) CHECK_THAT(message, Contains(word));
  return message;
}

const std::filesystem::path page = source_root() / "docs" / "scene.md";
const std::vector<std::pair<std::filesystem::path, KeyTier>> tier_pages{
    {page, KeyTier::user}, {page.parent_path() / "expert.md", KeyTier::expert}};
const std::string marker = "<!-- tables -->\n";

std::vector<std::string> yaml_blocks(const std::string& text) {
  std::vector<std::string> blocks;
  const std::string open = "```yaml\n", close = "```";
  for (std::size_t at = 0; (at = text.find(open, at)) != std::string::npos;) {
    at += open.size();
    const std::size_t end = text.find(close, at);
    blocks.push_back(text.substr(at, end - at));
    at = end;
  }
  return blocks;
}

}  // namespace

TEST_CASE("Quantities carry their unit or are SI", "[config]") {
  CHECK(read_quantity("2 mm", Unit::length).value == Approx(0.002));
  CHECK(read_quantity("2mm", Unit::length).value == Approx(0.002));
  CHECK(read_quantity("1 dm", Unit::length).value == Approx(0.1));
  CHECK(read_quantity("3 cm3", Unit::volume).value == Approx(3e-6));
  CHECK(read_quantity("1.5 l", Unit::volume).value == Approx(1.5e-3));
  CHECK(read_quantity("150 g/m2", Unit::areal_density).value == Approx(0.15));
  CHECK(read_quantity("150 g/m^2", Unit::areal_density).value == Approx(0.15));
  CHECK(read_quantity("150 g/m\xC2\xB2", Unit::areal_density).value == Approx(0.15));
  CHECK(read_quantity("180 deg", Unit::angle).value == Approx(3.14159265358979));
  for (const char* text : {"5 uN m", "5 \u00b5N m", "5\u03bcNm"})
    CHECK(read_quantity(text, Unit::bending).value == Approx(5e-6));
  CHECK(read_quantity("90\u00b0", Unit::angle).value == Approx(std::numbers::pi / 2));
  CHECK(read_quantity("+1e-3", Unit::length).value == Approx(1e-3));
  CHECK(read_quantity("36 km/h", Unit::speed).value == Approx(10));
  CHECK(read_quantity(".5", Unit::none).problem.empty());
  for (const char* bad : {"", "m", "1 kg", "1 deg", "nan", ".nan", ".inf", "1e999", "1 2", "0x10"})
    CHECK_FALSE(read_quantity(bad, Unit::length).problem.empty());
  CHECK_FALSE(read_quantity("3 mm", Unit::none).problem.empty());
}

TEST_CASE("A wrong key is named with file, line, what is allowed and the nearest", "[config]") {
  const std::string message = refusal(sheet + "contact:\n  thicknes: 1 mm\n");
  CHECK_THAT(message, Contains("scene.yaml:4"));
  CHECK_THAT(message, Contains("`contact.thicknes`"));
  CHECK_THAT(message, Contains("self_friction"));
  CHECK_THAT(message, Contains("did you mean `thickness`"));
  CHECK_THAT(refusal("cloth:\n  - rectangle: {}\n"), Contains("did you mean `cloths`"));
  CHECK_THAT(refusal("cloths:\n  - rectangel: {}\n"), Contains("did you mean `rectangle`"));
  CHECK_THAT(refusal(sheet + "obstacles:\n  - {spere: {}}\n"), Contains("did you mean `sphere`"));
}

TEST_CASE("Wrong values are refused where they stand", "[config]") {
  const auto [scene, words] = GENERATE(Catch::Generators::table<std::string, std::vector<std::string>>({
      {"run: {fps: 0}\n", {"run.fps", "`0`", "above 0", ":3"}},
      {"run: {fps: -30}\n", {"run.fps", "above 0"}},
      {"run: {frames: 2.5}\n", {"run.frames", "integer"}},
      {"run: {frames: ten}\n", {"run.frames", "integer"}},
      {"run: {substeps: some}\n", {"run.substeps", "auto"}},
      {"run: {stepper: icm}\nsolver: {integrator: bdf2}\n", {"solver.integrator", "`icm`", "conventional"}},
      {"run: {stepper: conventinal}\n", {"run.stepper", "did you mean `conventional`"}},
      {"contact: {friction: -0.1}\n", {"contact.friction", "from 0 to"}},
      {"contact: {thickness: 0}\n", {"contact.thickness", "above 0"}},
      {"contact: {thickness: .nan}\n", {"contact.thickness", "not finite"}},
      {"contact: {thickness: 2 kg/m2}\n", {"contact.thickness", "mm"}},
      {"contact: {self: maybe}\n", {"contact.self", "true or false"}},
      {"contact: 3\n", {"contact", "thickness"}},
      {"contact: {friction: 1, friction: 2}\n", {"contact.friction", "twice"}},
      {"gravity: -9.81\n", {"gravity", "[x, y, z]"}},
      {"gravity: [0, -9.81]\n", {"gravity", "2 items"}},
      {"gravity: [0, .inf, 0]\n", {"gravity", "not finite"}},
      {"wind: {keyframes: [{time: 1, velocity: [0, 0, 0]}, {time: 1, velocity: [0, 0, 0]}]}\n", {"sort"}},
      {"wind: {keyframes: [{time: 1}]}\n", {"wind.keyframes.0.velocity", "missing"}},
      {"obstacles: [{sphere: {}, box: {}}]\n", {"obstacles.0", "exactly one"}},
      {"obstacles: [{name: x}]\n", {"obstacles.0", "exactly one"}},
      {"obstacles: [{sphere: {edge: 1e-9}}]\n", {"edge", "longer"}},
      {"obstacles: [{box: {size: [1, 0, 1]}}]\n", {"size", "positive"}},
      {"obstacles: [{mesh: nowhere.obj}]\n", {"obstacles.0.mesh.file", "nowhere.obj"}},
      {"obstacles: [{mesh: \"${NO_SUCH_VARIABLE_X}/a.obj\"}]\n", {"NO_SUCH_VARIABLE_X"}},
      {"obstacles: [{sequence: {pattern: a.obj}}]\n", {"%d"}},
      {"obstacles: [{sequence: {pattern: nowhere_%03d.obj}}]\n", {"nowhere_000.obj"}},
      {"obstacles: [{trajectory: nowhere.h5}]\n", {"nowhere.h5"}},
      {"obstacles: [{name: a, sphere: {}}, {name: a, sphere: {}}]\n", {"name `a`"}},
      {"obstacles: [{revolution: {profile: [[0.1, 0]]}}]\n", {"too few points", "two"}},
      {"obstacles: [{revolution: {closed: true, profile: [[0.1, 0], [0.2, 1]]}}]\n", {"too few points", "three"}},
      {"obstacles: [{revolution: {profile: [[0.1, 0], [0, 1], [0.1, 2]]}}]\n", {"profile.1", "axis", "above 0"}},
      {"obstacles: [{revolution: {profile: [[0.1, 0], [-1, 1]]}}]\n", {"profile.1", "at least 0"}},
      {"obstacles: [{revolution: {profile: [[0.1, 0], [0.1, 0]]}}]\n", {"repeats"}},
      {"obstacles: [{revolution: {profile: [[1, 2, 3], 4]}}]\n", {"3 items"}},
      {"outcome: [{name: a}]\n", {"exactly one", "wanted_pairs"}},
      {"outcome: [{name: a, drift: {of: tube}}]\n", {"tube", "known: cloth0"}},
      {"outcome: [{name: a, ahead: {obstacle: ball, direction: [1, 0, 0]}}]\n", {"ball", "there is none"}},
      {"outcome: [{name: a, turns: {axis: [0, 0, 0]}}]\n", {"axis", "direction"}},
      {"outcome: [{name: a, stretch: {}, from: 2, until: 1}]\n", {"until", "before `from`"}},
  }));
  check_refused(sheet + scene, words);
}

TEST_CASE("Wrong cloths are refused where they stand", "[config]") {
  const auto [cloth, words] = GENERATE(Catch::Generators::table<std::string, std::vector<std::string>>({
      {"material: {density: 0}", {"density", "above 0"}},
      {"material: {lame_mu: -1}", {"lame_mu", "from 0 to"}},
      {"material: {bending: -1e-5}", {"bending", "from 0 to"}},
      {"material: {poisson: 0.3}", {"poisson", "youngs_modulus"}},
      {"material: {poisson: 1, youngs_modulus: 1}", {"poisson", "below 1"}},
      {"material: {poisson: 0.3, youngs_modulus: 1, lame_mu: 2}", {"lame_mu", "one pair"}},
      {"material: coton", {"coton", "did you mean `cotton`", "denim"}},
      {"material: {name: denim, file: x.yaml}", {"one of them"}},
      {"material: {file: nowhere.yaml}", {"nowhere.yaml"}},
      {"rest: {from: mesh}", {"rest.from", "file"}},
      {"rest: {from: initial, file: x.obj}", {"not used"}},
      {"pins: [{vertices: [0, 16]}]", {"vertex 16", "0 to 15"}},
      {"pins: [{vertices: [-1]}]", {"at least 0"}},
      {"pins: [{group: topleft}]", {"topleft", "did you mean `top_left`", "bottom"}},
      {"pins: [{box: {min: [5, 5, 5], max: [6, 6, 6]}}]", {"no vertex", "spans"}},
      {"pins: [{box: {min: [1, 0, 0], max: [0, 0, 0]}}]", {"swap"}},
      {"pins: [{group: top, vertices: 1}]", {"exactly one"}},
      {"pins: [{group: top, motion: {keyframes: []}}]", {"keyframes", "empty"}},
      {"scale: 0", {"scale", "above 0"}},
      {"copies: 0", {"copies.count", "from 1 to 10000"}},
      {"copies: {count: 2, translat: [0, 0, 1]}", {"did you mean `translate`"}},
  }));
  CHECK_THAT(check_refused(sheet + "    " + cloth + "\n", words), Contains("scene.yaml:3") || Contains("scene.yaml:2"));
}

TEST_CASE("Wrong ribbons and garments are refused where they stand", "[config]") {
  const auto [cloth, words] = GENERATE(Catch::Generators::table<std::string, std::vector<std::string>>({
      {"ribbon: {line: [[0, 0, 0]]}", {"ribbon.line", "two points"}},
      {"ribbon: {line: [[0, 0, 0], [0, 1, 0]]}", {"normal", "along the ribbon's line"}},
      {"ribbon: {line: [[0, 0, 0], [1, 0, 0], [1, 0, 0]]}", {"line.2", "repeats"}},
      {"ribbon: {line: [[0, 0, 0], [1, 0]]}", {"line.1", "2 items"}},
      {"ribbon: {line: [[0, 0, 0], {at: [1, 0, 0], normal: [0, 0, 0]}]}", {"line.1", "direction"}},
      {"ribbon: {width: 1}", {"line", "missing"}},
      {"tshirt: {neck: 2}", {"neck", "shoulders"}},
      {"tshirt: {sleeve_width: 2}", {"sleeve_width", "sides"}},
      {"tshirt: {edge: 1e-6}", {"vertices", "longer edge"}},
  }));
  CHECK_THAT(check_refused("cloths:\n  - " + cloth + "\n", words), Contains("scene.yaml:2"));
}

TEST_CASE("Absurd resolutions are refused before memory runs out", "[config]") {
  for (const char* shape : {"rectangle: {resolution: 1000000}", "rectangle: {edge: 1e-12}", "disc: {edge: 1e-9}",
                            "disc: {resolution: 2000000000}", "tube: {resolution: [2000000000, 2000000000]}"})
    CHECK_THAT(refusal(fmt::format("cloths: [{{{}}}]", shape)), Contains("vertices"));
  CHECK_THAT(refusal("cloths: [{rectangle: {resolution: 1}}]"), Contains("at least 2"));
  CHECK_THAT(refusal("cloths: [{tube: {resolution: 5}}]"), Contains("at least 6"));
}

TEST_CASE("Files that are no scenes are refused", "[config]") {
  CHECK_THAT(refusal(""), Contains("is empty") && Contains("allowed keys: ") && Contains("cloths"));
  CHECK_THAT(refusal("# only a comment\n"), Contains("is empty"));
  CHECK_THAT(refusal("just words"), Contains("key: value"));
  CHECK_THAT(refusal("cloths: [\n"), Contains("not YAML") && Contains("cure: "));
  CHECK_THAT(refusal("a: b: c\n"), Contains("scene.yaml:1"));
  CHECK_THAT(refusal("cloths: [{disc: {}}]\n---\nrun: {frames: 2}\n"), Contains("more than one YAML document"));
  CHECK_THAT(refusal("cloths: []\n"), Contains("at least one cloth"));
  CHECK_THAT(refusal("gravity: [0, 0, 0]\n"), Contains("`cloths` is missing"));
  CHECK_THAT(refusal("cloths: {rectangle: {}}\n"), Contains("list"));
  const Folder folder("config");
  CHECK_THROWS_AS(read_setup(folder.path / "missing.yaml"), Error);
  CHECK_THROWS_AS(read_setup(folder.path), Error);
}

TEST_CASE("An alias has values of its own, and merge keys are put in", "[config]") {
  const Folder folder("config_merge");
  const auto file = fake::write(folder, "scene.yaml",
                                "cloths:\n"
                                "  - &a\n"
                                "    name: a\n"
                                "    rectangle: {resolution: 3}\n"
                                "    material: &m {density: &d 0.3, bending: 2e-5}\n"
                                "  - {name: b, <<: *a, material: {<<: [{density: 0.4}, *m]}}\n"
                                "  - {name: c, rectangle: {resolution: 4}, material: *m}\n"
                                "  - *a\n"
                                "run: {frames: 2}\n");
  const auto density = [&](const std::vector<std::string>& overrides) {
    const Config scene = read_config(file, scene_section(), overrides);
    std::vector<double> all;
    for (const Config& cloth : scene["cloths"].items) all.push_back(cloth["material"]["density"].number());
    return all;
  };
  using All = std::vector<double>;
  const Config scene = read_config(file, scene_section());
  CHECK(density({}) == All{0.3, 0.4, 0.3, 0.3});
  CHECK(scene["cloths"].items[1]["name"].text() == "b");
  CHECK(scene["cloths"].items[1]["rectangle"]["resolution"].integer() == 3);
  CHECK(scene["cloths"].items[1]["material"]["bending"].number() == 2e-5);
  CHECK(density({"cloths.0.material.density=0.5"}) == All{0.5, 0.4, 0.3, 0.3});
  CHECK(density({"cloths.2.material.density=0.5"}) == All{0.3, 0.4, 0.5, 0.3});
  CHECK(density({"cloths.3.material.density=0.5"}) == All{0.3, 0.4, 0.3, 0.5});
  const auto bad = fake::write(folder, "bad.yaml", "cloths: [{<<: 3, rectangle: {resolution: 3}}]\n");
  CHECK_THROWS_WITH(read_config(bad, scene_section()), Contains("bad.yaml:1") && Contains("<<"));
}

TEST_CASE("A file whose aliases stand for more than memory holds is refused", "[config]") {
  const Folder folder("config_aliases");
  std::string vertices = "0", pins, cloths;
  for (int k = 0; k < 300; ++k) vertices += ", 1", pins += ", *p", cloths += "  - *c\n";
  const auto file = fake::write(
      folder, "aliases.yaml",
      "cloths:\n  - &c {rectangle: {resolution: 3}, pins: [&p {vertices: [" + vertices + "]}" + pins + "]}\n" + cloths);
  CHECK_THROWS_WITH(read_config(file, scene_section()), Contains("aliases.yaml") && Contains("4000000 values"));
  CHECK_THROWS_WITH(
      read_config(fake::write(folder, "deep.yaml", "description: " + std::string(300, '[') + std::string(300, ']')),
                  scene_section()),
      Contains("deep.yaml") && Contains("200 deep"));
}

TEST_CASE("No beginning of a scene file crashes", "[config]") {
  const std::string scene = whole(source_root() / "configs/bench/tube.yaml");
  for (std::size_t length = 0; length < scene.size(); length += 3) {
    refusal(scene.substr(0, length), {"cloths.0.tube.resolution=8"});
    std::string torn = scene;
    torn[length] = "\t:[{}&*!\""[length % 9];
    refusal(torn, {"cloths.0.tube.resolution=8"});
  }
}

TEST_CASE("Overrides reach every key and are named when wrong", "[config]") {
  const Folder folder("config");
  const auto file =
      fake::write(folder, "scene.yaml", "cloths:\n  - {name: a, rectangle: {resolution: 4}, material: denim}\n");
  const auto read = [&](const std::string& assignment) { return read_setup(file, {assignment}); };
  CHECK(read("run.frames=7").run.frames == 7);
  CHECK(read("cloths.0.rectangle.resolution=[3, 5]").scene.surface.vertex_count == 15);
  CHECK(read("cloths.a.rectangle.resolution=5").scene.surface.vertex_count == 25);
  CHECK(read("gravity=[0, 0, 1 m/s2]").drive_at(0).acceleration.z() == 1);
  CHECK(read("run.frames=null").run.frames == read("run.fps=30").run.frames);
  CHECK(read("run.substeps=3").run.conventional.substeps == 3);
  CHECK(read("run.substeps=3").run.icm.substeps == 3);
  CHECK(read("run.stepper=icm").run.stepper == "icm");
  CHECK(read("run.icm.reach=3 mm").run.icm.reach == 0.003);
  CHECK(read("run.icm.contour_gradient=full").run.icm.contour_gradient == ContourGradient::full);
  CHECK_FALSE(read("run.substeps=auto").run.conventional.substeps.has_value());
  // A plain value becomes a section when one of its keys is set.
  const Material material = read("cloths.0.material.density=0.5").scene.cloths[0].material;
  CHECK(material.name == "denim");
  CHECK(material.density == 0.5);
  CHECK(material.bending == 1.69e-5);
  for (const char* bad : {"run.frames", "=3", "run.frame=3", "run.frames=0", "cloths.1.scale=2", "cloths.b.scale=2",
                          "cloths.0.rectangle.resolution.x=1", "run=5", "gravity=[", "", "cloths.=1", ".=1",
                          "run.frames=", "run.frames= ", "cloths.a.rectangle.resolution=1"})
    CHECK_THROWS_WITH(read(bad), Contains(fmt::format("--set {}", bad)));
  CHECK_THROWS_WITH(read("run.frame=3"), Contains("did you mean `frames`"));
}

TEST_CASE("Any text can be given by an override, in quotes", "[config]") {
  const Folder folder("quoted");
  const std::filesystem::path file = fake::write(folder, "scene.yaml", "cloths: [{rectangle: {}}]\n");
  const auto table = scene_table(known_kinds());
  for (const std::string text : {"plain", "a #b", "c: d", "[e]", "it's", "\"f\"", "true", "1e5", "g\\h"})
    CHECK(read_config(file, table->scene, {"description=" + quoted_yaml(text)})["description"].text() == text);
}

TEST_CASE("The full configuration reads back to itself", "[config]") {
  const Folder folder("config");
  const Setup first = read_setup(
      fake::write(folder, "a.yaml",
                  "description: \"yes\"\ncloths:\n  - disc: {resolution: 3}\n    material: {name: silk, "
                  "youngs_modulus: 123, poisson: 0.25}\n    translate: [1 cm, 0, 0]\n    pins:\n      - "
                  "{group: boundary, motion: {keyframes: [{time: 1, rotate: [90 deg, 0, 0]}]}}\nobstacles:\n"
                  "  - capsule: {}\n  - revolution: {profile: [[1, 2], [2, 3]]}\nshort_form: [run.frames=3]\n"
                  "outcome: [{name: a, lag: {}}, {name: b, drift: {of: {group: center}}, until: 2}]\nwind: {velocity: "
                  "[1, 2, 3]}\n"));
  const Setup second = read_setup(fake::write(folder, "b.yaml", first.config));
  CHECK(second.config == first.config);
  CHECK(second.initial.x == first.initial.x);
  CHECK(second.scene.cloths[0].material.lame_mu == first.scene.cloths[0].material.lame_mu);
  CHECK(second.drive_at(1).pins == first.drive_at(1).pins);
  CHECK(second.drive_at(1).wind == first.drive_at(1).wind);
  CHECK(second.short_form == first.short_form);
  REQUIRE(second.outcomes.size() == 2);
  CHECK(std::get<Drift>(second.outcomes[1].measure).vertices == std::get<Drift>(first.outcomes[1].measure).vertices);
  CHECK_THAT(first.config, Contains("thickness: 0.002"));
}

TEST_CASE("Defaults are those of the structs", "[config]") {
  const Folder folder("config");
  const Setup setup = read_setup(fake::write(folder, "scene.yaml", sheet));
  const Material used = setup.scene.cloths[0].material, wanted;
  CHECK(used.density == wanted.density);
  CHECK(used.lame_mu == wanted.lame_mu);
  CHECK(used.bending == wanted.bending);
  CHECK(used.membrane == wanted.membrane);
  CHECK(used.bending_model == wanted.bending_model);
  CHECK(setup.run.conventional.implicit_euler.velocity_tolerance == ImplicitEulerOptions{}.velocity_tolerance);
  CHECK(setup.run.icm.contour_weight == IcmOptions{}.contour_weight);
  CHECK(setup.run.icm.push_speed == IcmOptions{}.push_speed);
  CHECK(setup.run.icm.contour_gradient == IcmOptions{}.contour_gradient);
  CHECK(setup.scene.contact.thickness == ContactSettings{}.thickness);
  CHECK_FALSE(setup.scene.wind.on);
}

TEST_CASE("docs/scene.md and docs/expert.md have the tables as the program has them", "[config]") {
  for (const auto& [file, tier] : tier_pages) {
    INFO(file);
    const std::string text = whole(file);
    const std::size_t at = text.find(marker);
    REQUIRE(at != std::string::npos);
    CHECK(text.substr(at + marker.size()) == fmt::format("\n{}", scene_reference(tier)));
  }
}

TEST_CASE("Keys of scene files: a user has as many as a reader can take in, and every key is in one tier", "[config]") {
  CHECK(scene_key_count(KeyTier::user) <= 130);
  const std::string user = scene_keys_text(KeyTier::user), expert = scene_keys_text(KeyTier::expert);
  CHECK(std::ranges::count(user, '\n') > scene_key_count(KeyTier::user));  // with its headings
  CHECK_THAT(user, Contains("  friction ") && Contains("  blend_in "));
  CHECK_THAT(user, !Contains("  zone_rounds "));
  CHECK_THAT(expert, Contains("  zone_rounds ") && !Contains("  blend_in "));
}

TEST_CASE("Keys of scene files: one that has become a constant may be given as it is, and nothing else", "[config]") {
  const Folder folder("config");
  const auto read = [&](const std::string& solver) {
    return read_setup(fake::write(folder, "scene.yaml", std::string(sheet) + "solver: " + solver + "\n"));
  };
  CHECK_NOTHROW(read("{substep: {max_slide: 1, tearing: 10}}"));
  CHECK_THROWS_WITH(read("{substep: {max_slide: 2}}"), Contains("solver.substep.max_slide") &&
                                                           Contains("is a constant now") &&
                                                           Contains("it is 1 (physics/steppers/substep_options.hpp)"));
  const auto file = fake::write(folder, "scene.yaml", sheet);
  CHECK_NOTHROW(read_setup(file, {"solver.response.room.few=0.01"}));
  CHECK_THROWS_WITH(read_setup(file, {"run.recovery.astray=3"}), Contains("is a constant now"));
}

TEST_CASE("config: a section as JSON of another language is checked by its table", "[config]") {
  const auto read = [](const std::string& text) {
    return read_section(text, table::cloth_section(), "sheet of arrays");
  };
  const Config cloth = read(R"({"name": "a", "rectangle": {"edge": "5 cm"}, "material": {"density": 0.15}})");
  CHECK(cloth["material"]["density"].number() == 0.15);
  CHECK(cloth["rectangle"]["edge"].number() == 0.05);
  CHECK_THROWS_WITH(read(R"({"rectangle": {}, "material": {"densty": 1}})"),
                    Contains("sheet of arrays") && Contains("densty") && Contains("did you mean `density`"));
  CHECK_THROWS_WITH(read(R"({"rectangle": {}, "material": {"density": -1}})"), Contains("material.density"));
  CHECK_THROWS_WITH(read("[1, 2]"), Contains("is no dictionary"));
  CHECK_THROWS_WITH(read("{"), Contains("is not YAML"));
}

TEST_CASE("The scenes in docs/scene.md and docs/start.md can be read", "[config]") {
  const Folder folder("config");
  std::vector<std::string> blocks = yaml_blocks(whole(page));
  REQUIRE(blocks.size() >= 3);
  std::ranges::copy(yaml_blocks(whole(page.parent_path() / "start.md")), std::back_inserter(blocks));
  const bool data = std::filesystem::exists(fake::open_data() / "diffcloth");
  if (!data) WARN("skipped: the open data is absent, and with it the scenes that use it");
  for (const std::string& block : blocks) {
    INFO(block);
    if (data || block.find("SELVEDGE_DATA") == std::string::npos)
      CHECK_NOTHROW(read_setup(fake::write(folder, "scene.yaml", block)));
  }
}

TEST_CASE("docs/scene.md and docs/expert.md are written anew", "[.][write-docs]") {
  for (const auto& [file, tier] : tier_pages) {
    const std::string text = whole(file);
    std::ofstream(file) << text.substr(0, text.find(marker) + marker.size()) << "\n" << scene_reference(tier);
  }
}

}  // namespace selvedge::test_config
