#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

#include "collision/audit/audit.hpp"
#include "collision/audit/audit_memory.hpp"
#include "collision/audit/audit_motion.hpp"
#include "collision/audit/audit_pair.hpp"
#include "collision/audit/box_pairs.hpp"
#include "collision/audit/moving_pair.hpp"
#include "collision/exact/orientation.hpp"
#include "tests/collision/sheets.hpp"

// Frames of a body and two layers that move fast with it, in each of which something is planted. What the audits find,
// with a memory as a run has it, is compared with what is found pair by pair, without searches and without shortcuts.

namespace selvedge::test_planted {

namespace {

struct World {
  testing::Sheet sheets = testing::join(testing::sheet(6, 0.24, 0.006), testing::sheet(7, 0.28, 0.003));
  Surface cloth = make_surface(static_cast<int>(sheets.x.rows()), sheets.triangles), body;
  Points box{8, 3};

  World() {
    for (int v = 0; v < 8; ++v) box.row(v) << (v & 1 ? 0.2 : -0.2), (v & 2 ? 0.0 : -0.2), (v & 4 ? 0.2 : -0.2);
    Triangles faces(12, 3);
    faces << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5;
    body = make_surface(8, faces);
  }
};

Points rounded(const Points& x) { return x.cast<float>().cast<double>(); }

bool share_vertex(const Surface& s, int a, int b) {
  for (const int v : s.triangles.row(a))
    if ((s.triangles.row(b).array() == v).any()) return true;
  return false;
}

// Vertex-face and edge-edge pairs without a common vertex whose boxes overlap and that are not proven apart.
std::vector<PassedPair> passed_by_all_pairs(const World& world, const std::array<Points, 2>& x,
                                            const std::array<Points, 2>& y) {
  const int first = world.cloth.vertex_count;
  Points from(first + 8, 3), to(first + 8, 3);
  from << x[0], y[0];
  to << x[1], y[1];
  const auto box_of_nodes = [&](std::span<const int> nodes) {
    ExactBox box{{endless, endless, endless}, {-endless, -endless, -endless}};
    for (const int node : nodes)
      for (int k = 0; k < 3; ++k) {
        box.lo[k] = std::min({box.lo[k], from(node, k), to(node, k)});
        box.hi[k] = std::max({box.hi[k], from(node, k), to(node, k)});
      }
    return box;
  };
  struct Feature {
    std::vector<int> nodes;
    ExactBox box;
  };
  std::vector<Feature> vertices, edges, faces;
  const auto add = [&](std::vector<Feature>& list, std::vector<int> nodes) {
    const ExactBox box = box_of_nodes(nodes);
    list.push_back({std::move(nodes), box});
  };
  for (const auto& [surface, offset] : {std::pair(&world.cloth, 0), std::pair(&world.body, first)}) {
    for (int v = 0; v < surface->vertex_count; ++v) add(vertices, {offset + v});
    for (const auto& e : surface->edges.rowwise()) add(edges, {offset + e[0], offset + e[1]});
    for (const auto& t : surface->triangles.rowwise()) add(faces, {offset + t[0], offset + t[1], offset + t[2]});
  }
  std::vector<PassedPair> passed;
  const auto look_at = [&](const Feature& a, const Feature& b, bool are_edges) {
    if (!overlap(a.box, b.box) || (a.nodes[0] >= first && b.nodes[0] >= first)) return;
    std::array<int, 4> nodes{};
    std::ranges::copy(a.nodes, nodes.begin());
    std::ranges::copy(b.nodes, nodes.begin() + std::ssize(a.nodes));
    for (const int node : a.nodes)
      if (std::ranges::count(b.nodes, node) > 0) return;
    MovingPoints<4> points;
    for (int i = 0; i < 4; ++i) {
      points.start[i] = row(from, nodes[i]) - row(from, nodes[0]);
      points.end[i] = row(to, nodes[i]) - row(to, nodes[0]);
    }
    const Proof proof = are_edges ? proof_for_edges(points, 30, 4096) : proof_for_vertex_and_face(points, 30, 4096);
    if (proof != Proof::apart) passed.push_back({are_edges, nodes});
  };
  for (const Feature& v : vertices)
    for (const Feature& f : faces) look_at(v, f, false);
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size(); ++j) look_at(edges[i], edges[j], true);
  return passed;
}

// Without regard to which edge stands first, and which of its ends.
std::vector<PassedPair> in_one_form(std::vector<PassedPair> pairs) {
  for (PassedPair& pair : pairs) {
    auto& n = pair.nodes;
    std::sort(n.begin() + (pair.edges ? 0 : 1), n.begin() + (pair.edges ? 2 : 4));
    if (!pair.edges) continue;
    std::sort(n.begin() + 2, n.end());
    if (n[2] < n[0]) n = {n[2], n[3], n[0], n[1]};
  }
  std::ranges::sort(pairs);
  return pairs;
}

Audit state_by_all_pairs(const World& world, const Points& x, const Points& y) {
  Audit found;
  const Surface& s = world.cloth;
  const auto corner = [](const Surface& of, const Points& at, int t, int k) { return row(at, of.triangles(t, k % 3)); };
  for (int a = 0; a < s.triangles.rows(); ++a) {
    for (int b = a + 1; b < s.triangles.rows(); ++b) {
      if (!overlap(box_of(s, x, a), box_of(s, x, b))) continue;
      const auto at = [&](int t, int k) { return corner(s, x, t, k); };
      if (!share_vertex(s, a, b)) {
        if (triangles_intersect(at(a, 0), at(a, 1), at(a, 2), at(b, 0), at(b, 1), at(b, 2)))
          found.self_pairs.emplace_back(a, b);
        continue;
      }
      int shared = 0, i_shared = 0, j_shared = 0;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          if (s.triangles(a, i) == s.triangles(b, j)) {
            ++shared;
            i_shared = i;
            j_shared = j;
          }
      if (shared == 1 && triangles_cross_at_vertex(at(a, i_shared), at(a, i_shared + 1), at(a, i_shared + 2),
                                                   at(b, j_shared + 1), at(b, j_shared + 2)))
        found.vertex_pairs.emplace_back(a, b);
    }
    for (int c = 0; c < world.body.triangles.rows(); ++c) {
      const auto at = [&](int k) { return corner(s, x, a, k); };
      const auto of_body = [&](int k) { return corner(world.body, y, c, k); };
      if (triangles_intersect(at(0), at(1), at(2), of_body(0), of_body(1), of_body(2)))
        found.obstacle_pairs.emplace_back(a, c);
    }
  }
  // The box is convex.
  for (int v = 0; v < s.vertex_count; ++v) {
    bool inside = true;
    for (int c = 0; c < world.body.triangles.rows() && inside; ++c)
      inside = orient3d(corner(world.body, y, c, 0), corner(world.body, y, c, 1), corner(world.body, y, c, 2),
                        row(x, v)) < 0;
    found.inside_vertices += inside;
  }
  return found;
}

// What is planted at the end of a frame, in the frame of the body: a vertex goes through the layer below or above it,
// or over its neighbours, or into the body, or many shake; or nothing.
void plant(int kind, std::mt19937& random, Points& x) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto v = static_cast<Eigen::Index>(random() % static_cast<unsigned>(x.rows()));
  if (kind == 1) x(v, 1) += x(v, 1) > 0.0045 ? -0.005 : 0.005;
  if (kind == 2) {
    x.row(v) += 2.5 * (x.row((v + 1) % x.rows()) - x.row(v)).eval();
    x(v, 1) += 2e-3 * unit(random);
  }
  if (kind == 3) x(v, 1) -= 0.03;
  if (kind == 4)
    for (double& c : x.reshaped()) c += 2e-3 * unit(random);
}

}  // namespace

