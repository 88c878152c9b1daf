#include <catch2/catch.hpp>

#include "collision/audit/audit_memory.hpp"
#include "collision/audit/audit_motion.hpp"
#include "collision/audit/moving_pair.hpp"
#include "collision/audit/proof_budget.hpp"
#include "tests/collision/sheets.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_proof_budget {

using testing::Sheet;

namespace {

// Triangles with corners of their own: `copies` at each of `places`, a little farther from each other than the gap.
Sheet soup(int places, int copies, double gap) {
  Sheet s{Points(3 * places * copies, 3), Triangles(places * copies, 3)};
  for (int t = 0; t < places * copies; ++t) {
    const Vec3 at(3.0 * (t / copies), gap * (t % copies), 0);
    for (int k = 0; k < 3; ++k) {
      s.x.row(3 * t + k) = (at + Vec3(k == 1, 0, k == 2)).transpose();
      s.triangles(t, k) = 3 * t + k;
    }
  }
  return s;
}

// Each place turns by a right angle on its own, along straight lines: what is near another stays so.
Points turned(const Points& x) {
  Points end = x;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const double place = 3 * std::floor((x(v, 0) + 0.5) / 3);
    end.row(v) << place - x(v, 1), x(v, 0) - place, x(v, 2);
  }
  return end;
}

MotionAudit audited(const Sheet& s, const Points& end, int threads, AuditMemory* memory) {
  MotionAudit result;
  const Surface surface = s.surface();
  with_threads(threads, [&] { result = audit_motion(surface, s.x, end, {}, true, memory); });
  return result;
}

void same(const MotionAudit& a, const MotionAudit& b) {
  CHECK(a.passed == b.passed);
  CHECK(a.given_up == b.given_up);
  CHECK(a.whole == b.whole);
}

}  // namespace

TEST_CASE("a pair is cut into no more parts than it may be, whichever part is the last", "[proof_budget]") {
  MovingPoints<4> p;
  p.start = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 5e-3, 0), Vec3(1, 5e-3, 0)};
  p.end = {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(-5e-3, 0, 0), Vec3(-5e-3, 1, 0)};
  CHECK(proof_for_edges(p, 30, most_parts) == Proof::apart);
  for (int parts = 1; parts <= 128; ++parts) CHECK(proof_for_edges(p, 30, parts) == Proof::open);
  p.end[2] = Vec3(5e-3, 0, 0);
  CHECK(proof_for_edges(p, 30, most_parts) == Proof::meets);
  p.start[2] = p.start[0];
  CHECK(proof_for_edges(p, 30, 1) == Proof::meets);  // from the start
}

TEST_CASE("the audit of a motion ends early among very many pairs that touch, and says so", "[proof_budget]") {
  const Sheet s = soup(1, 150, 0);
  Points end = s.x;
  end.col(1).array() += 1e-7;
  const MotionAudit found = audited(s, end, 1, nullptr);
  CHECK_FALSE(found.whole);
  CHECK(found.passed.empty());
  CHECK(found.given_up == ProofBudget::most_unproven);
  CHECK(found.passed_through() == ProofBudget::most_unproven);
  same(audited(s, end, 2, nullptr), found);
  AuditMemory memory;
  for (int k = 0; k < 3; ++k) same(audited(s, end, 2, &memory), found);
  CHECK_FALSE(memory.reference.empty());
  // Of fewer each is found.
  const Sheet few = soup(1, 20, 0);
  end = few.x;
  end.col(1).array() += 1e-7;
  const MotionAudit all = audited(few, end, 1, nullptr);
  CHECK(all.whole);
  CHECK(all.given_up == 0);
  CHECK(all.passed.size() == 15 * 20 * 19 / 2);
}

TEST_CASE("pairs that are hard to prove share what there is for them, the same in any order", "[proof_budget]") {
  // Nearly every pair of a place needs some thousand parts.
  const Sheet some = soup(10, 2, 5e-4), many = soup(300, 2, 5e-4);
  const MotionAudit proven = audited(some, turned(some.x), 1, nullptr);
  CHECK(proven.passed_through() == 0);
  const MotionAudit given_up = audited(many, turned(many.x), 1, nullptr);
  CHECK(given_up.whole);
  CHECK(given_up.given_up > 1000);
  CHECK(given_up.passed.empty());
  AuditMemory memory;
  same(audited(many, turned(many.x), 2, &memory), given_up);
}

TEST_CASE("the audit of a motion asks nothing of pairs that are left out", "[proof_budget]") {
  const Sheet s = soup(1, 12, 0);
  Points end = s.x;
  end.col(1).array() += 1e-7;
  const Surface surface = s.surface();
  const auto early = [](const std::array<int, 4>& nodes) { return nodes[0] < 18; };
  const MotionAudit all = audit_motion(surface, s.x, end, {}),
                    rest = audit_motion(surface, s.x, end, {}, true, nullptr, early);
  std::vector<PassedPair> late = all.passed;
  std::erase_if(late, [&](const PassedPair& pair) { return early(pair.nodes); });
  CHECK(rest.passed == late);
  CHECK(late.size() < all.passed.size());
  CHECK(audit_motion(surface, s.x, end, {}, true, nullptr, [](const auto&) { return true; }).passed_through() == 0);
}

}  // namespace selvedge::test_proof_budget
