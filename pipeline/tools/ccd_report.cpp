#include "pipeline/tools/ccd_report.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "collision/contact/ccd.hpp"
#include "collision/exact/orientation.hpp"
#include "collision/geometry/floating_point.hpp"
#include "pipeline/host/label_lines.hpp"
#include "pipeline/host/numbers_json.hpp"

namespace selvedge {
namespace {

constexpr int runs = 3;
constexpr std::size_t most_named = 20;

struct Answer {
  bool contact = false;
  double us = 0;
};

Answer answer(const CcdQuery& query) {
  Answer result;
  for (int run = 0; run < runs; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    result.contact = time_of_contact(query.kind, query.x0, query.x1, 0).has_value();
    const std::chrono::duration<double, std::micro> taken = std::chrono::steady_clock::now() - begin;
    result.us = run == 0 ? taken.count() : std::min(result.us, taken.count());
  }
  return result;
}

void add(CcdCount& count, const CcdQuery& query, bool contact) {
  ++count.queries;
  count.positives += query.contact;
  count.false_negatives += query.contact && !contact;
  count.false_positives += contact && !query.contact;
}

double percent(int part, int whole) { return whole > 0 ? 100.0 * part / whole : 0; }

std::string count_text(const CcdCount& c) {
  return fmt::format("{} queries, {} positives: {} false negatives, {} false positives ({:.2f} % of the negatives)",
                     c.queries, c.positives, c.false_negatives, c.false_positives,
                     percent(c.false_positives, c.negatives()));
}

}  // namespace

bool is_degenerate(const CcdQuery& q) {
  return orient3d(q.x0[0], q.x0[1], q.x0[2], q.x0[3]) == 0 || orient3d(q.x1[0], q.x1[1], q.x1[2], q.x1[3]) == 0 ||
         q.x0 == q.x1;
}

CcdReport ccd_report(const std::vector<std::filesystem::path>& files) {
  restore_standard_arithmetic();
  CcdReport report;
  std::vector<std::string> denied, asserted;
  double sum = 0;
  for (const std::filesystem::path& file : files) {
    ++report.files;
    for (const CcdQuery& query : read_ccd_queries(file)) {
      const Answer found = answer(query);
      const std::string name = fmt::format("{}:{}", file.string(), query.line);
      add(report.all, query, found.contact);
      if (is_degenerate(query)) add(report.degenerate, query, found.contact);
      if (found.contact != query.contact) (query.contact ? denied : asserted).push_back(name);
      sum += found.us;
      if (found.us <= report.max_us) continue;
      report.max_us = found.us;
      report.slowest = name;
    }
  }
  if (report.all.queries > 0) report.mean_us = sum / report.all.queries;
  report.wrong = std::move(denied);
  report.wrong.insert(report.wrong.end(), asserted.begin(), asserted.end());
  if (report.wrong.size() > most_named) report.wrong.resize(most_named);
  return report;
}

std::string ccd_json(const CcdReport& r) {
  return json_text({{"files", r.files},
                    {"queries", r.all.queries},
                    {"positives", r.all.positives},
                    {"false_negatives", r.all.false_negatives},
                    {"false_positives", r.all.false_positives},
                    {"degenerate", r.degenerate.queries},
                    {"degenerate_positives", r.degenerate.positives},
                    {"degenerate_false_negatives", r.degenerate.false_negatives},
                    {"degenerate_false_positives", r.degenerate.false_positives},
                    {"mean_us", r.mean_us},
                    {"max_us", r.max_us},
                    {"slowest", r.slowest},
                    {"wrong", r.wrong}});
}

std::string ccd_text(const CcdReport& r) {
  LabelLines add{22};
  add("all", count_text(r.all));
  add("degenerate", count_text(r.degenerate));
  add("time", fmt::format("{:.2f} us a query, {:.1f} us at worst ({})", r.mean_us, r.max_us, r.slowest));
  for (const std::string& name : r.wrong) add("wrong", name);
  return add.text;
}

}  // namespace selvedge
