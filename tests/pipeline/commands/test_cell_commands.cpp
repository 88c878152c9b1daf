#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/pipeline/files.hpp"
#include "tests/program.hpp"

namespace selvedge::test_cell_commands {

using fake::Folder;
namespace fs = std::filesystem;

namespace {

struct Ended {
  int status = -1;
  std::string out, err;
};

Ended program(const Folder& folder, const std::string& arguments, const std::string& before = "") {
  const fs::path out = folder.path / "stdout", err = folder.path / "stderr";
  const std::string command = before + tested_program() + " " + arguments + " >" + out.string() + " 2>" + err.string();
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, fake::whole(out), fake::whole(err)};
}

// Two shots, of which the second has no end that anybody waits for.
fs::path work(const Folder& folder) {
  fake::write(folder, "sheet.yaml",
              "cloths: [{name: sheet, rectangle: {size: [0.2, 0.2], resolution: 6}, pins: [{group: top}]}]\n"
              "run: {frames: 3}\n");
  return fake::write(
      folder, "shots.yaml",
      "cells: shots\nshots:\n  - sheet.yaml\n  - {name: long, scene: sheet.yaml, set: [run.frames=100000]}\n");
}

}  // namespace

TEST_CASE("cells are listed, done and gathered from the command line", "[commands][cells]") {
  const Folder folder("cell_commands");
  const std::string file = work(folder).string(), out = (folder.path / "out").string();
  const Ended listed = program(folder, "cells " + file + " --json");
  INFO(listed.err);
  REQUIRE(listed.status == 0);
  const auto json = nlohmann::json::parse(listed.out);
  CHECK(json["file"] == file);
  CHECK(json["kind"] == "shots");
  REQUIRE(json["cells"].size() == 2);
  CHECK(json["cells"][0]["name"] == "sheet");
  CHECK(json["cells"][0]["needs"].size() == 2);
  CHECK(json["cells"][1]["cost"] > json["cells"][0]["cost"]);
  CHECK(program(folder, "cells " + file + " --names").out == "sheet\nlong\n");
  const Ended names = program(folder, "cells " + file + " --names --json");
  CHECK(nlohmann::json::parse(names.out)["names"] == std::vector<std::string>{"sheet", "long"});

  const std::string hash = json["program"], cell = "cell " + file + " sheet --out " + out;
  const Ended other = program(folder, cell + " --program 0123456789abcdef");
  CHECK(other.status == 2);
  CHECK(fake::has(other.err, "0123456789abcdef"));
  CHECK_FALSE(fs::exists(out + "/cells/sheet"));
  const Ended done = program(folder, cell + " --json --program " + hash);
  INFO(done.err);
  CHECK(done.status == 0);
  CHECK(nlohmann::json::parse(done.out)["cells"][0]["kept"] == false);
  CHECK(fs::exists(out + "/cells/sheet/run.h5"));
  const Ended again = program(folder, cell);
  CHECK(again.status == 0);
  CHECK(fake::has(again.out, "kept from before"));
  const Ended wrong = program(folder, "cell " + file + " shete --out " + out);
  CHECK(wrong.status == 2);
  CHECK(fake::has(wrong.err, "did you mean `sheet`"));
  CHECK(program(folder, "cells " + (folder.path / "sheet.yaml").string()).status == 2);

  const Ended gathered = program(folder, "gather " + file + " --out " + out + " --json");
  CHECK(gathered.status == 1);
  const auto tables = nlohmann::json::parse(gathered.out);
  CHECK(tables["missing"][0] == "long");
  CHECK(tables["result"]["shots"].size() == 1);
}

TEST_CASE("a cell whose process is killed in its middle leaves no result", "[commands][cells]") {
  const Folder folder("cell_killed");
  const std::string file = work(folder).string(), out = (folder.path / "out").string();
  // The shell signals as soon as the first frames are there.
  const auto ended_by = [&](const std::string& signal, const std::string& into) {
    const std::string script = "(" + std::string(tested_program()) + " cell " + file + " long --out " + into +
                               " & until ls " + into +
                               "/cells/.long.*/result/run.h5 || ! kill -0 $!; do sleep 0.05; done; kill -" + signal +
                               " $!; wait $!) >" + (folder.path / "log").string() + " 2>&1";
    return WEXITSTATUS(std::system(script.c_str()));
  };
  CHECK(ended_by("KILL", out) == 128 + 9);
  CHECK_FALSE(fs::exists(out + "/cells/long"));
  CHECK(fake::has(program(folder, "gather " + file + " --out " + out).out, "2 cells missing: sheet, long"));
  CHECK(ended_by("TERM", out + "2") == 2);
  CHECK(fs::is_empty(out + "2/cells"));
  CHECK(fake::has(fake::whole(folder.path / "log"), "the same command does what is missing"));
}

}  // namespace selvedge::test_cell_commands
