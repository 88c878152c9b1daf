#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "pipeline/commands/command_output.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/number_checks.hpp"
#include "pipeline/compare/compare.hpp"
#include "pipeline/suites/bench.hpp"
#include "pipeline/suites/stability.hpp"
#include "pipeline/suites/stress.hpp"
#include "pipeline/suites/wardrobe.hpp"
#include "pipeline/validate/validate.hpp"

namespace selvedge {
namespace {

// The end of a suite that may have been stopped: it passes if it finished and all its rows passed.
int end_suite(bool json, const std::string& table, const std::string& object, bool rows_passed) {
  const bool finished = !InterruptWatch::interrupted();
  return end_command(json, table + stopped_text(finished), object, finished && rows_passed);
}

}  // namespace

RunCommand bench_command(CLI::App& command) {
  const auto request = std::make_shared<BenchRequest>();
  command.add_option("--sizes", request->sizes, "numbers of vertices along a side of the sheet")->delimiter(',');
  command.add_option("--scenes", request->scenes, "names of scenes: hang, drop, tube")->delimiter(',');
  command.add_option("--only", request->only, "parts to run: detection, engine, training, scenes")
      ->delimiter(',')
      ->check(CLI::IsMember({"detection", "engine", "training", "scenes"}));
  command.add_option("--frames", request->frames, "number of frames, in place of the scenes' own");
  command.add_option("--configs", request->configs, "folder of the scenes");
  command.add_option("--out", request->out, "folder for the results");
  return [request](bool json) {
    warn_of_training();
    BenchRequest logged = *request;
    logged.log = &std::cerr;
    const BenchResult result = bench(logged);
    return end_command(json, bench_table(result), bench_json(result),
                       std::ranges::all_of(result.members, [](const BenchMember& m) { return is_clean(m.summary); }));
  };
}

RunCommand stress_command(CLI::App& command) {
  const auto request = std::make_shared<StressRequest>();
  command.add_option("scenes", request->scenes, "names of scenes; default: all");
  command.add_option("--repeats", request->repeats, "number of runs of each scene")->check(above_zero());
  command.add_option("--seed", request->seed, "seed of the jitter in the first run");
  command
      .add_option("--jitter", request->jitter, "largest random displacement of start positions, in mean edge lengths")
      ->check(at_least_zero());
  command.add_flag("--short", request->short_form, "run the short forms of the scenes");
  command.add_option("--configs", request->configs, "folder of the scenes");
  command.add_option("--out", request->out, "folder for the results");
  return [request](bool json) {
    warn_of_training();
    const InterruptWatch watch;
    const std::vector<StressRow> rows = stress(followed(*request));
    return end_suite(json, stress_table(rows), stress_json(rows), std::ranges::all_of(rows, &StressRow::passed));
  };
}

RunCommand wardrobe_command(CLI::App& command) {
  const auto request = std::make_shared<WardrobeRequest>();
  command.add_option("wear", request->wear, "names of garments and outfits that the program makes; default: all");
  command.add_option("--clips", request->clips, "names of procedural clips; default: all")->delimiter(',');
  command.add_option("--frames", request->most_frames, "largest number of frames of a clip")->check(above_zero());
  command.add_option("--configs", request->configs, "folder of the configurations");
  command.add_option("--out", request->out, "folder for the results");
  return [request](bool json) {
    warn_of_training();
    const InterruptWatch watch;
    const std::vector<WardrobeRow> rows = wardrobe(followed(*request));
    return end_suite(json, wardrobe_table(rows), wardrobe_json(rows), std::ranges::all_of(rows, &WardrobeRow::passed));
  };
}

RunCommand compare_command(CLI::App& command) {
  const auto request = std::make_shared<CompareRequest>();
  command.add_option("comparison", request->file, "comparison file (YAML)")->required();
  command.add_flag("--short", request->short_form, "run the short forms of the comparison and of its scenes");
  add_overrides(command, request->overrides, "the comparison file's");
  command.add_option("--out", request->out, "folder for the results");
  return [request](bool json) {
    warn_of_training();
    const InterruptWatch watch;
    const CompareResult result = compare(followed(*request));
    return end_command(json,
                       compare_table(result) + result.evaluation + result.repulsion + result.plots + "\n" +
                           (request->out / "compare.html").string() + "\n" + stopped_text(result.finished),
                       compare_json(result), result.finished);
  };
}

RunCommand validate_command(CLI::App& command) {
  const auto request = std::make_shared<ValidateRequest>();
  command.add_option("cases", request->cases, "names of cases; default: all");
  command.add_option("--set", request->overrides, "parameter=value[,value...], in place of the values of the cases")
      ->allow_extra_args(false);
  command.add_flag("--short", request->short_form, "run the short list of parameters of each case");
  command.add_option("--out", request->out, "folder for the results");
  return [request](bool json) {
    ValidateRequest logged = *request;
    logged.log = &std::cerr;
    const std::vector<ValidationRow> rows = validate(logged);
    return end_command(json, validate_table(rows), validate_json(rows), passed(rows));
  };
}

RunCommand stability_command(CLI::App& command) {
  const auto request = std::make_shared<StabilityRequest>();
  command.add_option("suite", request->suite, "suite file; default: configs/stability.yaml");
  command.add_option("--case", request->cases, "names of cases; default: all")->allow_extra_args(false);
  command.add_option("--stepper", request->stepper, "stepper, in place of the scenes' own");
  command.add_option("--weights", request->weights, "weight file of the steppers `learned` and `hybrid`");
  command.add_flag("--short", request->short_form, "do only the runs that the suite marks as short");
  command.add_option("--out", request->out, "folder for the results");
  return [request](bool json) {
    warn_of_training();
    const InterruptWatch watch;
    const std::vector<StabilityRow> rows = stability(followed(*request));
    return end_command(json, stability_table(rows), stability_json(rows),
                       passed(rows) && !InterruptWatch::interrupted());
  };
}

}  // namespace selvedge
