#include "pipeline/view/view.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>

#include "collision/geometry/error.hpp"
#include "pipeline/view/view_data.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_view {

namespace {

// Stands in for the package, so that these tests need none.
ViewOptions with_three_in(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "examples/js/controls");
  std::ofstream(folder / "three.min.js") << "three-stands-here";
  std::ofstream(folder / "examples/js/controls/OrbitControls.js") << "orbit-stands-here";
  ViewOptions options;
  options.three = folder;
  return options;
}

ViewRun falling_grid(int n, int frames) {
  ViewRun run{"grid", {}, frames, {}};
  const Scene scene = fake::scene(n);
  run.info = trajectory_info(scene, "", "conventional", 30);
  run.frame = [scene](int index) {
    Frame f = fake::frame(scene, index);
    f.bad_triangles.clear();
    return f;
  };
  return run;
}

}  // namespace

TEST_CASE("view: the embedded metric gives the principal stretches", "[view]") {
  const RestTriangle rest = flatten({0, 0, 0}, {0.02, 0, 0.001}, {0.005, 0, 0.03});
  const std::vector<float> h = inverse_rest_metric({rest, RestTriangle::Zero()});
  REQUIRE(h.size() == 6);
  Eigen::Matrix2d stretch;
  stretch << 1.3, 0.1, 0.1, 0.9;
  const Vec2 e = stretch * (rest.col(1) - rest.col(0)), f = stretch * (rest.col(2) - rest.col(0));
  Eigen::Matrix2d inverse, gram;
  inverse << h[0], h[1], h[1], h[2];
  gram << e.dot(e), e.dot(f), e.dot(f), f.dot(f);
  const double largest = std::sqrt((inverse * gram).eigenvalues().real().maxCoeff());
  CHECK(largest == Approx(stretch.eigenvalues().real().maxCoeff()).epsilon(1e-6));
  CHECK(h[3] == 0);
}

TEST_CASE("view: base64", "[view]") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64(std::string_view("\xff\x00\xfe\x80", 4)) == "/wD+gA==");
}

TEST_CASE("view: frames are left out evenly when a run is too large, never the first or the last", "[view]") {
  CHECK(drawn_frames(5, 1) == std::vector<int>{0, 1, 2, 3, 4});
  CHECK(drawn_frames(10, 2) == std::vector<int>{0, 2, 4, 6, 8, 9});
  CHECK(drawn_frames(10, 3) == std::vector<int>{0, 3, 6, 9});
  CHECK(drawn_frames(10, 40) == std::vector<int>{0, 9});
  CHECK(drawn_frames(1, 2) == std::vector<int>{0});
  const ViewRun run = falling_grid(64, 90);
  const auto drawn_count = [&](std::size_t limit) {
    const std::string data = view_data({run}, limit);
    const std::string list =
        data.substr(data.find("\"drawn\":["), data.find(']', data.find("\"drawn\":[")) - data.find("\"drawn\":["));
    CHECK(list.ends_with("89"));
    return 1 + std::count(list.begin(), list.end(), ',');
  };
  CHECK(drawn_count(60'000'000) == 90);
  const auto some = drawn_count(40'000);
  CHECK(some > 10);
  CHECK(some < 90);
  CHECK(drawn_count(1) == 2);
}

TEST_CASE("view: what runs share stands in the page once", "[view]") {
  const std::string one = view_data({falling_grid(40, 30)}, 60'000'000);
  const std::string two = view_data({falling_grid(40, 30), falling_grid(40, 30)}, 60'000'000);
  const auto scripts = [](const std::string& html) {
    std::size_t count = 0;
    for (std::size_t at = html.find("text/plain"); at != std::string::npos; at = html.find("text/plain", at + 1))
      ++count;
    return count;
  };
  CHECK(scripts(one) == scripts(two));
}

TEST_CASE("view: the page is whole, small and refers to nothing outside", "[view]") {
  const fake::Folder folder("view_page");
  const ViewOptions options = with_three_in(folder.path);
  ViewRun run = falling_grid(64, 90);
  run.name = "</script><b>&\"";
  const std::string page = view_page({run, falling_grid(3, 4)}, options);
  for (const char* part : {"three-stands-here", "orbit-stands-here", "function makeStage", "#stage {"})
    CHECK(page.find(part) != std::string::npos);
  for (const char* part : {"{{", "</script><b>", "src=", "@import", "href=\"http"})
    CHECK(page.find(part) == std::string::npos);
  CHECK(page.size() < 1'500'000);
  ViewOptions tight = options;
  tight.limit = 40'000;
  CHECK(view_page({run}, tight).size() < 900'000);
}

TEST_CASE("view: what cannot be shown is an error with a cure", "[view]") {
  const fake::Folder folder("view_errors");
  CHECK_THROWS_AS(view_page({}, with_three_in(folder.path / "three")), Error);
  CHECK_THROWS_AS(view_page({falling_grid(3, 0)}, with_three_in(folder.path / "three")), Error);
  ViewOptions absent;
  absent.three = folder.path / "none";
  CHECK_THROWS_WITH(view_page({falling_grid(3, 2)}, absent), Catch::Contains("libjs-three"));
}

TEST_CASE("view: a trajectory file becomes a page named after its folder", "[view]") {
  const fake::Folder folder("view_file");
  const ViewOptions options = with_three_in(folder.path / "three");
  const Scene scene = fake::scene();
  std::filesystem::create_directories(folder.path / "silk-dress");
  const std::filesystem::path file = folder.path / "silk-dress/run.h5";
  TrajectoryWriter writer(file, trajectory_info(scene, "", "hybrid-of-two", 30));
  for (int index = 0; index < 3; ++index) writer.append(fake::frame(scene, index));
  writer.close();
  write_view({file.parent_path()}, folder.path / "page.html", options);
  const std::string page = fake::whole(folder.path / "page.html");
  for (const char* part :
       {"\"name\":\"silk-dress\"", "\"stepper\":\"hybrid-of-two\"", "\"self_pairs\":[0,1,2]",
        "\"marked\":[[],[1],[0,1]]", "\"selfAudited\":true",
        "\"doubts\":[\"not_converged\",\"penetrating\",\"energy_gain\"]", "\"switched_off\":[[],[1,1],[0,2]]",
        "\"out_of_response\":[false,true,false]", "\"out_of_proofs\":[false,false,true]"})
    CHECK(page.find(part) != std::string::npos);
  CHECK_THROWS_AS(write_view({file}, folder.path / "no/such/folder.html", options), Error);
  std::filesystem::create_directories(folder.path / "taken.html/inside");
  CHECK_THROWS_AS(write_view({file}, folder.path / "taken.html", options), Error);
  CHECK_FALSE(std::filesystem::exists(folder.path / "taken.html.part"));
}

TEST_CASE("view: a page that cannot be made says why, and is no error", "[view]") {
  const fake::Folder folder("view_extra");
  const std::optional<std::string> trouble = write_page(folder.path);
  REQUIRE(trouble);
  CHECK(trouble->find("run.h5") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder.path / "view.html"));
}

}  // namespace selvedge::test_view
