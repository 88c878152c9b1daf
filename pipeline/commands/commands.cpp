#include "pipeline/commands/commands.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "collision/geometry/stop_scope.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/host/folder_lock.hpp"
#include "pipeline/host/interrupt.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/run/run_scene.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/tools/ccd_report.hpp"
#include "pipeline/tools/info.hpp"
#include "pipeline/tools/plan.hpp"
#include "pipeline/tools/scene_pages.hpp"
#include "pipeline/training/running_mark.hpp"
#include "pipeline/view/view.hpp"

namespace selvedge {
namespace {

std::ostream& people(bool json) { return json ? std::cerr : std::cout; }

Setup read_scene(const SceneArguments& arguments) {
  std::vector<std::string> overrides = arguments.overrides;
  if (arguments.stepper) overrides.push_back("run.stepper=" + *arguments.stepper);
  if (arguments.weights)
    overrides.push_back("run.learned.weights=" + quoted_yaml(std::filesystem::absolute(*arguments.weights).string()));
  if (arguments.device) overrides.push_back("run.learned.device=" + *arguments.device);
  Setup setup = read_setup(arguments.scene, overrides);
  if ((arguments.weights || arguments.device) && setup.kind.network == NetworkUse::none)
    setup.warnings.push_back(
        fmt::format("{} has no part in the stepper `{}`, which runs no network; --stepper learned "
                    "and --stepper hybrid do",
                    arguments.weights ? "--weights" : "--device", setup.run.stepper));
  return setup;
}

std::filesystem::path folder_for(const SimulateArguments& arguments, const Setup& setup) {
  if (arguments.out) return *arguments.out;
  if (!setup.run.output.empty()) return setup.run.output;
  return std::filesystem::path("out") / arguments.scene.scene.stem();
}

// What takes times says so while a training takes the cores.
void warn_of_training() {
  if (const std::optional<std::string> training = running_training())
    std::cerr << "warning: " << *training << " is being trained: times are not to be compared with others\n";
}

// Makes the page and says where it is, or why it is not.
std::string page_text(const std::filesystem::path& out, const RunSummary& summary) {
  if (summary.end == RunEnd::interrupted) return "not made of a run that was stopped: `selvedge view` makes one";
  const std::optional<std::string> trouble = write_page(out);
  return trouble ? "not made: " + *trouble : (out / "view.html").string();
}

// Long work that says how it goes on and can be interrupted.
template <class Request>
Request followed(Request request) {
  request.log = &std::cerr;
  request.stop = InterruptWatch::interrupted;
  return request;
}

// Whether all that the scene states came true, with a line each. A resumed run has not seen its first frames.
bool report_outcome(const std::vector<Outcome>& outcomes, const std::vector<OutcomeResult>& results, std::ostream& to) {
  for (std::size_t k = 0; k < outcomes.size(); ++k)
    to << fmt::format("{:<20}{}\n", k == 0 ? "outcome" : "", outcome_text(outcomes[k], results[k]));
  return all_came_true(results);
}

}  // namespace

int simulate_command(const SimulateArguments& arguments, bool json) {
  const Setup setup = read_scene(arguments.scene);
  warn_of_training();
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  for (const std::string& warning : run_warnings(setup, stepper->traits())) std::cerr << "warning: " << warning << "\n";
  Progress progress(std::cerr, isatty(STDERR_FILENO) != 0);
  const InterruptWatch watch;
  const std::filesystem::path out = folder_for(arguments, setup);
  make_folder(out);
  const FolderLock lock(out);
  std::optional<Start> start;
  if (!arguments.resume) start = prepare(setup, InterruptWatch::interrupted, &progress, InterruptWatch::interrupted);
  if (!arguments.resume && !start) {
    people(json) << "stopped before the first frame\n";
    return 1;
  }
  RunRequest request;
  request.out = out;
  request.locked = true;
  request.progress = &progress;
  request.stop = request.interrupt = InterruptWatch::interrupted;
  OutcomeWatch outcome(setup.scene, setup.outcomes, setup.run.frames / setup.run.fps);
  request.observe = [&](const FrameEvent& event) { outcome(event.state, event.drive); };
  RunSummary summary;
  try {
    const StopScope scope(request.interrupt);
    outcome(start ? start->state : setup.initial, setup.drive_at(0));
    summary = start ? run_scene(setup, *start, *stepper, request) : resume_scene(setup, *stepper, request);
  } catch (const Stopped&) {
    people(json) << "stopped before the first frame\n";
    return 1;
  }
  people(json) << summary_text(summary) << fmt::format("{:<20}{}\n", "trajectory", (request.out / "run.h5").string());
  if (arguments.view) people(json) << fmt::format("{:<20}{}\n", "page to look at", page_text(request.out, summary));
  const bool came_true = arguments.resume || report_outcome(setup.outcomes, outcome.results(), people(json));
  if (summary.end == RunEnd::interrupted) people(json) << "go on with --resume and the same arguments\n";
  if (json) std::cout << summary_json(summary);
  return is_clean(summary) && came_true ? 0 : 1;
}

int plan_command(const SceneArguments& arguments, bool json) {
  const Setup setup = read_scene(arguments);
  std::cout << (json ? plan_json(setup) : plan_text(setup));
  return 0;
}

int check_command(const CheckRequest& request, bool json) {
  const CheckReport report = check(request);
  people(json) << check_text(report);
  if (json) std::cout << check_json(report);
  return is_clean(report) ? 0 : 1;
}

int untangle_command(const UntangleRequest& request, bool json) {
  UntangleRequest shown = request;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  Clock::time_point last = Clock::now();
  shown.progress = [&](const UntangleProgress& now) {
    if (seconds_since(last) < (terminal ? 0.1 : 5)) return;
    last = Clock::now();
    const std::string line =
        fmt::format("iteration {} of {}, {} pairs left", now.iteration, request.iterations, now.pairs);
    std::cerr << (terminal ? "\r" + line + "\033[K" : line + "\n") << std::flush;
  };
  const UntangleReport report = untangle_mesh(shown);
  if (terminal) std::cerr << "\r\033[K" << std::flush;
  people(json) << untangle_text(report);
  if (json) std::cout << untangle_json(report);
  return is_clean(report) ? 0 : 1;
}

int push_command(const PushRequest& request, bool json) {
  const PushReport report = push_mesh(request);
  people(json) << push_text(report);
  if (json) std::cout << push_json(report);
  return report.after.collision_free ? 0 : 1;
}

int dress_command(const DressRequest& request, bool json) {
  const DressReport report = dress(request);
  people(json) << dress_text(report);
  if (json) std::cout << dress_json(report);
  return is_clean(report) ? 0 : 1;
}

int pattern_command(const PatternRequest& request, bool json) {
  PatternRequest followed = request;
  followed.progress = [](const SewingFrame& frame) {
    std::cerr << fmt::format("{} {:.2f} s: gaps {:.3g} mm, {:.3g} % move, {} pairs\n",
                             frame.sewn ? "draping" : "sewing", frame.time, 1e3 * frame.largest_gap,
                             100 * frame.moving_share, frame.report->collision.pairs_after);
  };
  const PatternReport report = sew_garment(followed);
  people(json) << pattern_text(report);
  if (json) std::cout << pattern_json(report);
  return request.flat || is_clean(report) ? 0 : 1;
}

int body_command(const BodyRequest& request, bool json) {
  const BodyReport report = convert_body(request);
  people(json) << body_text(report);
  if (json) std::cout << body_json(report);
  return 0;
}

int ccd_command(const CcdArguments& arguments, bool json) {
  const CcdReport report = ccd_report(arguments.files);
  people(json) << ccd_text(report);
  if (json) std::cout << ccd_json(report);
  return is_clean(report) ? 0 : 1;
}

int export_command(const ExportRequest& request, bool json) {
  Progress progress(std::cerr, isatty(STDERR_FILENO) != 0);
  ExportRequest shown = request;
  shown.progress = [&](int done, int all) {
    if (done == 1) progress.begin(0, all);
    progress.frame(done);
  };
  const std::vector<std::filesystem::path> written = export_trajectory(shown);
  progress.end();
  people(json) << fmt::format("{} files, the last is {}\n", written.size(),
                              written.empty() ? "none" : written.back().string());
  if (!json) return 0;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const std::filesystem::path& file : written) list.push_back(file.string());
  std::cout << nlohmann::ordered_json{{"files", list}}.dump(2) << "\n";
  return 0;
}

