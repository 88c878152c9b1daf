#include "pipeline/suites/stability_suite.hpp"

#include "pipeline/config/options.hpp"
#include "pipeline/suites/spoiled_weights.hpp"

namespace selvedge {
namespace {

using namespace table;

const Options<StabilityLimits>& limits_options() {
  using O = StabilityLimits;
  static const Options<O> table(
      "limits", "What every run must keep, whatever its scene.",
      {number(
           "growth", &O::growth, Unit::none, positive,
           "Largest energy that nothing accounts for, in units of the largest kinetic and elastic energy of the run."),
       number("speed", &O::speed, Unit::none, positive,
              "Largest RMS speed in the last tenth of the run, in units of the speed of a fall by the cloth's extent."),
       integer("newton", &O::newton, at_least_one,
               "Largest number of Newton iterations in a substep, averaged over a frame. Seven solves of at most 32 "
               "iterations take 224."),
       integer("linear", &O::linear, at_least_one,
               "Largest number of linear iterations in a Newton iteration, averaged over a frame. A linear solve may "
               "take twice the default.")});
  return table;
}

const Section& run_section() {
  static const Section table{
      "run",
      "",
      {needed(text("name", "How the run differs from others, for readers.")),
       texts("set", "`key=value` overrides of the scene."),
       flag("short", false, "True: the run is in the short form too."),
       word("fault", weight_faults(), "",
            "What is wrong with the weights, for steppers with a network. `huge`: the network returns 1e6.")},
      "name"};
  return table;
}

const Section& case_section() {
  static const Section table{"case",
                             "",
                             {needed(text("name", "Short name of the case.")), text("about", "One line for readers."),
                              needed(path("scene", "Scene file, relative to the suite's folder.")),
                              texts("set", "`key=value` overrides of all its runs."),
                              needed(sections("runs", run_section(), "", "Runs: at least one."))}};
  return table;
}

const Section& suite_section() {
  static const Section table{
      "suite",
      "The whole file.",
      {text("description", "Free text for readers."), section(limits_options().section, "{}", ""),
       needed(sections("cases", case_section(), "", "Cases: at least one."))}};
  return table;
}

StabilityCase read_case(const Config& section, const std::filesystem::path& folder) {
  StabilityCase one{section["name"].text(), folder / section["scene"].text(), {}};
  if (!std::filesystem::exists(one.scene)) section["scene"].fail("does not exist", "looked for " + one.scene.string());
  for (const Config& run : section["runs"].items) {
    std::vector<std::string> overrides = section["set"].words;
    overrides.insert(overrides.end(), run["set"].words.begin(), run["set"].words.end());
    one.runs.push_back(
        {run["name"].text(), overrides, run["short"].flag(), run["fault"].given ? run["fault"].text() : ""});
  }
  if (one.runs.empty()) section["runs"].fail("is empty", "give at least one run");
  return one;
}

}  // namespace

StabilitySuite read_stability_suite(const std::filesystem::path& file) {
  const Config config = read_config(file, suite_section());
  StabilitySuite suite;
  suite.limits = limits_options().read(config["limits"]);
  for (const Config& one : config["cases"].items) suite.cases.push_back(read_case(one, file.parent_path()));
  return suite;
}

}  // namespace selvedge
