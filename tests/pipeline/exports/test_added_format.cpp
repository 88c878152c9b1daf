#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "pipeline/exports/export_formats.hpp"
#include "pipeline/host/write_file.hpp"
#include "tests/pipeline/files.hpp"

// The format of docs/extending.md.
namespace selvedge::test_added_format {

// A file a frame, a line a vertex: x y z [m].
std::vector<std::filesystem::path> export_xyz(const AnimatedSurfaces& run, const ExportRequest& request) {
  std::vector<std::filesystem::path> written;
  for (int i = 0; i < run.frame_count; ++i) {
    std::string text;
    for (const PointsF& x : run.frame(i))
      for (const auto& p : x.rowwise()) text += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
    written.push_back(request.file(fmt::format("frame_{:05}.xyz", i)));
    write_file(written.back(), text);
  }
  return written;
}

constexpr ExportFormat xyz{"xyz", "points as text", [](const AnimatedSurfaces& run) { return run.frame_count; },
                           export_xyz};

TEST_CASE("extending: an added format writes its files into the folder", "[export]") {
  const fake::Folder folder("added_format");
  AnimatedSurfaces run;
  run.frame_count = 2;
  run.frame = [](int i) { return std::vector<PointsF>{PointsF::Constant(2, 3, static_cast<float>(i))}; };
  const auto written = xyz.write(run, {folder.path / "run.h5", "xyz", folder.path / "xyz", false, {}});
  REQUIRE(written == std::vector{folder.path / "xyz" / "frame_00000.xyz", folder.path / "xyz" / "frame_00001.xyz"});
  CHECK(fake::whole(written[1]) == "1 1 1\n1 1 1\n");
  CHECK(xyz.reads(run) == 2);
}

}  // namespace selvedge::test_added_format
