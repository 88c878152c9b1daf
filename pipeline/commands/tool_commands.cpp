#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <memory>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/error.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "pipeline/commands/command_output.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/number_checks.hpp"
#include "pipeline/config/config_units.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/run/progress.hpp"
#include "pipeline/tools/ccd_report.hpp"
#include "pipeline/tools/check.hpp"
#include "pipeline/tools/convert_body.hpp"
#include "pipeline/tools/dress.hpp"
#include "pipeline/tools/export.hpp"
#include "pipeline/tools/fit_report.hpp"
#include "pipeline/tools/push_mesh.hpp"
#include "pipeline/tools/sew_garment.hpp"
#include "pipeline/tools/untangle_mesh.hpp"
#include "pipeline/view/view.hpp"

namespace selvedge {
namespace {

// A length that an option gives [m].
double read_distance(const std::string& text, const std::string& option) {
  const Quantity length = read_quantity(text, Unit::length);
  if (!length.problem.empty()) throw Error(length.problem, option + "=" + text, "for example " + option + "=0.1mm");
  if (!(length.value > 0)) throw Error("is not above 0", option + "=" + text, "for example " + option + "=0.1mm");
  return length.value;
}

struct ViewArguments {
  std::vector<std::filesystem::path> runs;
  std::filesystem::path out = "view.html";
};

}  // namespace

RunCommand check_command(CLI::App& command) {
  const auto request = std::make_shared<CheckRequest>();
  command.add_option("file", request->file, "mesh (.obj, .ply), trajectory (.h5), or the folder of a run")->required();
  command.add_option("--rest", request->rest, "mesh with the same faces at rest, from which stretch is measured");
  command.add_option("--body", request->bodies, "mesh of a body that the cloth must not intersect; may be given again")
      ->allow_extra_args(false);
  command.add_option("--against", request->against,
                     "trajectory or run of the same cloths; adds the papers' measures of the difference");
  command.add_option("--audit", request->audit, "own: the program's audit; fcl: also FCL's result, to compare")
      ->check(CLI::IsMember({"own", "fcl"}));
  command.add_option("--horizon", request->horizon, "distance above which gaps are not measured [m]")
      ->check(above_zero());
  command.add_flag("--volume", request->volume,
                   "also measure the volume that crossing surfaces enclose, with holes closed");
  return [request](bool json) {
    const CheckReport report = check(*request);
    return end_command(json, check_text(report), check_json(report), is_clean(report));
  };
}

RunCommand untangle_command(CLI::App& command) {
  const auto request = std::make_shared<UntangleRequest>();
  command.add_option("file", request->file, "mesh (.obj, .ply)")->required();
  command.add_option("--out", request->out, "file for the untangled mesh (.obj, .ply)")->required();
  command.add_option("--body", request->bodies, "mesh of a body that does not move; may be given again")
      ->allow_extra_args(false);
  command.add_option("--unit", request->unit, "unit of the coordinates, for lengths in the report: m, dm, cm, mm, in");
  command.add_option("--layers", request->layers, "one number for each piece of cloth; the innermost has the lowest")
      ->delimiter(',');
  command.add_option("--iterations", request->iterations, "largest number of iterations")->check(above_zero());
  return [request](bool json) {
    UntangleRequest shown = *request;
    const bool terminal = isatty(STDERR_FILENO) != 0;
    Clock::time_point last = Clock::now();
    shown.progress = [&](const UntangleProgress& now) {
      if (seconds_since(last) < (terminal ? 0.1 : 5)) return;
      last = Clock::now();
      const std::string line =
          fmt::format("iteration {} of {}, {} left", now.iteration, request->iterations, counted(now.pairs, "pair"));
      std::cerr << (terminal ? "\r" + line + "\033[K" : line + "\n") << std::flush;
    };
    const UntangleReport report = untangle_mesh(shown);
    if (terminal) std::cerr << "\r\033[K" << std::flush;
    return end_command(json, untangle_text(report), untangle_json(report), is_clean(report));
  };
}

RunCommand push_command(CLI::App& command) {
  const auto request = std::make_shared<PushRequest>();
  command.add_option("file", request->file, "garment (.obj, .ply), in metres")->required();
  command.add_option("--body", request->body, "mesh of the body")->required();
  command.add_option("--truth", request->truth, "true positions of the garment, with the same faces, to compare with");
  command.add_option("--out", request->out, "file for the pushed garment (.obj, .ply)");
  command
      .add_option("--method", request->method,
                  "layer (the repulsive layer), smooth (a least-squares displacement) or none")
      ->check(CLI::IsMember({"layer", "smooth", "none"}));
  command
      .add_option("--shape", request->shape,
                  "surface of a body that passes through itself: union (its outside) or raw (all faces)")
      ->check(CLI::IsMember({"union", "raw"}));
  command.add_option("--alpha", request->alpha, "length of the push, in penetration depths")->check(at_least_zero());
  command.add_option("--margin", request->margin, "length added to each push [m]")->check(at_least_zero());
  command.add_option("--recheck", request->recheck, "number of further passes over pushed vertices")
      ->check(at_least_zero());
  command.add_option("--edge-pass", request->edge_pass, "number of rounds that move crossing edges out of the body")
      ->check(at_least_zero());
  return [request](bool json) {
    const PushReport report = push_mesh(*request);
    return end_command(json, push_text(report), push_json(report), report.after.collision_free);
  };
}

RunCommand dress_command(CLI::App& command) {
  const auto request = std::make_shared<DressRequest>();
  command.add_option("mesh", request->mesh, "garment where the body wears it (.obj, .ply)")->required();
  command.add_option("--out", request->out, "file for the garment (.h5)")->required();
  command.add_option("--unit", request->unit,
                     "unit of the coordinates: m, dm, cm, mm, in; default: guessed from the body");
  const auto up = std::make_shared<std::string>();
  command.add_option("--up", *up, "axis of the mesh that points up; default: guessed from the body")
      ->check(CLI::IsMember({"y", "z"}));
  const auto weld = std::make_shared<std::string>();
  command.add_flag("--weld", *weld, "join pieces where their borders meet; --weld=0.1mm sets the distance");
  command.add_option("--body", request->body, "body: mannequin, or a file (.npz, .h5)");
  command.add_option("--shape", request->shape, "shape coefficients of the body")->delimiter(',');
  CLI::Option* pose =
      command.add_option("--pose", request->pose, "clip that poses the body: a name, .bvh or .npz; default: zero pose");
  command.add_option("--time", request->time, "time of the pose in the clip [s]")
      ->needs(pose)
      ->check(CLI::NonNegativeNumber);
  command
      .add_option("--rotate", request->rotations,
                  "JOINT=x,y,z: rotation of a joint in the pose, axis times angle [rad]; may be given again")
      ->allow_extra_args(false);
  command
      .add_option("--fit", request->fit,
                  "skinning weights: loose (mean of near body vertices) or tight (the nearest one's)")
      ->check(CLI::IsMember({"tight", "loose"}));
  command.add_option("--pin", request->pins, "vertex group that is pinned to the body, or none; may be given again")
      ->allow_extra_args(false);
  return [request, up, weld](bool json) {
    if (!up->empty()) request->up = *up == "z" ? Up::z : Up::y;
    request->weld = !weld->empty();
    if (request->weld && *weld != "true") request->weld_within = read_distance(*weld, "--weld");
    const DressReport report = dress(*request);
    return end_command(json, dress_text(report), dress_json(report), is_clean(report));
  };
}

RunCommand pattern_command(CLI::App& command) {
  const auto request = std::make_shared<PatternRequest>();
  command.add_option("pattern", request->file, "pattern of GarmentCode (*_specification.json)")->required();
  command.add_option("--out", request->out, "file for the garment (.h5), or for its mesh alone (.obj, .ply)")
      ->required();
  command.add_option("--body", request->body, "body: mannequin, a file (.npz, .h5) or a mesh in metres (.obj, .ply)");
  command.add_option("--edge", request->edge, "length of the triangles' edges [m]")->check(CLI::Range(0.002, 0.2));
  command.add_option("--material", request->material, "name of the material of the cloth, as in scenes");
  command.add_option("--pin", request->pins, "vertex group that scenes pin to the body; may be given again")
      ->allow_extra_args(false);
  command.add_option("--record", request->record, "file for the trajectory of the sewing (.h5)");
  command.add_flag("--flat", request->flat, "write the flat panels as a mesh, and do not sew");
  return [request](bool json) {
    PatternRequest followed = *request;
    followed.progress = [](const SewingFrame& frame) {
      std::cerr << fmt::format("{} {:.2f} s: gaps {:.3g} mm, {:.3g} % move, {}\n", frame.sewn ? "draping" : "sewing",
                               frame.time, 1e3 * frame.largest_gap, 100 * frame.moving_share,
                               counted(frame.report->collision.pairs_after, "pair"));
    };
    const PatternReport report = sew_garment(followed);
    return end_command(json, pattern_text(report), pattern_json(report), request->flat || is_clean(report));
  };
}

RunCommand body_command(CLI::App& command) {
  const auto request = std::make_shared<BodyRequest>();
  command
      .add_option("file", request->file,
                  "mesh (.obj, .ply), model of the SMPL family (.npz) or glTF with a skin (.glb, .gltf)")
      ->required();
  command.add_option("--skeleton", request->skeleton, "MakeHuman's skeleton of the mesh (.mhskel)");
  command.add_option("--weights", request->weights, "MakeHuman's skinning weights of the mesh (.mhw)");
  command.add_option("--joints", request->joints,
                     "positions of the joints, for a mesh without skeleton and weights (.yaml)");
  command.add_option("--unit", request->unit, "unit of the mesh: m, dm, cm, mm, in");
  const auto up = std::make_shared<std::string>("y");
  command.add_option("--up", *up, "axis of the mesh, and of --joints, that points up")
      ->check(CLI::IsMember({"y", "z"}));
  command
      .add_option("--mesh", request->meshes.only,
                  "mesh of a glTF file, or group of a mesh, that becomes the body; may be given again")
      ->allow_extra_args(false);
  command.add_option("--without", request->meshes.without, "mesh or group that is left out; may be given again")
      ->allow_extra_args(false);
  command.add_option("--out", request->out, "file for the body (.h5)")->required();
  return [request, up](bool json) {
    request->up = *up == "z" ? Up::z : Up::y;
    const BodyReport report = convert_body(*request);
    return end_command(json, body_text(report), body_json(report), true);
  };
}

RunCommand ccd_command(CLI::App& command) {
  const auto files = std::make_shared<std::vector<std::filesystem::path>>();
  command.add_option("files", *files, "queries with known answers (.csv), in folders edge-edge or vertex-face")
      ->required();
  return [files](bool json) {
    const CcdReport report = ccd_report(*files);
    return end_command(json, ccd_text(report), ccd_json(report), is_clean(report));
  };
}

RunCommand fit_command(CLI::App& command) {
  const auto request = std::make_shared<FitRequest>();
  command.add_option("run", request->run, "trajectory (.h5), or the folder of a run")->required();
  command.add_option("--scene", request->scene, "scene of the run; default: config.yaml beside the trajectory");
  command.add_option("--body", request->body, "name of the body; default: the first one of the scene");
  command.add_option("--regions", request->regions,
                     "regions of the body: vertices by name (.json); default: regions by joints");
  command.add_option("--frame", request->frame, "number of the frame; default: the last one")->check(at_least_zero());
  command.add_option("--reach", request->reach, "distance from the skin within which cloth counts as touching [m]")
      ->check(above_zero());
  command.add_option("--out", request->out, "file for a page that shows the results as colours (.html)");
  return [request](bool json) {
    const FitReport report = fit(*request);
    const std::string page = request->out.empty() ? "" : "page to look at: " + request->out.string() + "\n";
    return end_command(json, fit_text(report) + page, fit_json(report), true);
  };
}

RunCommand export_command(CLI::App& command) {
  const auto request = std::make_shared<ExportRequest>();
  command.add_option("trajectory", request->trajectory, "trajectory (.h5), or the folder of a run")->required();
  command.add_option("--format", request->format, "format: " + export_format_list());
  command.add_option("--out", request->out, "folder for the files")->default_val("export");
  command.add_flag("--obstacles", request->obstacles, "export the obstacles too");
  CLI::Option* onto = command.add_option(
      "--onto", request->onto, "mesh of your own at the rest shape of the cloth, which moves it (.obj, .ply)");
  command.add_option("--onto-unit", request->onto_unit, "unit of that mesh: m, dm, cm, mm, in")->needs(onto);
  command.add_option("--cloth", request->cloth, "name of the cloth that moves the mesh; default: all cloths")
      ->needs(onto);
  return [request](bool json) {
    Progress progress(std::cerr, isatty(STDERR_FILENO) != 0);
    ExportRequest shown = *request;
    shown.warn = [](const std::string& warning) { std::cerr << "warning: " << warning << "\n"; };
    shown.progress = [&](int done, int all) {
      if (done == 1) progress.begin(0, all);
      progress.frame(done);
    };
    std::vector<std::filesystem::path> written;
    const InterruptWatch watch;
    const StopFlag stop = InterruptWatch::interrupted;
    try {
      const StopScope scope(stop);
      written = export_trajectory(shown);
    } catch (const Stopped&) {
      progress.end();
      return end_command(json, "stopped; the files that are whole are in " + request->out.string() + "\n",
                         json_text({{"finished", false}}), false);
    }
    progress.end();
    Json list = Json::array();
    for (const std::filesystem::path& file : written) list.push_back(file.string());
    return end_command(json,
                       fmt::format("{}, the last is {}\n", counted(std::ssize(list), "file"), written.back().string()),
                       json_text({{"files", list}}), true);
  };
}

RunCommand view_command(CLI::App& command) {
  const auto arguments = std::make_shared<ViewArguments>();
  command.add_option("runs", arguments->runs, "trajectories (.h5) or folders of runs, shown side by side")->required();
  command.add_option("--out", arguments->out, "file for the page (.html)");
  return [arguments](bool json) {
    write_view(arguments->runs, arguments->out);
    return end_command(json, "page to look at: " + arguments->out.string() + "\n",
                       json_text({{"page", arguments->out.string()}}), true);
  };
}

}  // namespace selvedge