int fit_command(const FitRequest& request, bool json) {
  const FitReport report = fit(request);
  people(json) << fit_text(report);
  if (!request.out.empty()) people(json) << "page to look at: " << request.out.string() << "\n";
  if (json) std::cout << fit_json(report);
  return 0;
}

int view_command(const ViewArguments& arguments, bool json) {
  write_view(arguments.runs, arguments.out);
  people(json) << "page to look at: " << arguments.out.string() << "\n";
  if (json) std::cout << nlohmann::ordered_json{{"page", arguments.out.string()}}.dump(2) << "\n";
  return 0;
}

int bench_command(const BenchRequest& request, bool json) {
  warn_of_training();
  BenchRequest logged = request;
  logged.log = &std::cerr;
  const BenchResult result = bench(logged);
  people(json) << bench_table(result);
  if (json) std::cout << bench_json(result);
  return std::all_of(result.members.begin(), result.members.end(),
                     [](const BenchMember& m) { return is_clean(m.summary); })
             ? 0
             : 1;
}

int stress_command(const StressRequest& request, bool json) {
  warn_of_training();
  const InterruptWatch watch;
  const std::vector<StressRow> rows = stress(followed(request));
  people(json) << stress_table(rows);
  if (InterruptWatch::interrupted()) people(json) << "stopped; the same command goes on\n";
  if (json) std::cout << stress_json(rows);
  const bool passed = std::all_of(rows.begin(), rows.end(), [](const StressRow& row) { return row.passed(); });
  return passed && !InterruptWatch::interrupted() ? 0 : 1;
}

