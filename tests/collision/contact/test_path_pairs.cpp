#include <catch2/catch.hpp>
#include <random>

#include "collision/contact/pair_motion.hpp"
#include "collision/contact/path_pairs.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_path_pairs {

using testing::join;
using testing::sheet;

namespace {

Points shaken(const Points& x, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, size);
  Points y = x;
  for (Eigen::Index i = 0; i < y.size(); ++i) y.data()[i] += normal(random);
  return y;
}

// Two sheets as one cloth, and a search for its pairs.
struct TwoSheets {
  Points x;
  Surface cloth;
  ContactWorld world;
  PairSearch search;

  explicit TwoSheets(const testing::Sheet& both)
      : x(both.x),
        cloth(make_surface(static_cast<int>(x.rows()), both.triangles)),
        world(make_contact_world(cloth, {}, true)),
        search(world) {}
  TwoSheets(const TwoSheets&) = delete;  // the world looks at the cloth
  TwoSheets& operator=(const TwoSheets&) = delete;
};

// At so many times of the motion and its start.
double least_distance(const NodePair& pair, const Points& x0, const Points& x1, int times = 40) {
  const std::array<Vec3, 4> from = corners(pair, x0), to = corners(pair, x1);
  double least = 1e30;
  for (int k = 0; k <= times; ++k) {
    std::array<Vec3, 4> x;
    for (int i = 0; i < 4; ++i) x[i] = from[i] + static_cast<double>(k) / times * (to[i] - from[i]);
    least = std::min(least, std::sqrt(closest(pair.kind, x).squared_distance));
  }
  return least;
}

}  // namespace

TEST_CASE("path pairs: a pair is left out only if it stays away", "[path_pairs]") {
  TwoSheets both(join(sheet(5, 0.2, 0), sheet(5, 0.2, 3e-3)));
  const double thickness = 4e-3;
  PathPairs path;
  const Points start = shaken(both.x, 5e-4, 1);
  REQUIRE(update_pairs(both.search, thickness, start, start, path));
  int out = 0, in = 0;
  for (unsigned seed = 2; seed < 8; ++seed) {
    // A common drift costs nothing; what differs from node to node does.
    Points x0 = shaken(start, 3e-4, seed), x1 = shaken(start, 3e-4, 10 * seed);
    x0.array() += 1e-4 * seed;
    const PairMotion motion(path.start, x0, x1);
    for (std::size_t i = 0; i < path.pairs.size(); ++i)
      for (const double distance : {2e-4, 2e-3}) {
        const bool may = motion.may_come_within(path.pairs[i], path.gap[i], distance);
        (may ? in : out)++;
        if (!may) CHECK(least_distance(path.pairs[i], x0, x1) > distance);
      }
  }
  CHECK(in > 100);
  CHECK(out > 100);
  Points far = start;
  far.array() += 100;
  CHECK_FALSE(PairMotion(path.start, far, far).may_come_within(path.pairs[0], path.gap[0], 0.9 * path.gap[0]));
}

TEST_CASE("path pairs: what is near is listed, from a kept list as from a new one", "[path_pairs]") {
  TwoSheets both(join(sheet(6, 0.2, 0), sheet(5, 0.2, 3e-3)));
  const double thickness = 4e-3;
  PairSearch other(both.world);
  PathPairs kept, fresh;
  REQUIRE(update_pairs(both.search, thickness, both.x, both.x, kept));
  const Points near = shaken(both.x, 4e-4, 3);
  REQUIRE_FALSE(update_pairs(both.search, thickness, near, near, kept));
  REQUIRE(update_pairs(other, thickness, near, near, fresh));
  std::vector<NodePair> a, b;
  for (const NodePair& pair : pairs_within(kept, near, thickness))
    if (closest(pair, near).squared_distance < thickness * thickness) a.push_back(pair);
  for (const NodePair& pair : pairs_within(fresh, near, thickness))
    if (closest(pair, near).squared_distance < thickness * thickness) b.push_back(pair);
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  CHECK(a.size() > 50);
  CHECK(a == b);
}

namespace {

// Of the listed ones, in order: those that are seen to come within the distance on the way.
std::vector<NodePair> coming_near(const PathPairs& path, const Points& x0, const Points& x1, double distance,
                                  int times = 40) {
  std::vector<NodePair> near;
  for (const NodePair& pair : path.pairs)
    if (least_distance(pair, x0, x1, times) < distance) near.push_back(pair);
  std::sort(near.begin(), near.end());
  return near;
}

}  // namespace

