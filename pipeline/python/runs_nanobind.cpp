#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>

#include "collision/geometry/error.hpp"
#include "pipeline/compare/compare.hpp"
#include "pipeline/drapes/make_drapes.hpp"
#include "pipeline/drapes/train_drapes.hpp"
#include "pipeline/python/arrays_nanobind.hpp"
#include "pipeline/python/bindings_nanobind.hpp"
#include "pipeline/python/fields_nanobind.hpp"
#include "pipeline/python/overrides_nanobind.hpp"
#include "pipeline/python/python_stop_nanobind.hpp"
#include "pipeline/python/stepper_nanobind.hpp"
#include "pipeline/python/unlocked_nanobind.hpp"
#include "pipeline/run/running_mark.hpp"
#include "pipeline/tools/export.hpp"
#include "pipeline/tools/fit_report.hpp"
#include "pipeline/tools/plan.hpp"
#include "pipeline/view/view.hpp"

namespace selvedge {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using Path = std::filesystem::path;

nb::object object_of_json(const std::string& text) { return nb::module_::import_("json").attr("loads")(text); }

nb::object plan_of(const Path& file, const nb::object& overrides, const nb::dict& kinds) {
  return object_of_json(plan_json(
      read_setup(file, overrides_of(overrides), kinds_with(kinds, std::make_shared<HeldObjects::element_type>()))));
}

nb::object fit_of(const Path& run, const std::optional<Path>& scene, const std::string& body,
                  const std::optional<Path>& regions, std::optional<int> frame, std::optional<double> reach,
                  const std::optional<Path>& out) {
  if (frame && *frame < 0) throw Error("is " + std::to_string(*frame), "fit, frame", "give 0 or more");
  if (reach && !(*reach > 0 && std::isfinite(*reach)))
    throw Error("is " + std::to_string(*reach), "fit, reach", "give a length above 0 [m]");
  const FitRequest request{
      run, scene.value_or(""), body, regions.value_or(""), frame.value_or(-1), reach.value_or(0), out.value_or("")};
  const FitReport report = unlocked([&] { return fit(request); });
  nb::object result = object_of_json(fit_json(report));
  result["gap"] = copy_of(report.measures.gap);
  result["strain"] = copy_of(report.measures.strain);
  result["pressure"] = copy_of(report.measures.pressure);
  result["row"] = copy_of(report.measures.row);
  return result;
}

// Long work that says how it goes on, a line at a time, and ends with Ctrl-C. `work` has no lock.
template <class Request, class Work>
auto followed_by(Request request, const nb::object& log, const Work& work) {
  PythonStop stop;
  PythonLog lines(log, stop);
  request.log = &lines;
  request.stop = [&] { return stop.asked(); };
  const auto made = unlocked([&] { return work(request); });
  stop.raise_kept();
  return made;
}

nb::object dataset_of(const Path& config, const std::optional<Path>& out, const nb::object& overrides,
                      const nb::object& log) {
  DatasetRequest request;
  request.config = config;
  request.overrides = overrides_of(overrides);
  request.out = out.value_or("");
  return object_of_json(dataset_json(followed_by(request, log, make_dataset)));
}

nb::object train_of(const Path& config, const std::optional<Path>& out, const nb::object& overrides, bool resume,
                    const nb::object& log) {
  const RunningMark mark(config);
  if (mark.other()) warn({"another training runs: " + *mark.other()});
  TrainRequest request;
  request.config = config;
  request.overrides = overrides_of(overrides);
  request.out = out.value_or("");
  request.resume = resume;
  return object_of_json(followed_by(request, log, train_as_asked).json);
}

nb::object compare_file(const Path& file, const nb::dict& kinds, const Path& out, const nb::object& overrides,
                        bool short_form, const nb::object& log) {
  CompareRequest request;
  request.file = file;
  request.kinds = kinds_with(kinds, std::make_shared<HeldObjects::element_type>());
  request.out = out;
  request.overrides = overrides_of(overrides);
  request.short_form = short_form;
  const CompareResult result = followed_by(std::move(request), log, compare);
  nb::object rows = object_of_json(compare_json(result));
  rows["table"] = compare_table(result);
  return rows;
}

std::vector<Path> export_run(const Path& run, const std::string& format, const Path& out, bool obstacles,
                             const nb::object& progress) {
  ExportRequest request{run, format, out, obstacles};
  request.progress = [&](int done, int all) {
    const nb::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (!progress.is_none()) progress(done, all);
  };
  return unlocked([&] { return export_trajectory(request); });
}

nb::object page_of(const std::vector<Path>& runs, std::size_t limit) {
  std::vector<ViewRun> opened;
  for (const Path& run : runs) opened.push_back(open_view_run(run));
  ViewOptions options;
  options.limit = limit;
  return nb::cast(view_page(opened, options));
}

}  // namespace

