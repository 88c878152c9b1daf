#include <catch2/catch.hpp>

#include "tests/pipeline/files.hpp"
#include "tests/program.hpp"
#include "tests/source_root.hpp"

namespace selvedge::long_pattern_walk {

namespace {

const std::string scene_text = R"(
run: {frames: 100}
cloths:
  - garment: {file: shirt.h5, on: person}
    material: cotton
obstacles:
  - name: person
    body: {model: body.h5, clip: walk, blend_in: 1 s}
)";

// Whether the program ends with status 0: what it made is clean.
bool runs_well(const fake::Folder& folder, const std::string& arguments) {
  const std::string command =
      "cd '" + folder.path.string() + "' && '" + tested_program() + "' " + arguments + " > log 2>&1";
  const bool well = std::system(command.c_str()) == 0;
  INFO(fake::whole(folder.path / "log"));
  CHECK(well);
  return well;
}

}  // namespace

// About 100 s of processor time.
TEST_CASE("GarmentCode's shirt is sewn on GarmentCode's body and walks 100 clean frames", "[.long]") {
  const std::filesystem::path data = fake::open_data() / "garmentcode";
  if (!std::filesystem::exists(data / "mean_all.obj")) {
    WARN("skipped: no data in " << data.string());
    return;
  }
  const fake::Folder folder("pattern_walk");
  fake::write(folder, "walk.yaml", scene_text);
  const std::string from = "'" + std::filesystem::absolute(data).string() + "/";
  REQUIRE(runs_well(folder, "body " + from + "mean_all.obj' --joints '" + source_root().string() +
                                "/configs/real/mean_all_joints.yaml' --out body.h5"));
  REQUIRE(runs_well(folder,
                    "pattern " + from + "shirt_mean_specification.json' --body body.h5 --edge 0.03 --out shirt.h5"));
  REQUIRE(runs_well(folder, "simulate walk.yaml --out run --no-view"));
}

}  // namespace selvedge::long_pattern_walk
