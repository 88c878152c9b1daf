#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include "pipeline/commands/command_output.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/sources.hpp"

// The command of docs/extending.md, and the chapters of docs/commands.md.
namespace selvedge::test_added_command {

RunCommand area_command(CLI::App& command) {
  const auto file = std::make_shared<std::filesystem::path>();
  command.add_option("file", *file, "mesh (.obj, .ply)")->required();
  return [file](bool json) {
    const Mesh mesh = read_mesh(*file);
    double area = 0;  // [m2]
    for (const auto& t : mesh.triangles.rowwise())
      area += (row(mesh.x, t[1]) - row(mesh.x, t[0])).cross(row(mesh.x, t[2]) - row(mesh.x, t[0])).norm() / 2;
    return end_command(json, fmt::format("area {} m2\n", area), fmt::format("{{\"area\": {}}}\n", area), area > 0);
  };
}

constexpr Command area{"Measure", "area", "the area of a mesh", area_command};

TEST_CASE("extending: an added command reads its options and runs", "[commands]") {
  const fake::Folder folder("added_command");
  std::ofstream(folder.path / "one.obj") << "v 0 0 0\nv 2 0 0\nv 0 0 1\nf 1 2 3\n";
  CLI::App app;
  const RunCommand run = area.add(app);
  app.parse((folder.path / "one.obj").string());
  std::ostringstream out;
  std::streambuf* const before = std::cout.rdbuf(out.rdbuf());
  const int status = run(false);
  std::cout.rdbuf(before);
  CHECK(status == 0);
  CHECK(out.str() == "area 1 m2\n");
  CLI::App bare;
  area.add(bare);
  CHECK_THROWS_AS(bare.parse(""), CLI::RequiredError);
}

TEST_CASE("docs/commands.md has a chapter for each command, in no heading of another", "[commands]") {
  std::set<std::string> named, chapters;
  for (const Command& command : commands)
    named.insert(std::string(command.name).substr(0, std::string(command.name).find(' ')));
  std::istringstream page(sources::read(sources::root / "docs/commands.md"));
  for (std::string line; std::getline(page, line);)
    if (line.starts_with("## ")) chapters.insert(line.substr(3));
  CHECK(chapters == named);
}

}  // namespace selvedge::test_added_command