TEST_CASE("planted: in 1,000 frames the audits find what is found pair by pair", "[audit_memory]") {
  const World world;
  std::mt19937 random(17);
  std::uniform_real_distribution<double> unit(-1, 1);
  AuditMemory memory;
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  Points x = world.sheets.x, y = world.box;
  std::array<int, 5> with_pairs{}, with_inside{}, with_passages{}, with_folds{}, frames{};
  for (int frame = 0; frame < 1000; ++frame) {
    const int kind = frame % 2 == 0 ? 0 : static_cast<int>(random() % 5);
    const Points x0 = x, y0 = y;
    x = world.sheets.x;
    for (int v = 0; v < x.rows(); ++v) x(v, 1) += 5e-4 * std::sin(30 * x(v, 0) + 0.7 * frame);
    plant(kind, random, x);
    place = place * Eigen::AngleAxisd(0.1 * unit(random), Vec3(unit(random), unit(random), unit(random)).normalized());
    place.pretranslate(0.05 * Vec3(unit(random), unit(random), unit(random)));
    for (Points* points : {&x, &y}) {
      if (points == &y) y = world.box;
      *points = ((*points * place.linear().transpose()).rowwise() + place.translation().transpose()).eval();
    }
    const std::vector<MovingBody> moving{{&world.body, &y0, &y}};
    const MotionAudit motion = audit_motion(world.cloth, x0, x, moving, true, &memory);
    const auto passed = passed_by_all_pairs(world, {x0, x}, {y0, y});
    CHECK(in_one_form(motion.passed) == in_one_form(passed));
    CHECK(motion.given_up == 0);
    const Points x_stored = rounded(x), y_stored = rounded(y);
    const std::vector<AuditBody> still{{&world.body, &y_stored}};
    const Audit state = audit(world.cloth, x_stored, still, true, &memory);
    const Audit plain = state_by_all_pairs(world, x_stored, y_stored);
    CHECK(state.self_pairs == plain.self_pairs);
    CHECK(state.vertex_pairs == plain.vertex_pairs);
    CHECK(state.obstacle_pairs == plain.obstacle_pairs);
    CHECK(state.inside_vertices == plain.inside_vertices);
    ++frames[kind];
    with_pairs[kind] += plain.intersecting_pairs() > 0;
    with_folds[kind] += !plain.vertex_pairs.empty();
    with_inside[kind] += plain.inside_vertices > 0;
    with_passages[kind] += !passed.empty();
  }
  CAPTURE(with_pairs, with_folds, with_inside, with_passages, frames);
  // Each kind has been there, and has made what it was planted for.
  for (const int count : frames) CHECK(count > 60);
  CHECK(with_pairs[0] == 0);
  CHECK(with_pairs[1] > 60);
  CHECK(with_folds[2] > 10);
  CHECK(with_inside[3] > 60);
  CHECK(with_pairs[4] > 20);
  CHECK(with_passages[1] > 60);
}

}  // namespace selvedge::test_planted
