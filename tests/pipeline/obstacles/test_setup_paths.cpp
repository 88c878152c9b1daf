#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/loose_box.hpp"

namespace selvedge::test_setup_paths {

TEST_CASE("paths of a scene that is given by a link begin at the link", "[setup_paths]") {
  const fake::Folder folder("setup_paths");
  const std::filesystem::path real = folder.path / "real", linked = folder.path / "linked";
  for (const auto& place : {real, linked}) std::filesystem::create_directories(place);
  fake::write(folder, "real/scene.yaml",
              "cloths: [{rectangle: {size: [0.2, 0.2], resolution: 3}}]\nobstacles: [{mesh: box.obj}]\n");
  std::filesystem::create_symlink(real / "scene.yaml", linked / "scene.yaml");
  struct Case {
    const char *scene, *box, *problem;  // empty: none
  };
  for (const Case& one :
       {Case{"real", "real", ""}, Case{"linked", "linked", ""}, Case{"real", "linked", "relative to the scene file"},
        Case{"linked", "real", "box.obj is there: give `folder: "}}) {
    INFO(one.scene << " " << one.box);
    fake::write(folder, std::string(one.box) + "/box.obj", fake::loose_box(0));
    std::string said;
    try {
      read_setup(folder.path / one.scene / "scene.yaml");
    } catch (const Error& error) {
      said = error.cure();
    }
    CHECK(said.empty() == (*one.problem == '\0'));
    CHECK_THAT(said, Catch::Contains(one.problem));
    std::filesystem::remove(folder.path / one.box / "box.obj");
  }
}

}  // namespace selvedge::test_setup_paths