TEST_CASE("path pairs: where few nodes end elsewhere the list is mended, and lists what a new one does",
          "[path_pairs]") {
  TwoSheets both(join(sheet(8, 0.2, 0), sheet(7, 0.2, 6e-3)));
  const double thickness = 2e-3;
  PathPairs mended;
  Points end = both.x.rowwise() + Eigen::RowVector3d(0.03, -0.01, 0.02);
  REQUIRE(update_pairs(both.search, thickness, both.x, end, mended));
  std::mt19937 random(5);
  std::size_t gained = 0;
  for (int turn = 0; turn < 6; ++turn) {
    for (int k = 0; k < 10; ++k) end(static_cast<int>(random() % 145), 1) += k % 2 == 0 ? 8e-3 : -8e-3;
    const std::size_t before = mended.pairs.size();
    REQUIRE_FALSE(update_pairs(both.search, thickness, both.x, end, mended));
    gained += mended.pairs.size() > before;
    PairSearch other(both.world);
    PathPairs fresh;
    REQUIRE(update_pairs(other, thickness, both.x, end, fresh));
    const auto near = coming_near(fresh, both.x, end, thickness);
    CHECK(near.size() > 10);
    CHECK(coming_near(mended, both.x, end, thickness) == near);
    std::vector<NodePair> listed = mended.pairs;
    std::sort(listed.begin(), listed.end());
    CHECK(std::ranges::adjacent_find(listed) == listed.end());
  }
  CHECK(gained > 2);
  // From another start, or where everything ends elsewhere, nothing of it is good any more.
  CHECK(update_pairs(both.search, thickness, both.x, both.x, mended));
  CHECK(update_pairs(both.search, thickness, end, end, mended));
}

TEST_CASE("path pairs: a list for marked nodes has all of their pairs, mended too", "[path_pairs]") {
  TwoSheets both(join(sheet(8, 0.2, 0), sheet(7, 0.2, 6e-3)));
  const double thickness = 2e-3;
  PathPairs of_marked, all;
  of_marked.marks.assign(static_cast<std::size_t>(both.x.rows()), 0);
  for (const int node : {3, 40, 41, 100}) of_marked.marks[node] = 1;
  const auto with_marked = [&](std::vector<NodePair> pairs) {
    std::erase_if(pairs, [&](const NodePair& pair) {
      return std::ranges::none_of(pair.nodes, [&](int node) { return of_marked.marks[node] != 0; });
    });
    return pairs;
  };
  Points end = both.x.rowwise() + Eigen::RowVector3d(0.03, -0.01, 0.02);
  for (const int node : {40, 60, 62, 64, 66}) end(node, 1) += 8e-3;
  PairSearch other(both.world);
  REQUIRE(update_pairs(both.search, thickness, both.x, end, of_marked));
  REQUIRE(update_pairs(other, thickness, both.x, end, all));
  CHECK(of_marked.pairs.size() > 3);
  CHECK(of_marked.pairs.size() < all.pairs.size() / 2);
  for (const int node : {41, 70}) end(node, 1) += 8e-3;
  REQUIRE_FALSE(update_pairs(both.search, thickness, both.x, end, of_marked));
  REQUIRE_FALSE(update_pairs(other, thickness, both.x, end, all));
  const auto near = with_marked(coming_near(all, both.x, end, thickness));
  CHECK(near.size() > 3);
  CHECK(with_marked(coming_near(of_marked, both.x, end, thickness)) == near);
}

TEST_CASE("path pairs: boxes of long motions overlap, and only what may come near is listed", "[path_pairs]") {
  // Two sheets that turn together, a hand's breadth apart.
  TwoSheets both(join(sheet(8, 1, 0), sheet(8, 1, 0.08)));
  const Mat3 turn = Eigen::AngleAxisd(0.5, Vec3::UnitX()).toRotationMatrix();
  const Points end = both.x * turn.transpose();
  PathPairs path;
  REQUIRE(update_pairs(both.search, 2e-3, both.x, end, path));
  std::vector<NodePair> boxes;
  both.search.find(both.x, end, 4e-3, boxes);
  CHECK(path.pairs.size() < boxes.size());
  for (const NodePair& pair : boxes) {
    const bool listed = std::ranges::find(path.pairs, pair) != path.pairs.end();
    CHECK((listed || least_distance(pair, both.x, end) > 2e-3));
  }
}

