#include <catch2/catch.hpp>

#include <random>

#include "collision/untangle/facing.hpp"

namespace selvedge::test_facing {

namespace {

struct Cloud {
  Points rest, x, normals;
  std::vector<double> thickness;
};

// Points in clusters, of which each looks one way and goes its own way from rest to pose.
Cloud cloud(int clusters, int in_each, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double size) { return Vec3(size * unit(random), size * unit(random), size * unit(random)); };
  const int count = clusters * in_each;
  Cloud made{Points(count, 3), Points(count, 3), Points(count, 3), {}};
  for (int c = 0; c < clusters; ++c) {
    const Vec3 at = vector(0.2), way = vector(0.2), normal = vector(1);
    for (int i = c * in_each; i < (c + 1) * in_each; ++i) {
      const Vec3 rest = at + vector(0.04);
      made.rest.row(i) = rest.transpose();
      made.x.row(i) = (rest + way).transpose();
      made.normals.row(i) = (normal + vector(0.3)).normalized().transpose();
      made.thickness.push_back(0.03 + 0.03 * unit(random));
    }
  }
  return made;
}

// The same, all pairs looked at.
std::vector<int> by_all_pairs(const Cloud& body, double reach) {
  std::vector<int> found;
  for (int v = 0; v < body.x.rows(); ++v) {
    double nearest = reach * reach;
    found.push_back(-1);
    for (int w = 0; w < body.x.rows(); ++w) {
      const Vec3 way = row(body.x, v) - row(body.x, w);
      const double square = way.squaredNorm(), thin = 0.7 * std::min(body.thickness[v], body.thickness[w]);
      const bool faces = body.normals.row(v).dot(body.normals.row(w)) <= -0.3;
      const bool behind = square >= thin * thin && way.dot(row(body.normals, w)) < 0;
      const bool was_farther = square < 0.25 * (body.rest.row(v) - body.rest.row(w)).squaredNorm();
      if (!faces || behind || !was_farther || square >= nearest) continue;
      nearest = square;
      found.back() = w;
    }
  }
  return found;
}

}  // namespace

TEST_CASE("Facing: cubes that are left out hold no vertex that faces", "[give_way]") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Cloud body = cloud(40, 20, seed);
    constexpr double reach = 0.1;
    const std::vector<int> found = facing_vertices({body.rest, body.thickness, reach}, body.x, body.normals).partner;
    CHECK(found == by_all_pairs(body, reach));
    CHECK(std::ranges::count(found, -1) < 700);
    CHECK(std::ranges::count(found, -1) > 50);
  }
}

TEST_CASE("Facing: a pose before in which other vertices had moved changes nothing", "[give_way]") {
  constexpr double reach = 0.1;
  std::mt19937 random(4);
  Cloud body = cloud(40, 20, 5);
  Facing before = facing_vertices({body.rest, body.thickness, reach}, body.x, body.normals);
  int others = 0;
  for (int pose = 0; pose < 10; ++pose) {
    for (int i = 0; i < 20; ++i) {
      const auto v = static_cast<int>(random() % body.x.rows()), w = static_cast<int>(random() % body.x.rows());
      body.x.row(v) = 0.5 * (body.x.row(v) + body.x.row(w)).eval();
      if (i % 4 == 0) body.x.row(w) = body.x.row(v);  // two at one distance from all others
      body.normals.row(w) *= -1;
    }
    const FacingBody rest{body.rest, body.thickness, reach};
    Facing now = facing_vertices(rest, body.x, body.normals, &before);
    CHECK(now.partner == facing_vertices(rest, body.x, body.normals).partner);
    for (std::size_t v = 0; v < now.partner.size(); ++v) others += now.partner[v] != before.partner[v];
    before = std::move(now);
  }
  CHECK(others > 100);
}

TEST_CASE("Facing: what was as near at rest does not meet", "[give_way]") {
  Points x(2, 3), normals(2, 3), rest(2, 3);
  x << 0, 0, 0, 0, 0.03, 0;
  normals << 0, 1, 0, 0, -1, 0;
  const std::vector<double> thickness{0.1, 0.1};
  rest << 0, 0, 0, 0, 0.059, 0;
  CHECK(facing_vertices({rest, thickness, 0.1}, x, normals).partner == std::vector<int>{-1, -1});
  rest(1, 1) = 0.061;
  CHECK(facing_vertices({rest, thickness, 0.1}, x, normals).partner == std::vector<int>{1, 0});
}

}  // namespace selvedge::test_facing
