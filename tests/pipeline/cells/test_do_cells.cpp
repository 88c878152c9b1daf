#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/cells/do_cells.hpp"
#include "pipeline/host/folder_lock.hpp"
#include "pipeline/host/machine_name.hpp"
#include "pipeline/host/write_file.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_do_cells {

using Catch::Matchers::Contains;
using fake::Folder;
namespace fs = std::filesystem;

namespace {

// Three cells, each of which leaves a file and its number.
CellList three(const std::string& key = "settings") {
  CellList list;
  list.kind = "numbers";
  list.file = "numbers.yaml";
  list.program = "0123";
  list.names = {"a", "b", "c"};
  list.describe = [names = list.names](std::size_t k) { return WorkCell{names[k], {"numbers.yaml"}, 2}; };
  list.key = [key](std::size_t) { return key; };
  list.run = [](std::size_t k, const fs::path& folder, const CellWatch& watch) -> std::optional<CellResult> {
    write_file(folder / "number.txt", std::to_string(k));
    if (watch.stop && watch.stop()) return {};
    return CellResult{"{\"number\": " + std::to_string(k) + "}", k != 1, 7 + k};
  };
  list.gather = [](const std::vector<CellRecord>& records, const fs::path&) {
    std::string text;
    bool passed = true;
    for (const CellRecord& record : records) {
      text += nlohmann::json::parse(record.result.row)["number"].dump() + "\n";
      passed = passed && record.result.passed;
    }
    return CellTables{text, "{}", passed};
  };
  return list;
}

fs::path work_folder(const Folder& folder, const std::string& name) {
  return folder.path / "cells" / ("." + name + "." + cell_name(host_name()));
}

}  // namespace

TEST_CASE("cells: all are done, kept, and gathered in the list's order", "[cells]") {
  const Folder folder("cells");
  const CellList list = three();
  std::vector<std::string> seen;
  const auto show = [&](const DoneCell& done) { seen.push_back(done.record.cell + (done.kept ? " kept" : "")); };
  REQUIRE(do_cell(list, 2, folder.path, {}));
  CHECK(gather_cells(list, folder.path).missing == std::vector<std::string>{"a", "b"});
  CHECK(do_cells(list, folder.path, {}, show));
  CHECK(seen == std::vector<std::string>{"a", "b", "c kept"});
  const GatheredCells gathered = gather_cells(list, folder.path);
  CHECK(gathered.complete());
  CHECK(gathered.tables.text == "0\n1\n2\n");
  CHECK_FALSE(gathered.tables.passed);
  CHECK(gathered.records[2].result.positions == 9);
  CHECK(gathered.machines == std::vector<std::string>{machine_name()});
  CHECK(fake::whole(cell_folder(folder.path, "c") / "number.txt") == "2");
  CHECK_THAT(gathered_text(gathered), Contains("gathered 3 of 3 cells"));
  // Nothing but results is left.
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path / "cells"))
    CHECK(entry.path().filename().string()[0] != '.');
}

