#include <catch2/catch.hpp>

#include "physics/recovery/balanced_motion.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_balanced_motion {

namespace {

// Two pieces of 2 x 2 quads, vertices 0..8 and 9..17, the second twice as heavy.
struct TwoPieces {
  Surface cloth;
  Eigen::VectorXd inverse_mass = Eigen::VectorXd::Constant(18, 1.0);
  Points way = Points::Zero(18, 3);
  TwoPieces() {
    const testing::Sheet two = testing::join(testing::sheet(2, 1, 0), testing::sheet(2, 1, 0.1));
    cloth = make_surface(18, two.triangles);
    inverse_mass.tail(9).setConstant(0.5);
  }
  Points move(std::span<const Separation> pushes, double reach) const {
    return balanced_motion(cloth, inverse_mass, pushes, way, reach);
  }
  Vec3 momentum(const Points& move) const {
    Vec3 sum = Vec3::Zero();
    for (int v = 0; v < 18; ++v)
      if (inverse_mass[v] > 0) sum += row(move, v) / inverse_mass[v];
    return sum;
  }
};

// Vertex v of the one piece up, by `least`, against face (9, 10, 12) of the other.
Separation against_face(int v, double least) {
  return {{v, 9, 10, 12, -1}, {1, -0.5, -0.25, -0.25, 0}, Vec3::UnitY(), least, 4};
}

Separation against_obstacle(int v, double least) { return {{v, -1, -1, -1, -1}, {1}, Vec3::UnitY(), least, 1}; }

double value(const Separation& push, const Points& move) {
  double sum = 0;
  for (int i = 0; i < push.count; ++i) sum += push.weight[i] * push.direction.dot(row(move, push.vertex[i]));
  return sum;
}

}  // namespace

TEST_CASE("balanced motion: one side of a push goes against the other, each by its inverse mass", "[balanced_motion]") {
  const TwoPieces two;
  const Separation push = against_face(4, 0.03);
  const Points move = two.move(std::array{push}, 1);
  CHECK(value(push, move) == Approx(0.03));
  CHECK(two.momentum(move).norm() < 1e-15);
  CHECK(move(4, 1) > 0);
  CHECK(move(9, 1) == Approx(-0.25 * move(4, 1)));  // half the weight, twice the mass
  CHECK(move(10, 1) == Approx(0.5 * move(9, 1)));
  CHECK(move(11, 1) == 0);
}

TEST_CASE("balanced motion: the mean of what moves together is taken away, and nothing else moves",
          "[balanced_motion]") {
  TwoPieces two;
  two.way.row(0) << 0.02, 0, 0.01;  // neighbours
  two.way.row(1) << 0.01, 0.03, 0;
  two.way.row(9) << 0, 0.02, 0;  // of the other piece
  two.way.row(17) << 0, 0, 0.02;
  const Points move = two.move({}, 1);
  CHECK(two.momentum(move).norm() < 1e-15);
  CHECK(move.row(9).norm() < 1e-15);  // alone in its set, as vertex 17 is
  CHECK(move.row(17).norm() < 1e-15);
  CHECK((move.row(0) - move.row(1) - (two.way.row(0) - two.way.row(1))).norm() < 1e-15);
  for (int v = 2; v < 9; ++v) CHECK(move.row(v).norm() == 0);
  // Joined by a push that the ways meet: together they have no momentum, each for itself has.
  const Separation push = against_face(0, -1);
  const Points joined = two.move(std::array{push}, 1);
  CHECK(two.momentum(joined).norm() < 1e-15);
  CHECK((joined.row(0) - joined.row(9) - (two.way.row(0) - two.way.row(9))).norm() < 1e-15);
  CHECK(joined.row(9).norm() > 0.005);
}

TEST_CASE("balanced motion: what leans on something prescribed keeps its mean", "[balanced_motion]") {
  TwoPieces two;
  two.way.row(0) << 0, 0.02, 0;
  two.way.row(1) << 0, 0.01, 0;
  const Separation out = against_obstacle(0, 0.04);
  const Points move = two.move(std::array{out}, 1);
  CHECK(move(0, 1) == Approx(0.04));
  CHECK(move(1, 1) == Approx(0.01));
  // The same against a face of which one vertex is pinned: it stays, whatever its way, and the others give way.
  two.inverse_mass[9] = 0;
  two.way.row(9) << 0, 0.02, 0;
  const Separation push = against_face(0, 0.04);
  const Points pinned = two.move(std::array{push}, 1);
  CHECK(value(push, pinned) == Approx(0.04));
  CHECK(pinned.row(9).norm() == 0);
  CHECK(pinned(1, 1) == Approx(0.01));
  CHECK(pinned(10, 1) < 0);
  // All pinned: nothing to move, and no division by nothing.
  two.inverse_mass.setZero();
  CHECK(two.move(std::array{push}, 1).norm() == 0);
}

TEST_CASE("balanced motion: no farther than the reach, and still without momentum", "[balanced_motion]") {
  TwoPieces two;
  for (int v = 0; v < 18; ++v) two.way.row(v) << 0.01 * v, 0.3 - 0.02 * v, 0.001 * v * v;
  const std::array pushes{against_face(4, 0.2), against_face(0, 0.05), against_face(8, 0.1)};
  const double reach = 0.04;
  const Points move = two.move(pushes, reach);
  CHECK(move.rowwise().norm().maxCoeff() <= reach * (1 + 1e-12));
  CHECK(two.momentum(move).norm() < 1e-14);
  CHECK(move.norm() > 0.5 * reach);
}

TEST_CASE("balanced motion: where one push goes far beyond the reach, the way that does what the others ask is kept",
          "[balanced_motion]") {
  TwoPieces two;
  for (const int v : {9, 10, 12}) two.inverse_mass[v] = 0;
  two.way.topRows(9).col(1).setConstant(0.03);
  std::vector<Separation> pushes;
  for (int v = 0; v < 9; ++v) pushes.push_back(against_obstacle(v, 0.03));
  const Points free = two.move(pushes, 0.04);
  // Pinned but for a fiftieth: its vertex would have to go 1.5 m, and all that moves with it a fiftieth of its way.
  pushes.push_back({{4, 9, 10, 12, -1}, {0.02, -0.5, -0.25, -0.25, 0}, Vec3::UnitX(), 0.03, 4});
  const Points move = two.move(pushes, 0.04);
  for (int v = 0; v < 9; ++v) CHECK(value(pushes[static_cast<std::size_t>(v)], move) == Approx(0.03));
  CHECK(move == free);
  // Where pushes do more than the way, they count.
  two.way.setZero();
  CHECK(value(pushes[9], two.move(pushes, 0.04)) > 0);
}

}  // namespace selvedge::test_balanced_motion
