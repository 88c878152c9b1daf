#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "pipeline/cells/do_cells.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/write_file.hpp"
#include "tests/pipeline/files.hpp"

// The kind of work of docs/extending.md.
namespace selvedge::test_added_work {

// How many triangles each of some meshes has.
CellList count_cells(const std::vector<std::filesystem::path>& meshes) {
  CellList list;
  list.kind = "counts";
  list.program = program_key();
  for (const std::filesystem::path& mesh : meshes) list.names.push_back(cell_name(mesh.stem().string()));
  number_equal_names(list.names);
  list.describe = [meshes, names = list.names](std::size_t k) { return WorkCell{names[k], {meshes[k]}, 0.1}; };
  list.key = [meshes](std::size_t k) { return fmt::format("{:016x}", hash_of_file(meshes[k])); };
  list.run = [meshes](std::size_t k, const std::filesystem::path&, const CellWatch&) -> std::optional<CellResult> {
    const auto count = read_mesh(meshes[k]).triangles.rows();
    return CellResult{fmt::format("{{\"triangles\": {}}}", count), count > 0};
  };
  list.gather = [](const std::vector<CellRecord>& records, const std::filesystem::path& out) {
    CellTables tables{"", "{}", true};
    for (const CellRecord& record : records) {
      tables.text += record.cell + ": " + record.result.row;
      tables.passed = tables.passed && record.result.passed;
    }
    write_file(out / "counts.txt", tables.text);
    return tables;
  };
  return list;
}

TEST_CASE("extending: an added kind of work is done in cells and gathered", "[cells]") {
  const fake::Folder folder("added_work");
  std::filesystem::create_directory(folder.path / "other");
  const auto one = fake::write(folder, "one.obj", "v 0 0 0\nv 2 0 0\nv 0 0 1\nf 1 2 3\n");
  const auto two = fake::write(folder, "other/one.obj", "v 0 0 0\nv 2 0 0\nv 0 0 1\nv 2 0 1\nf 1 2 3\nf 3 2 4\n");
  const CellList list = count_cells({one, two});
  CHECK(list.names == std::vector<std::string>{"one", "one_2"});
  CHECK(list.describe(1).needs == std::vector<std::filesystem::path>{two});
  const std::filesystem::path out = folder.path / "out";
  REQUIRE(do_cell(list, 1, out, {}));
  CHECK(gather_cells(list, out).missing == std::vector<std::string>{"one"});
  REQUIRE(do_cell(list, 0, out, {}));
  const GatheredCells gathered = gather_cells(count_cells({one, two}), out);
  CHECK(gathered.complete());
  CHECK(gathered.tables.passed);
  CHECK(fake::whole(out / "counts.txt") == gathered.tables.text);
  CHECK(fake::has(gathered.tables.text, "\"triangles\": 2"));
  fake::write(folder, "one.obj", "v 0 0 0\nv 3 0 0\nv 0 0 1\nf 1 2 3\n");
  CHECK(gather_cells(count_cells({one, two}), out).of_other_settings == std::vector<std::string>{"one"});
}

}  // namespace selvedge::test_added_work
