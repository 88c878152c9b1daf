#include "pipeline/scene/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "physics/steppers/one_rough_solve.hpp"

namespace selvedge {
namespace {

struct QualityValue {
  std::string key;  // dotted
  double number = 0;
  std::string word = {};  // in place of the number
};

struct QualityLevel {
  std::string name, about;
  std::vector<QualityValue> values;
};

// Measured in docs/benchmarks.md.
std::vector<QualityLevel> make_levels() {
  const ConventionalOptions rough = one_rough_solve({});
  std::vector<QualityValue> preview{
      {"run.substeps", static_cast<double>(*rough.substeps)},
      {"solver.max_newton", static_cast<double>(rough.implicit_euler.max_newton)},
      {"solver.relative_tolerance", rough.implicit_euler.relative_tolerance},
      {"solver.max_newton_step", static_cast<double>(rough.implicit_euler.max_newton_step)}};
  std::vector<QualityValue> draft = preview;
  draft.push_back({"solver.substep.max_passes", static_cast<double>(rough.substep.max_passes)});
  draft.push_back({"solver.guess", 0, "carried"});
  return {{"draft", "", std::move(draft)},
          {"preview", "", std::move(preview)},
          {"standard", "every key's default", {}},
          {"fine", "", {{"run.min_substeps", 4}, {"solver.integrator", 0, "bdf2"}}}};
}

const std::vector<QualityLevel>& levels() {
  static const std::vector<QualityLevel> all = make_levels();
  return all;
}

const QualityLevel& level_of(const std::string& name) {
  return *std::ranges::find(levels(), name, &QualityLevel::name);
}

// The stepper `icm` has no other integrator.
bool applies(const QualityValue& value, const Config& scene) {
  return value.key != "solver.integrator" || scene["run"]["stepper"].text() != "icm";
}

Config& entry_of(Config& section, const std::string& key) {
  const std::size_t dot = key.find('.');
  return dot == std::string::npos ? section[key] : entry_of(section[key.substr(0, dot)], key.substr(dot + 1));
}

// Sections of run and solver on the way to a key are read where they are given.
void give_sections(Config& scene, const std::string& key) {
  for (std::size_t dot = key.find('.', key.find('.') + 1); dot != std::string::npos; dot = key.find('.', dot + 1))
    entry_of(scene, key.substr(0, dot)).given = true;
}

}  // namespace

std::vector<std::string> quality_names() { return names_of(levels()); }

std::string set_quality(Config& scene) {
  const QualityLevel& level = level_of(scene["run"]["quality"].text());
  std::string text = level.about;
  for (const QualityValue& value : level.values) {
    if (!applies(value, scene)) continue;
    Config& entry = entry_of(scene, value.key);
    const bool own = entry.given;
    if (!own) {
      give_sections(scene, value.key);
      entry.given = true;
      entry.where = scene["run"]["quality"].where;
      entry.words = value.word.empty() ? std::vector<std::string>{} : std::vector{value.word};
      entry.numbers = value.word.empty() ? std::vector{value.number} : std::vector<double>{};
    }
    const std::string shown = entry.words.empty() ? fmt::format("{}", entry.numbers.front()) : entry.words.front();
    text += (text.empty() ? "" : ", ") + value.key + " " + shown + (own ? " (given)" : "");
  }
  return level.name + ": " + text;
}

}  // namespace selvedge
