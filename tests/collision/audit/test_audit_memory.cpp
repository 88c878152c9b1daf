#include <catch2/catch.hpp>

#include <random>

#include "collision/audit/audit.hpp"
#include "collision/audit/audit_memory.hpp"
#include "collision/audit/audit_motion.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_audit_memory {

using testing::join;
using testing::sheet;

namespace {

// A small sheet on a large one, and a box below that moves on its own.
struct AtRest {
  testing::Sheet cloths = join(sheet(6, 0.2, 0.01), sheet(8, 0.3, 0.0));
  Surface cloth = make_surface(static_cast<int>(cloths.x.rows()), cloths.triangles);
  Points x = cloths.x;
  Surface body;
  Points y;

  AtRest() {
    y.resize(8, 3);
    for (int v = 0; v < 8; ++v) y.row(v) << (v & 1 ? 0.1 : -0.1), (v & 2 ? -0.01 : -0.2), (v & 4 ? 0.1 : -0.1);
    Triangles faces(12, 3);
    faces << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5;
    body = make_surface(8, faces);
  }
  Audit state(AuditMemory* memory) const {
    const std::vector<AuditBody> bodies{{&body, &y}};
    return audit(cloth, x, bodies, true, memory);
  }
};

void same(const Audit& a, const Audit& b) {
  CHECK(a.self_pairs == b.self_pairs);
  CHECK(a.vertex_pairs == b.vertex_pairs);
  CHECK(a.obstacle_pairs == b.obstacle_pairs);
  CHECK(a.inside_vertices == b.inside_vertices);
  CHECK(a.nonfinite == b.nonfinite);
}

}  // namespace

TEST_CASE("audit memory: nothing is asked again of what rests", "[audit_memory]") {
  AtRest rest;
  AuditMemory memory;
  const MovingBody cloth{&rest.cloth, &rest.x, &rest.x};
  const std::vector<MovingBody> bodies{{&rest.body, &rest.y, &rest.y}};
  CHECK(open_questions(memory, cloth, bodies, true).all);  // it has not seen it move slowly yet
  for (int k = 0; k < 3; ++k) {
    const AuditQuestions questions = open_questions(memory, cloth, bodies, true);
    CHECK_FALSE(questions.all);
    CHECK(questions.self_pairs.empty());
    CHECK(questions.body_pairs.empty());
  }
  Points away = rest.x;
  away.col(1).array() += 0.05;
  CHECK(open_questions(memory, {&rest.cloth, &rest.x, &away}, bodies, true).all);
}

TEST_CASE("audit memory: an audit with it finds what one without it finds", "[audit_memory]") {
  AtRest rest;
  AuditMemory memory;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  int pairs = 0, passed = 0, inside = 0, remembered = 0;
  for (int step = 0; step < 400; ++step) {
    const Points x0 = rest.x, y0 = rest.y;
    // Slow creep of the small sheet into the large one and of both into the box; now and then a jump, or noise.
    const double size = step % 50 == 49 ? 3e-3 : step % 10 == 9 ? 3e-4 : 1e-6;
    for (int v = 0; v < rest.x.rows(); ++v) {
      rest.x(v, 1) -= (v < 49 ? 6e-5 : 2e-5) * (1 + std::sin(40 * rest.x(v, 0)));
      for (int k = 0; k < 3; ++k) rest.x(v, k) += size * normal(random);
    }
    rest.y.col(1).array() += 1e-5;
    const Audit plain = rest.state(nullptr);
    const std::vector<MovingBody> bodies{{&rest.body, &y0, &rest.y}};
    const MotionAudit with = audit_motion(rest.cloth, x0, rest.x, bodies, true, &memory);
    const MotionAudit without = audit_motion(rest.cloth, x0, rest.x, bodies, true);
    CHECK(with.passed == without.passed);
    remembered += !memory.reference.empty();
    same(rest.state(&memory), plain);
    pairs += plain.intersecting_pairs();
    inside += plain.inside_vertices;
    passed += without.passed_through();
  }
  CHECK(remembered > 200);
  CHECK(pairs > 1000);
  CHECK(inside > 100);
  CHECK(passed > 100);
}

TEST_CASE("audit memory: cloth that lies in one point, and stays, is not forgotten", "[audit_memory]") {
  AtRest rest;
  AuditMemory memory;
  rest.x.setConstant(0.05);
  const Audit plain = rest.state(nullptr);
  CHECK(plain.intersecting_pairs() > 100);
  for (int frame = 0; frame < 3; ++frame) same(rest.state(&memory), plain);
}

TEST_CASE("audit memory: a state at the end of a fast motion is not remembered, one after a slow motion is",
          "[audit_memory]") {
  AtRest rest;
  const auto remembers = [&](double way) {
    AuditMemory memory;
    const std::vector<MovingBody> bodies{{&rest.body, &rest.y, &rest.y}};
    for (int step = 0; step < 3; ++step) {
      const Points x0 = rest.x;
      rest.x.col(0).array() += way;
      audit_motion(rest.cloth, x0, rest.x, bodies, true, &memory);
      same(rest.state(&memory), rest.state(nullptr));
    }
    return !memory.reference.empty();
  };
  CHECK_FALSE(remembers(0.01));
  CHECK(remembers(1e-5));
}

TEST_CASE("audit memory: what sinks into a body is seen inside it", "[audit_memory]") {
  AtRest rest;
  AuditMemory memory;
  int inside = 0;
  for (int step = 0; step < 60; ++step) {
    rest.x.col(1).array() -= 2.5e-4;
    const Audit plain = rest.state(nullptr);
    same(rest.state(&memory), plain);
    inside += plain.inside_vertices;
  }
  CHECK(inside > 0);
}

TEST_CASE("audit memory: undefined coordinates are not remembered", "[audit_memory]") {
  AtRest rest;
  AuditMemory memory;
  rest.state(&memory);
  rest.state(&memory);
  const double good = rest.x(3, 1);
  for (int k = 0; k < 3; ++k) {
    rest.x(3, 1) = std::numeric_limits<double>::quiet_NaN();
    same(rest.state(&memory), rest.state(nullptr));
    CHECK(rest.state(&memory).nonfinite == 1);
    rest.x(3, 1) = good;
    same(rest.state(&memory), rest.state(nullptr));
  }
}

}  // namespace selvedge::test_audit_memory