int wardrobe_command(const WardrobeRequest& request, bool json) {
  warn_of_training();
  const InterruptWatch watch;
  const std::vector<WardrobeRow> rows = wardrobe(followed(request));
  people(json) << wardrobe_table(rows);
  if (InterruptWatch::interrupted()) people(json) << "stopped; the same command goes on\n";
  if (json) std::cout << wardrobe_json(rows);
  const bool passed = std::all_of(rows.begin(), rows.end(), [](const WardrobeRow& row) { return row.passed(); });
  return passed && !InterruptWatch::interrupted() ? 0 : 1;
}

int compare_command(const CompareRequest& request, bool json) {
  warn_of_training();
  const InterruptWatch watch;
  const CompareResult result = compare(followed(request));
  people(json) << compare_table(result) << result.evaluation << result.repulsion << result.plots << "\n"
               << (request.out / "compare.html").string() << "\n";
  if (!result.finished) people(json) << "stopped; the same command goes on\n";
  if (json) std::cout << compare_json(result);
  return result.finished ? 0 : 1;
}

int validate_command(const ValidateRequest& request, bool json) {
  ValidateRequest logged = request;
  logged.log = &std::cerr;
  const std::vector<ValidationRow> rows = validate(logged);
  people(json) << validate_table(rows);
  if (json) std::cout << validate_json(rows);
  return passed(rows) ? 0 : 1;
}

int stability_command(const StabilityRequest& request, bool json) {
  warn_of_training();
  const InterruptWatch watch;
  const std::vector<StabilityRow> rows = stability(followed(request));
  people(json) << stability_table(rows);
  if (json) std::cout << stability_json(rows);
  return passed(rows) && !InterruptWatch::interrupted() ? 0 : 1;
}

int info_command(const InfoArguments& arguments, bool json) {
  if (!arguments.keys.empty()) {
    std::cout << scene_keys_text(arguments.keys == "user" ? KeyTier::user : KeyTier::expert);
    return 0;
  }
  std::cout << (json ? info_json() : info_text());
  return 0;
}

}  // namespace selvedge