TEST_CASE("cells: a cell that is stopped or killed in its middle leaves nothing that counts", "[cells]") {
  const Folder folder("cells_killed");
  const CellList list = three();
  CellWatch stopped;
  stopped.stop = [] { return true; };
  CHECK_FALSE(do_cell(list, 0, folder.path, stopped));
  CHECK(fs::is_empty(folder.path / "cells"));
  CellList failing = list;
  failing.run = [](std::size_t, const fs::path& into, const CellWatch&) -> std::optional<CellResult> {
    write_file(into / "half.txt", "half");
    throw Error("is not there", "scene.yaml", "put it there");
  };
  CHECK_THROWS_WITH(do_cell(failing, 0, folder.path, {}), Contains("scene.yaml"));
  CHECK(fs::is_empty(folder.path / "cells"));

  const pid_t child = fork();
  if (child == 0) {
    CellWatch killed;
    killed.stop = []() -> bool { return std::raise(SIGKILL) != 0; };
    do_cell(list, 0, folder.path, killed);
    _exit(0);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  REQUIRE(WIFSIGNALED(status));
  CHECK(fs::exists(work_folder(folder, "a") / "result" / "number.txt"));
  CHECK(gather_cells(list, folder.path).missing.size() == 3);
  write_file(work_folder(folder, "a") / "result" / "stale.txt", "of a run that was killed");
  const auto done = do_cell(list, 0, folder.path, {});
  REQUIRE(done);
  CHECK_FALSE(done->kept);
  CHECK_FALSE(fs::exists(cell_folder(folder.path, "a") / "stale.txt"));
  CHECK_FALSE(fs::exists(work_folder(folder, "a")));
}

TEST_CASE("cells: a result has the key of the settings that it began with", "[cells]") {
  const Folder folder("cells_edited");
  std::string settings = "before";
  CellList list = three();
  list.key = [&](std::size_t) { return settings; };
  const auto run = list.run;
  list.run = [&](std::size_t k, const fs::path& into, const CellWatch& watch) {
    settings = "edited while the cell was done";
    return run(k, into, watch);
  };
  REQUIRE(do_cell(list, 0, folder.path, {}));
  CHECK(find_cell(list, 0, folder.path).state == CellState::of_other_settings);
  settings = "before";
  CHECK(find_cell(list, 0, folder.path).state == CellState::there);
}

TEST_CASE("cells: a list that keeps parts goes on with what a stopped try has left", "[cells]") {
  const Folder folder("cells_parts");
  CellList list = three();
  list.keeps_parts = true;
  list.run = [](std::size_t, const fs::path& into, const CellWatch&) -> std::optional<CellResult> {
    if (fs::exists(into / "part.txt")) return CellResult{"{\"number\": 5}"};
    write_file(into / "part.txt", "half");
    return {};
  };
  CHECK_FALSE(do_cell(list, 0, folder.path, {}));
  CHECK(do_cell(list, 0, folder.path, {}));
  list.key = [](std::size_t) { return "other settings"; };
  const auto anew = do_cell(list, 0, folder.path, {});  // the parts of the earlier result are there
  REQUIRE(anew);
  CHECK_FALSE(anew->kept);
}

TEST_CASE("cells: results of another program and of other settings are named, not gathered, and replaced", "[cells]") {
  const Folder folder("cells_other");
  do_cell(three(), 0, folder.path, {});
  CellList other = three();
  other.program = "4567";
  do_cell(other, 1, folder.path, {});
  do_cell(three("other settings"), 2, folder.path, {});
  const GatheredCells gathered = gather_cells(three(), folder.path);
  CHECK(gathered.records.size() == 1);
  CHECK(gathered.of_other_program == std::vector<std::string>{"b"});
  CHECK(gathered.of_other_settings == std::vector<std::string>{"c"});
  CHECK_FALSE(gathered.complete());
  CHECK_THAT(gathered_text(gathered),
             Contains("of another program, not gathered: b") && Contains("of other settings, not gathered: c"));
  const auto json = nlohmann::json::parse(gathered_json(three(), gathered));
  CHECK(json["of_other_program"][0] == "b");
  CHECK(json["passed"] == false);
  CHECK_FALSE(do_cell(three(), 1, folder.path, {})->kept);
  CHECK_FALSE(do_cell(three(), 2, folder.path, {})->kept);
  CHECK(gather_cells(three(), folder.path).complete());
}

TEST_CASE("cells: none is gathered twice", "[cells]") {
  const Folder folder("cells_twice");
  const CellList list = three();
  do_cell(list, 0, folder.path, {});
  fs::copy(cell_folder(folder.path, "a"), cell_folder(folder.path, "a_2"));
  fs::copy(cell_folder(folder.path, "a"), cell_folder(folder.path, "b"));  // under the name of another
  const GatheredCells gathered = gather_cells(list, folder.path);
  CHECK(gathered.tables.text == "0\n");
  CHECK(gathered.missing == std::vector<std::string>{"b", "c"});
}

TEST_CASE("cells: two workers at one cell do no harm", "[cells]") {
  const Folder folder("cells_workers");
  const CellList list = three();
  fs::create_directories(work_folder(folder, "a"));
  {
    const FolderLock other(work_folder(folder, "a"));
    CHECK_THROWS_WITH(do_cell(list, 0, folder.path, {}), Contains("another run writes into this folder"));
  }
  // Another machine is quicker.
  CellList slow = list;
  slow.run = [&](std::size_t k, const fs::path& into, const CellWatch& watch) {
    CellRecord record{"a", list.kind, list.program, "settings", "elsewhere", {"{\"number\": 8}"}};
    fs::create_directories(cell_folder(folder.path, "a"));
    write_file(cell_folder(folder.path, "a") / "cell.json", cell_record_json(record));
    return list.run(k, into, watch);
  };
  const auto done = do_cell(slow, 0, folder.path, {});
  REQUIRE(done);
  CHECK(done->kept);
  CHECK(done->record.machine == "elsewhere");
  CHECK(gather_cells(list, folder.path).tables.text == "8\n");
  CHECK_FALSE(fs::exists(work_folder(folder, "a")));

  // Whoever times the cells of a list together takes no times of others.
  CellWatch here;
  here.times_here = true;
  const auto timed = do_cell(list, 0, folder.path, here);
  REQUIRE(timed);
  CHECK_FALSE(timed->kept);
  CHECK(gather_cells(list, folder.path).machines == std::vector<std::string>{machine_name()});
}

TEST_CASE("cells: a result that cannot be read does not count", "[cells]") {
  const Folder folder("cells_broken");
  const CellList list = three();
  do_cell(list, 0, folder.path, {});
  const fs::path file = cell_folder(folder.path, "a") / "cell.json";
  const std::string whole = fake::whole(file);
  auto other_row = nlohmann::json::parse(whole);
  other_row["row"] = 5;
  for (const std::string& text : {std::string(), whole.substr(0, whole.size() / 2), std::string("[]"),
                                  std::string("{\"cell\": \"a\", \"positions_hash\": 3}"), other_row.dump()}) {
    write_file(file, text);
    CHECK(find_cell(list, 0, folder.path).state == CellState::missing);
  }
  CHECK_FALSE(do_cell(list, 0, folder.path, {})->kept);
}

TEST_CASE("cells: names are names of files and words of a command line", "[cells]") {
  CHECK(cell_name("a b/c") == "a_b_c");
  CHECK(cell_name("-x") == "c-x");
  CHECK(cell_name("..") == "c..");
  CHECK(cell_name("") == "c");
  CHECK(cell_name("t-shirt.walk_2") == "t-shirt.walk_2");
  std::vector<std::string> names{"a", "a_2", "a", "a"};
  number_equal_names(names);
  CHECK(names == std::vector<std::string>{"a", "a_2", "a_3", "a_4"});
  CellList list = three();
  list.names = {"tshirt.walk", "tank_top.walk"};
  CHECK(number_of(list, "tank_top.walk") == 1);
  CHECK_THROWS_WITH(number_of(list, "tshirt.wlak"),
                    Contains("did you mean `tshirt.walk`") && Contains("selvedge cells numbers.yaml"));
}

}  // namespace selvedge::test_do_cells