void bind_runs(nb::module_& module) {
  const nb::object print = nb::module_::import_("builtins").attr("print");
  module.def(
      "plan", &plan_of, "file"_a, "overrides"_a = nb::tuple(), "kinds"_a = nb::dict(),
      "What a scene file needs, what is left out, and why: what `selvedge plan --json` prints, a dict. overrides "
      "and kinds as for Scene.");
  module.def("fit", &fit_of, "run"_a, nb::kw_only(), "scene"_a = nb::none(), "body"_a = "", "regions"_a = nb::none(),
             "frame"_a = nb::none(), "reach"_a = nb::none(), "out"_a = nb::none(),
             "How garments fit in a frame of a run (a trajectory, or the folder of a run): what `selvedge fit --json` "
             "prints, a dict, and of every vertex gap [m], strain, pressure [Pa] and row (of the table; -1: none). "
             "scene: the file that the run was made of (config.yaml beside it); body: an obstacle's name (the first "
             "body); regions: a file of the body's vertices by name (its joints); frame: the last; reach: what is "
             "nearer touches the skin [m] (twice the contact thickness); out: a page to write.");
  module.def("dataset", &dataset_of, "config"_a, "out"_a = nb::none(), "overrides"_a = nb::tuple(),
             "log"_a.none() = print,
             "Makes drapes at rest to train a network on, as the command does, in the folder out (out/data/NAME). log: "
             "called with a line for each path; None: silent. Ctrl-C keeps the paths that are done; the same call goes "
             "on. Returns what `selvedge dataset --json` prints, a dict.");
  module.def("train", &train_of, "config"_a, "out"_a = nb::none(), "overrides"_a = nb::tuple(), "resume"_a = false,
             "log"_a.none() = print,
             "Trains a network, as the command does, in the folder out (out/training/NAME). resume: from the folder's "
             "checkpoint. log: called with a line now and then; None: silent. Ctrl-C ends it at a checkpoint. Returns "
             "what `selvedge train --json` prints, a dict.");
  module.def("compare", &compare_file, "file"_a, "kinds"_a = nb::dict(), "out"_a = Path("out/compare"),
             "overrides"_a = nb::tuple(), "short"_a = false, "log"_a.none() = print,
             "Runs a comparison file (YAML), whose settings may name steppers of kinds, name to subclass of Stepper. "
             "What is finished is kept in the folder out, by the file's settings: empty it when a class has changed. "
             "log: called with a line as each part ends; None: silent. Ctrl-C keeps the parts that are done. Returns "
             "what compare.json holds, and table, a text.");
  module.def("export_run", &export_run, "run"_a, "format"_a, "out"_a, "obstacles"_a, "progress"_a.none(),
             "What selvedge.export calls. progress: called with the frames that were read and their number; or None.");
  module.def("page_of", &page_of, "runs"_a, "limit"_a, "The page that selvedge.view shows, as HTML.");
}

}  // namespace selvedge
