#include "pipeline/reports/report_fields.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>

#include "pipeline/reports/field_total.hpp"

namespace selvedge::test_report_fields {

namespace {

// Each member of a struct, in turn. A member that is new here does not compile: it is added, and the tests below then
// ask for its row in pipeline/reports/report_fields.cpp.
template <class F>
void each_member(PhaseTimes& all, const F& f) {
  auto& [a, b, c, d, e, g, h, i, j] = all;
  for (double* one : {&a, &b, &c, &d, &e, &g, &h, &i, &j}) f(*one);
}
template <class F>
void each_member(Doubts& all, const F& f) {
  auto& [not_converged, penetrating, energy_gain] = all;
  for (bool* one : {&not_converged, &penetrating, &energy_gain}) f(*one);
}
template <class F>
void each_member(StepCounts& all, const F& f) {
  auto& [solves, coarse_builds, searches, candidates, audits, swept, projected] = all;
  for (int* one : {&solves, &coarse_builds, &searches, &audits}) f(*one);
  for (std::int64_t* one : {&candidates, &swept, &projected}) f(*one);
}
template <class F>
void each_member(CollisionReport& all, const F& f) {
  auto& [contacts, impulses, zones, halved, shortened, held, passed, left_alone, cut_out, pushed_out, jumped, gap, lag,
         before, after, wanted, depth] = all;
  for (int* one : {&contacts, &impulses, &zones, &halved, &shortened, &held, &passed, &left_alone, &cut_out,
                   &pushed_out, &jumped, &before, &after, &wanted})
    f(*one);
  for (double* one : {&gap, &lag, &depth}) f(*one);
}
template <class F>
void each_member(StepReport& all, const F& f) {
  auto& [status, reason, doubts, by, fell_back, verdict, substeps, resting, iterations, untangling, out_of_newton,
         out_of_untangling, out_of_response, out_of_proofs, linear_iterations, residual, unsolved, seconds, counts,
         collision, switched_off, audit, path, contact_forces] = all;
  static_cast<void>(path);            // until its audit: of no frame that is reported
  static_cast<void>(contact_forces);  // arrays of the trajectory, where they are asked for
  f(status), f(reason), f(by), f(verdict), f(switched_off), f(audit);
  for (bool* one : {&fell_back, &out_of_newton, &out_of_untangling, &out_of_response, &out_of_proofs}) f(*one);
  for (int* one : {&substeps, &resting, &iterations, &untangling, &linear_iterations}) f(*one);
  for (double* one : {&residual, &unsolved}) f(*one);
  each_member(doubts, f), each_member(seconds, f), each_member(counts, f), each_member(collision, f);
}

void change(int& value) { value = 7; }
void change(std::int64_t& value) { value = 3'000'000'000; }
void change(double& value) { value = 0.3; }
void change(bool& value) { value = true; }
void change(std::string& value) { value = "other"; }
void change(std::vector<int>& value) { value = {0, 3}; }
void change(std::optional<Audit>& value) { value.emplace(); }
template <class Enum>
requires std::is_enum_v<Enum>
void change(Enum& value) { value = static_cast<Enum>(2); }

// One copy of a new struct for each member, with that member changed.
template <class Struct>
std::vector<Struct> with_one_change() {
  std::vector<Struct> all;
  Struct probe;
  int members = 0;
  each_member(probe, [&](auto&) { ++members; });
  for (int k = 0; k < members; ++k) {
    int at = 0;
    each_member(all.emplace_back(), [&](auto& member) {
      if (at++ == k) change(member);
    });
  }
  return all;
}

template <class Struct>
void check_rows(const BoundFields<Struct>& fields) {
  const Struct plain;
  int seen = 0;
  for (const Struct& changed : with_one_change<Struct>()) {
    INFO("member " << seen++ << " of those that each_member lists");
    CHECK(std::ranges::count_if(fields, [&](const auto& one) { return one.get(changed) != one.get(plain); }) == 1);
  }
  CHECK(seen == std::ssize(fields));
}

}  // namespace

TEST_CASE("reports: each member of a report and of its parts has one row of the table", "[reports]") {
  check_rows(phase_fields());
  check_rows(doubt_fields());
  check_rows(count_fields());
  check_rows(collision_fields());
  check_rows(report_fields());
}

TEST_CASE("reports: what a row gives can be set, and rows have names and sentences of their own", "[reports]") {
  std::vector<std::string> names, keys;
  for (const BoundField<StepReport>& one : report_fields()) {
    INFO(one.name);
    CHECK(!one.about.empty());
    names.push_back(one.name);
    for (const InSummary& in : one.in_summary)
      if (in.over != Over::milliseconds && in.over != Over::milliseconds_where_there) keys.push_back(in.key);
    CHECK(bool(one.set) == (one.type != ColumnType::none));
    for (const StepReport& changed : with_one_change<StepReport>()) {
      StepReport made;
      if (one.set) one.set(one.get(changed), made);
      if (one.set) CHECK(one.get(made) == one.get(changed));
    }
  }
  for (std::vector<std::string>* all : {&names, &keys}) {
    std::ranges::sort(*all);
    CHECK(std::ranges::adjacent_find(*all) == all->end());
  }
}

TEST_CASE("reports: seconds and counts add up member by member", "[reports]") {
  for (PhaseTimes one : with_one_change<PhaseTimes>()) {
    const PhaseTimes before = one;
    one += before;
    for (const auto& row : phase_fields()) CHECK(number_of(row.get(one), {}) == 2 * number_of(row.get(before), {}));
    CHECK(before.total() == 0.3);
  }
  for (StepCounts one : with_one_change<StepCounts>()) {
    const StepCounts before = one;
    one += before;
    for (const auto& row : count_fields()) CHECK(number_of(row.get(one), {}) == 2 * number_of(row.get(before), {}));
  }
}

TEST_CASE("reports: any doubt is one", "[reports]") {
  CHECK_FALSE(Doubts{}.any());
  for (const Doubts& one : with_one_change<Doubts>()) CHECK(one.any());
}

TEST_CASE("reports: a field over all frames", "[reports]") {
  FieldTotals totals = no_totals();
  for (int frame = 0; frame < 5; ++frame) {
    StepReport report;
    report.untangling = frame % 3;
    report.collision.cut_out = 4 - frame;
    report.collision.min_gap = frame == 2 ? 0.5 : std::numeric_limits<double>::infinity();
    report.out_of_newton = frame > 2;
    report.verdict = frame == 1 ? Verdict::tangled : frame > 2 ? Verdict::admitted : Verdict::none;
    add_report(totals, frame, report);
  }
  const FieldTotal& untangling = total_of(totals, "untangling");
  CHECK(untangling.sum == 4);
  CHECK(untangling.largest == 2);
  CHECK(untangling.frames == 3);
  CHECK(untangling.first_frame == 1);
  CHECK(untangling.last_frame == 4);
  CHECK(total_of(totals, "cut_out").at_start == 4);
  CHECK(total_of(totals, "cut_out").at_end == 0);
  CHECK(total_of(totals, "cut_out").last_frame == 3);
  CHECK(total_of(totals, "contact_gap").smallest == 0.5);
  CHECK(total_of(totals, "out_of_newton").frames == 2);
  CHECK(total_of(totals, "jumped").first_frame == -1);
  const std::vector<int>& verdicts = total_of(totals, "verdict").by_word;
  CHECK(verdicts[static_cast<std::size_t>(Verdict::tangled)] == 1);
  CHECK(verdicts[static_cast<std::size_t>(Verdict::admitted)] == 2);
  CHECK_THROWS(total_of(totals, "untangled"));
}

}  // namespace selvedge::test_report_fields
