#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/teach/teach_carried.hpp"

namespace selvedge {
namespace {

constexpr double mm = 1e3;  // [mm/m]

std::string rolls_text(const std::string& name, const RollDistances& rolls) {
  return fmt::format("{:<16}{:>10.2f}{:>10.2f}{:>8}{:>8}{:>8}{:>9}\n", name, mm * rolls.distance_after_one(),
                     mm * rolls.distance_after_ten(), rolls.frames, rolls.pairs, rolls.passed, rolls.refused);
}

std::string rolls_title(const std::string& first) {
  return fmt::format("{:<16}{:>10}{:>10}{:>8}{:>8}{:>8}{:>9}\n", first, "1, mm", "10, mm", "frames", "pairs", "passed",
                     "refused");
}

Json rolls_object(const RollDistances& rolls) {
  return {{"after_1_mm", mm * rolls.distance_after_one()},
          {"after_10_mm", mm * rolls.distance_after_ten()},
          {"frames", rolls.frames},
          {"pairs", rolls.pairs},
          {"passed_through", rolls.passed},
          {"refused", rolls.refused}};
}

std::string coefficients_text(const TaughtCarried& taught) {
  std::string text = fmt::format("{:<16}{:>10}{:>10}\n", "coefficient of", "carried", "fitted");
  for (int k = 0; k < carried_term_count; ++k)
    text += fmt::format("{:<16}{:>10.3f}{:>10.3f}\n", carried_term_names()[static_cast<std::size_t>(k)],
                        default_carried_set()[k], taught.model.scene[k]);
  if (taught.model.own.rows() > 0)
    text += fmt::format("each of {} has its own set beside this one\n", counted(taught.vertices, "vertex", "vertices"));
  return text;
}

}  // namespace

std::string teach_text(const TeachReport& report) {
  if (report.rounds.empty()) return {};
  std::string text = "one frame, mm    carried    fitted  frames\n";
  for (std::size_t r = 0; r < report.rounds.size(); ++r) {
    const TeachRound& round = report.rounds[r];
    text += fmt::format("{:<14}{:>10.2f}{:>10.2f}{:>8}\n", fmt::format("round {}", r), mm * round.before,
                        mm * round.after, round.frames);
  }
  text += "\nroll-outs on the clips that were fitted on\n" + rolls_title("distance after");
  for (std::size_t r = 0; r < report.rounds.size(); ++r) {
    const std::string chosen = static_cast<int>(r) == report.chosen ? ", kept" : "";
    text += rolls_text(fmt::format("round {}{}", r, chosen), report.rounds[r].rolls);
  }
  if (!report.rows.empty()) text += "\nroll-outs on the clips that were held out\n" + rolls_title("distance after");
  for (const TeachRow& row : report.rows) text += rolls_text(row.stepper, row.rolls);
  return text + "\n" + coefficients_text(report.taught);
}

std::string teach_json(const TeachReport& report) {
  Json json{{"finished", report.finished}, {"clips", report.taught.clips}, {"kept_round", report.chosen}};
  Json coefficients = Json::object();
  for (int k = 0; k < carried_term_count; ++k)
    coefficients[carried_term_names()[static_cast<std::size_t>(k)]] = report.taught.model.scene[k];
  json["coefficients"] = coefficients;
  json["own_sets"] = report.taught.model.own.rows();
  json["rounds"] = json_list(report.rounds, [](const TeachRound& round) {
    Json one{{"frames", round.frames}, {"carried_mm", mm * round.before}, {"fitted_mm", mm * round.after}};
    one["rolls"] = rolls_object(round.rolls);
    return one;
  });
  json["held_out"] = json_list(report.rows, [](const TeachRow& row) {
    Json one = rolls_object(row.rolls);
    one["stepper"] = row.stepper;
    return one;
  });
  return json_text(json);
}

}  // namespace selvedge
