#include "physics/scene/memory.hpp"

#include <catch2/catch.hpp>

#include "physics/scene/part_of_scene.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_memory {

namespace {

// Two sheets of 4 and 9 vertices, 2 and 8 triangles, beside a body of 4 vertices.
testing::World two_sheets() {
  testing::World w = make_world(testing::join(testing::sheet(1, 0.1, 0), testing::sheet(2, 0.1, 1)));
  Cloth &first = w.scene.cloths[0], second = first;
  first.vertex_count = second.first_vertex = 4;
  first.triangle_count = second.first_triangle = 2;
  second.vertex_count = 9;
  second.triangle_count = 8;
  w.scene.cloths.push_back(second);
  add_obstacle(w, testing::sheet(1, 1, -1));
  return w;
}

// A block of every kind, with the number of the row in all columns.
Memory numbered_blocks() {
  const auto rows = [](int count, int columns) {
    MemoryRows made(count, columns);
    for (int i = 0; i < count; ++i) made.row(i).setConstant(i);
    return made;
  };
  return {{"dummy.places", rows(13, 3), RowsOf::vertices, true},
          {"dummy.rates", rows(13, 3), RowsOf::vertices},
          {"dummy.strains", rows(10, 1), RowsOf::triangles},
          {"dummy.body", rows(4, 3), RowsOf::obstacle_vertices, true},
          {"dummy.seconds", rows(2, 1), RowsOf::cloths},
          {"dummy.all", rows(5, 2), RowsOf::none}};
}

}  // namespace

TEST_CASE("memory: a part of a scene takes its own rows of every kind", "[memory]") {
  testing::World w = two_sheets();
  w.state.memory = numbered_blocks();
  const PartOfScene part = part_of(w.scene, std::vector<char>{0, 1});
  const Memory of_part = state_of(part, w.state).memory;
  REQUIRE(of_part.size() == 6);
  CHECK((of_part[0].rows.rows() == 9 && of_part[0].rows(0, 0) == 4 && of_part[0].positions));
  CHECK((of_part[1].rows.rows() == 9 && of_part[1].rows(8, 2) == 12));
  CHECK((of_part[2].rows.rows() == 8 && of_part[2].rows(0, 0) == 2));
  CHECK(of_part[3].rows == w.state.memory[3].rows);
  CHECK((of_part[4].rows.rows() == 1 && of_part[4].rows(0, 0) == 1));
  CHECK(of_part[5].rows == w.state.memory[5].rows);
}

TEST_CASE("memory: put back, what a part lacks has the whole's places, and zeros else", "[memory]") {
  testing::World w = two_sheets();
  w.state.x.setRandom();
  w.state.memory = numbered_blocks();
  const PartOfScene part = part_of(w.scene, std::vector<char>{0, 1});
  State whole = w.state;
  whole.memory = {{"other.gone", MemoryRows::Zero(1, 1)}};
  put(part, state_of(part, w.state), whole);
  REQUIRE(whole.memory.size() == 6);
  CHECK(whole.memory[0].rows.topRows(4) == w.state.x.topRows(4));
  CHECK(whole.memory[0].rows.bottomRows(9) == w.state.memory[0].rows.bottomRows(9));
  CHECK(whole.memory[1].rows.topRows(4).isZero(0));
  CHECK(whole.memory[1].rows.bottomRows(9) == w.state.memory[1].rows.bottomRows(9));
  CHECK(whole.memory[2].rows.rows() == 10);
  CHECK(whole.memory[2].rows.bottomRows(8) == w.state.memory[2].rows.bottomRows(8));
  CHECK(whole.memory[3].rows == w.state.memory[3].rows);
  CHECK((whole.memory[4].rows(0, 0) == 0 && whole.memory[4].rows(1, 0) == 1));
}

TEST_CASE("memory: blocks are found by name and size, replaced by owner, and lose what tells of motion", "[memory]") {
  Memory memory = numbered_blocks();
  REQUIRE(find_rows(memory, "dummy.rates", 13));
  CHECK(*find_rows(memory, "dummy.rates", 13) == memory[1].rows);
  CHECK_FALSE(find_rows(memory, "dummy.rates", 12));
  CHECK_FALSE(find_rows(memory, "dummy.rate", 13));
  memory.push_back({"dum.my", MemoryRows::Zero(1, 1)});
  replace_blocks("dummy", {{"dummy.new", MemoryRows::Zero(2, 2)}}, memory);
  REQUIRE(memory.size() == 2);
  CHECK((memory[0].name == "dum.my" && memory[1].name == "dummy.new"));

  Memory motion = numbered_blocks();
  forget_motion(motion);
  REQUIRE(motion.size() == 4);
  CHECK((motion[0].name == "dummy.places" && motion[1].name == "dummy.body"));

  const std::vector<Points> bodies{Points::Random(3, 3), Points(), Points::Random(2, 3)};
  CHECK(joined_rows(bodies).bottomRows(2) == bodies[2]);
  CHECK(split_rows(joined_rows(bodies), bodies) == bodies);
}

}  // namespace selvedge::test_memory
