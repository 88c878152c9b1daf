#include <catch2/catch.hpp>

#include "tests/sources.hpp"

namespace selvedge::test_rooms {

// Rooms are the sub-folders of a module, in one chain as the modules are: who may include whom inside a module, that
// no two files lean on each other, and that no folder grows beyond what a reader can take in.

using namespace selvedge::sources;

namespace {

constexpr int most_files = 49;  // of a folder

enum class Door {
  open,
  closed_to_module,  // no other room of its module includes it
  closed             // nobody includes it
};

// A room includes itself and the open rooms to its left; where `only` names some, of these no others.
struct Room {
  std::string name;
  std::vector<std::string> only = {};
  Door door = Door::open;
};

// Each module's rooms from left to right; some are still to come.
const std::map<std::string, std::vector<Room>> rooms = {
    {"collision",
     {{"geometry"},
      {"exact"},
      {"search"},
      {"contour"},
      {"penetration"},
      {"distance"},
      {"contact", {"geometry", "exact", "search", "penetration", "distance"}},
      {"untangle"},
      {"audit", {"geometry", "exact"}, Door::closed_to_module}}},
    {"physics", {{"scene"}, {"energies"}, {"linear"}, {"solve"}, {"recovery"}, {"frame"}, {"steppers"}}},
    {"learned",
     {{"graph"},
      {"losses"},
      {"network"},
      {"gradients"},
      {"repulsion"},
      {"steppers"},
      {"torch", {"graph", "network", "gradients"}, Door::closed}}},
    {"pipeline",
     {{"host"},
      {"config"},
      {"plots", {"host"}},
      {"reports", {"host"}},
      {"formats"},
      {"hdf5"},
      {"exports"},
      {"shapes"},
      {"bodies"},
      {"motions"},
      {"garments"},
      {"patterns"},
      {"obstacles"},
      {"weights"},
      {"scene"},
      {"run"},
      {"measures"},
      {"view", {"host", "reports", "hdf5"}},
      {"cells"},
      {"tools"},
      {"processes"},
      {"mpi", {"processes"}, Door::closed},
      {"training"},
      {"teach"},
      {"drapes"},
      {"validate"},
      {"compare"},
      {"suites"},
      {"python"},
      {"commands"}}}};
const std::string program = "pipeline/main.cpp";  // stands above all rooms

struct Place {
  std::string module, room;  // room: empty for a file that stands in none
};

Place place_of(const std::string& path) {
  const std::size_t first = path.find('/'), second = path.find('/', first + 1);
  if (second == std::string::npos) return {path.substr(0, first), ""};
  return {path.substr(0, first), path.substr(first + 1, second - first - 1)};
}

const Room* find_room(const Place& place) {
  const auto module = rooms.find(place.module);
  if (module == rooms.end()) return nullptr;
  const auto room = std::ranges::find(module->second, place.room, &Room::name);
  return room == module->second.end() ? nullptr : &*room;
}

// Whether a file in the room `own` may include a header of the room `theirs`, of this module or of another.
bool may_include(const Place& own, const Place& theirs) {
  const Room *from = find_room(own), *to = find_room(theirs);
  if (!to) return false;
  if (from == to) return true;
  if (to->door == Door::closed) return false;
  if (own.module != theirs.module) return true;
  if (to->door == Door::closed_to_module) return false;
  if (!from) return true;  // the program
  if (!from->only.empty()) return std::ranges::find(from->only, to->name) != from->only.end();
  return to < from;  // both in the module's list
}

// Files of a module stand in its rooms, and its tests in folders of the same names.
Complaints wrong_rooms(const std::string& file, const std::string& text) {
  Complaints complaints;
  if (file.starts_with("tests/")) {
    const Place place = place_of(file.substr(6));
    const bool is_test = fs::path(file).filename().string().starts_with("test_");
    if (rooms.contains(place.module) && (is_test || !place.room.empty()) && !find_room(place))
      complaints.push_back(at(file, 1) + "stands in no room of " + place.module);
    return complaints;
  }
  const Place own = place_of(file);
  if (file != program && !find_room(own)) complaints.push_back(at(file, 1) + "stands in no room of " + own.module);
  for (const Include& include : includes(text)) {
    const Place theirs = place_of(include.header);
    if (include.quoted && rooms.contains(theirs.module) && !may_include(own, theirs))
      complaints.push_back(at(file, include.line) + own.module + "/" + own.room + " must not include " +
                           include.header);
  }
  return complaints;
}

using Stems = std::map<std::string, std::set<std::string>>;

// Adds the stem and all that it leans on.
void add_parts(const std::string& stem, const Stems& included, std::set<std::string>& parts) {
  if (!parts.insert(stem).second) return;
  if (const auto found = included.find(stem); found != included.end())
    for (const std::string& next : found->second) add_parts(next, included, parts);
}

std::set<std::string> parts_of(const std::vector<std::string>& stems, const Texts& sources) {
  std::set<std::string> parts;
  const Stems included = included_stems(sources);
  for (const std::string& stem : stems) add_parts(stem, included, parts);
  return parts;
}

// Groups of stems that lean on each other, a line each.
Complaints circles(const Texts& sources) {
  const Stems included = included_stems(sources);
  Stems reached;  // from what a stem includes, so that it reaches itself only by a circle
  for (const auto& [stem, direct] : included)
    for (const std::string& next : direct) add_parts(next, included, reached[stem]);
  std::set<std::string> lines;
  for (const auto& [stem, reach] : reached) {
    std::string line;
    for (const std::string& other : reach)
      if (const auto back = reached.find(other); back != reached.end() && back->second.contains(stem))
        line += (line.empty() ? "" : " <-> ") + other;
    if (!line.empty()) lines.insert(line);
  }
  return {lines.begin(), lines.end()};
}

// Of a list of files, by path from the root.
Complaints crowded_folders(const std::vector<std::string>& files) {
  std::map<std::string, int> count;
  for (const std::string& file : files) ++count[fs::path(file).parent_path().generic_string()];
  Complaints complaints;
  for (const auto& [folder, number] : count)
    if (number > most_files) complaints.push_back(folder + ": " + std::to_string(number) + " files");
  return complaints;
}

std::vector<std::string> all_files() {
  std::vector<std::string> files;
  for (const std::string folder : {"collision", "physics", "learned", "pipeline", "tests", "docs", "configs", "cmake"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(root).generic_string());
  return files;
}

}  // namespace

TEST_CASE("rooms: includes go left along the rooms of a module", "[modules]") {
  CHECK(listed(over_all_sources(wrong_rooms)) == "");

  const auto complaints = [](const std::string& file, const std::string& header) {
    return wrong_rooms(file, "#include \"" + header + "\"\n").size();
  };
  CHECK(listed(wrong_rooms("physics/linear/a.cpp", "\n#include \"physics/solve/b.hpp\"\n")) ==
        "\nphysics/linear/a.cpp:2: physics/linear must not include physics/solve/b.hpp");
  CHECK(complaints("physics/linear/a.cpp", "physics/linear/b.hpp") == 0);
  CHECK(complaints("physics/linear/a.cpp", "physics/scene/b.hpp") == 0);
  CHECK(complaints("physics/scene/a.cpp", "collision/untangle/b.hpp") == 0);
  CHECK(complaints("pipeline/host/a.cpp", "pipeline/config/b.hpp") == 1);
  CHECK(complaints("pipeline/main.cpp", "pipeline/commands/b.hpp") == 0);
  CHECK(complaints("pipeline/commands/a.cpp", "pipeline/b.hpp") == 1);
  CHECK(wrong_rooms("pipeline/a.cpp", "").size() == 1);
  CHECK(wrong_rooms("physics/odds/a.cpp", "").size() == 1);
}

TEST_CASE("rooms: some include less than all to their left, and some are included by few", "[modules]") {
  const auto complaints = [](const std::string& file, const std::string& header) {
    return wrong_rooms(file, "#include \"" + header + "\"\n").size();
  };
  CHECK(complaints("collision/contact/a.cpp", "collision/search/b.hpp") == 0);
  CHECK(complaints("collision/contact/a.cpp", "collision/contour/b.hpp") == 1);
  CHECK(complaints("collision/untangle/a.cpp", "collision/contour/b.hpp") == 0);
  CHECK(complaints("collision/audit/a.cpp", "collision/exact/b.hpp") == 0);
  CHECK(complaints("collision/audit/a.cpp", "collision/search/b.hpp") == 1);
  CHECK(complaints("collision/untangle/a.cpp", "collision/audit/b.hpp") == 1);
  CHECK(complaints("physics/steppers/a.cpp", "collision/audit/b.hpp") == 0);
  CHECK(complaints("pipeline/view/a.cpp", "pipeline/hdf5/b.hpp") == 0);
  CHECK(complaints("pipeline/view/a.cpp", "pipeline/formats/b.hpp") == 1);
  CHECK(complaints("pipeline/formats/a.cpp", "pipeline/hdf5/b.hpp") == 1);
  CHECK(complaints("pipeline/view/a.cpp", "pipeline/scene/b.hpp") == 1);
  CHECK(complaints("learned/torch/a_torch.cpp", "learned/network/b.hpp") == 0);
  CHECK(complaints("learned/torch/a_torch.cpp", "learned/steppers/b.hpp") == 1);
  CHECK(complaints("learned/network/a.cpp", "learned/torch/b_torch.hpp") == 1);
  CHECK(complaints("pipeline/training/a.cpp", "learned/torch/b_torch.hpp") == 1);
  CHECK(complaints("pipeline/mpi/a_mpi.cpp", "pipeline/processes/b.hpp") == 0);
  CHECK(complaints("pipeline/mpi/a_mpi.cpp", "pipeline/host/b.hpp") == 1);
}

TEST_CASE("rooms: the table names each room once, and only rooms of the module", "[modules]") {
  for (const auto& [module, all] : rooms)
    for (const Room& room : all) {
      INFO(module << "/" << room.name);
      CHECK(std::ranges::count(all, room.name, &Room::name) == 1);
      for (const std::string& left : room.only) {
        const Room* found = find_room({module, left});
        REQUIRE(found);
        CHECK(found < &room);
      }
    }
}

TEST_CASE("rooms: tests stand in folders named for the rooms", "[modules]") {
  CHECK(wrong_rooms("tests/physics/linear/test_a.cpp", "").empty());
  CHECK(wrong_rooms("tests/physics/threads.hpp", "").empty());
  CHECK(wrong_rooms("tests/test_a.cpp", "").empty());
  CHECK(wrong_rooms("tests/physics/test_a.cpp", "").size() == 1);
  CHECK(wrong_rooms("tests/physics/contact/test_a.cpp", "").size() == 1);
}

TEST_CASE("rooms: no two files lean on each other", "[modules]") {
  CHECK(listed(circles(all_sources())) == "");

  Texts example = {{"m/a.hpp", "#include \"m/b.hpp\"\n#include <m/d.hpp>\n"},
                   {"m/b.hpp", "#include \"m/c.hpp\"\n"},
                   {"m/c.hpp", ""},
                   {"m/d.hpp", "#include \"m/a.hpp\"\n"},
                   {"m/c.cpp", "#include \"m/c.hpp\"\n"}};
  CHECK(circles(example).empty());
  example["m/c.cpp"] += "#include \"m/a.hpp\"\n";  // an implementation that needs what needs its header
  CHECK(circles(example) == Complaints{"m/a <-> m/b <-> m/c"});
}

TEST_CASE("rooms: no folder is crowded", "[modules]") {
  const std::vector<std::string> ours = all_files();
  CHECK(ours.size() > 400);
  CHECK(listed(crowded_folders(ours)) == "");

  std::vector<std::string> files;
  for (int k = 0; k < most_files; ++k) files.push_back("physics/linear/" + std::to_string(k) + ".cpp");
  files.push_back("physics/linear/deeper/a.cpp");
  CHECK(crowded_folders(files).empty());
  files.push_back("physics/linear/one_more.hpp");
  CHECK(crowded_folders(files) == Complaints{"physics/linear: 50 files"});
}

TEST_CASE("rooms: the audit leans on geometry and exact signs alone", "[modules]") {
  const auto strange = [](const Texts& sources) {
    std::set<std::string> found;
    for (const std::string& part : parts_of({"collision/audit/audit", "collision/audit/audit_motion"}, sources))
      if (const Place place = place_of(part);
          place.module != "collision" || (place.room != "audit" && place.room != "geometry" && place.room != "exact"))
        found.insert(part);
    return found;
  };
  Texts ours = all_sources();
  CHECK(strange(ours).empty());
  CHECK(parts_of({"collision/audit/audit"}, ours).contains("collision/exact/orientation"));

  ours["collision/geometry/surface.cpp"] += "#include \"collision/search/bvh.hpp\"\n";
  CHECK(strange(ours).contains("collision/search/bvh"));
  CHECK(parts_of({"a"}, {{"a.cpp", "#include \"b.hpp\"\n#include <c.hpp>\n"},
                         {"b.cpp", "#include \"d.hpp\"\n#include \"b.hpp\"\n"}}) ==
        std::set<std::string>{"a", "b", "d"});
}

}  // namespace selvedge::test_rooms