TEST_CASE("path pairs: a search for what may come near lists no other pairs than one that leaves the rest out later",
          "[path_pairs]") {
  TwoSheets both(join(sheet(8, 0.2, 0), sheet(7, 0.2, 3e-3)));
  const double reach = 4e-3;
  const Points start = shaken(both.x, 5e-4, 3), end = shaken(start, GENERATE(5e-4, 6e-3), 4);
  std::vector<char> marks(static_cast<std::size_t>(both.x.rows()), GENERATE(0, 1));
  marks[40] = 1;
  std::vector<NodePair> boxes, near;
  std::vector<double> gap;
  both.search.find(start, end, reach, boxes, marks);
  const std::int64_t overlapping = both.search.tally().candidates;
  both.search.find_near(start, end, reach, near, gap, marks);
  CHECK(both.search.tally().candidates == 2 * overlapping);
  CHECK(both.search.tally().searches == 2);
  const PairMotion motion(start, start, end);
  std::size_t next = 0, expected = 0;
  for (const NodePair& pair : boxes) {
    const double own = std::sqrt(closest(pair, start).squared_distance);
    const bool listed = next < near.size() && near[next] == pair;  // in the same order
    if (listed) CHECK((gap[next] <= own && gap[next] > own - 1e-6));
    if (!listed) CHECK(least_distance(pair, start, end) > reach);
    next += listed;
    expected += motion.may_come_within(pair, own, reach);
  }
  CHECK(next == near.size());
  CHECK(gap.size() == near.size());
  CHECK(static_cast<double>(near.size()) < 1.001 * static_cast<double>(expected) + 1);
  CHECK(near.size() > 3);
}

TEST_CASE("path pairs: no pair that comes near is missing from a list that was kept or mended, over 1,000 motions",
          "[path_pairs]") {
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  const auto any = [&](double size) {
    return Vec3(size * normal(random), size * normal(random), size * normal(random));
  };
  const double thickness = 2e-3;
  int kept = 0, mended = 0, anew = 0, met = 0, missing = 0;
  for (int scene = 0; scene < 20; ++scene) {
    const testing::Sheet layers = join(sheet(3, 0.06, 0), sheet(4, 0.06, 3e-3)), under = sheet(5, 0.07, -2e-3);
    const Surface cloth = make_surface(static_cast<int>(layers.x.rows()), layers.triangles);
    const Surface body = make_surface(static_cast<int>(under.x.rows()), under.triangles);
    const ContactWorld world = make_contact_world(cloth, {&body}, scene % 4 > 0);
    PairSearch search(world);
    PathPairs path;
    Points rest(layers.x.rows() + under.x.rows(), 3);
    rest << layers.x, under.x;
    Points x0 = shaken(rest, 3e-4, scene + 1), end = x0;
    for (int motion = 0; motion < 50; ++motion) {
      // Ends are those of the last motion with a change that is common to the cloth, or of a few nodes, or of all.
      if (motion % 10 == 0) {
        x0 = motion % 20 == 0 ? shaken(rest, 5e-4, 50 * scene + motion + 1) : Points(shaken(end, 2e-4, motion));
        end = x0.rowwise() + any(0.01).transpose();
      }
      const double size = (motion % 5) * 4e-4;
      const Vec3 common = any(size), of_body = motion % 4 == 1 ? any(5e-4) : Vec3(0, 0, 0);
      for (int node = 0; node < end.rows(); ++node) {
        const bool of_cloth = world.is_cloth(node), few = random() % 8 == 0;
        if (of_cloth && motion % 3 == 0) end.row(node) += common.transpose();
        if (!of_cloth) end.row(node) += of_body.transpose();
        if (few && (of_cloth || motion % 7 == 0)) end.row(node) += any(2 * size).transpose();
      }
      const int before = search.tally().searches;
      const double asked = motion % 6 == 5 ? 2 * thickness : thickness;  // the guard asks for more than the response
      const bool all = update_pairs(search, asked, x0, end, path);
      const int searches = search.tally().searches - before;
      (all ? anew : searches > 0 ? mended : kept)++;
      PathPairs fresh;
      PairSearch other(world);
      update_pairs(other, asked, x0, end, fresh);
      const auto near = coming_near(fresh, x0, end, asked, 3);
      met += static_cast<int>(near.size());
      missing += coming_near(path, x0, end, asked, 3) != near;
    }
  }
  CHECK(missing == 0);
  CHECK(met > 10000);
  CHECK(kept > 50);
  CHECK(mended > 100);
  CHECK(anew > 100);
}

}  // namespace selvedge::test_path_pairs
