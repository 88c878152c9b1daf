#include "pipeline/run/resume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/error.hpp"
#include "pipeline/host/json_text.hpp"
#include "pipeline/host/label_lines.hpp"
#include "pipeline/host/read_file.hpp"
#include "pipeline/run/memory_forms.hpp"
#include "pipeline/run/run_inputs_yaml.hpp"

namespace selvedge {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& field, const std::string& what,
                         const std::string& cure = "run without --resume") {
  throw Error(what, file.string() + ": " + field, cure);
}

// The first line in which two configurations differ.
std::string difference(const std::string& before, const std::string& now) {
  std::istringstream old_lines(before), new_lines(now);
  std::string old_line, new_line;
  do {
    old_line.clear();
    new_line.clear();
    std::getline(old_lines, old_line);
    std::getline(new_lines, new_line);
  } while (old_line == new_line && (old_lines || new_lines));
  const auto trimmed = [](const std::string& line) {
    return line.substr(std::min(line.find_first_not_of(" -"), line.size()));
  };
  return fmt::format("`{}` then, `{}` now", trimmed(old_line), trimmed(new_line));
}

void check_config(const std::filesystem::path& file, const std::string& before, const std::string& now) {
  if (before != now)
    refuse(file, "config", "was made under another configuration: " + difference(before, now),
           "resume with the same scene file and --set, or run without --resume");
}

void check_moment(const std::filesystem::path& file, const State& state, const RunOptions& run) {
  if (state.frame > run.frames)
    refuse(file, "frame", fmt::format("is {}, the run has {} frames", state.frame, run.frames));
  if (!(std::abs(state.time - state.frame / run.fps) <= 1e-6))
    refuse(
        file, "time",
        fmt::format("is {:g} s, frame {} of the scene is at {:g} s", state.time, state.frame, state.frame / run.fps));
}

// Triangles that are cut out must have been cut out at the start.
void check_cut_out(const std::filesystem::path& file, const State& state, const State& initial) {
  if (!std::ranges::includes(initial.cut_out, state.cut_out))
    refuse(file, "cut_out",
           fmt::format("has {} triangles, not all of which are among the {} that the scene cuts out",
                       state.cut_out.size(), initial.cut_out.size()));
}

template <class Matrix>
bool same_matrix(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && a == b;
}

// Compares a state that was kept with the scene, as far as it can be used.
void check_kept_state(const std::filesystem::path& saved, const Checkpoint& checkpoint, const Setup& setup,
                      const RunInputs& inputs) {
  check_config(saved, checkpoint.inputs.config, inputs.config);
  if (checkpoint.knows_files) check_input_files(saved, checkpoint.inputs.files, inputs.files, "the scene");
  check_fits(saved, checkpoint.state, setup.scene);
  if (const auto problem = misfit(checkpoint.state.memory, setup.scene)) refuse(saved, "memory_*", *problem);
  check_moment(saved, checkpoint.state, setup.run);
  check_cut_out(saved, checkpoint.state, setup.initial);
}

void check_kept_scene(const std::filesystem::path& saved, const Checkpoint& checkpoint, const RunInputs& inputs) {
  if (!checkpoint.knows_files)
    refuse(saved, "input_hashes", "is missing: an earlier version of this program wrote the checkpoint");
  if (checkpoint.inputs.scene != inputs.scene)
    refuse(saved, "scene_hash",
           "is of another scene: what code makes, or the program keeps in its cache, or a file that another file names "
           "has changed since the run began");
}

// Compares constants of a trajectory with those of the scene.
struct TrajectoryCheck {
  const std::filesystem::path& file;

  void count(const std::string& field, Eigen::Index found, Eigen::Index wanted, const std::string& what) const {
    if (found != wanted) refuse(file, field, fmt::format("has {} {}, the scene has {}", found, what, wanted));
  }
  void same(const std::string& field, bool same, const std::string& what) const {
    if (!same) refuse(file, field, "has other " + what + " than the scene");
  }
  void cloth(const TrajectoryInfo& found, const TrajectoryInfo& wanted) const {
    count("cloth/rest", found.rest.rows(), wanted.rest.rows(), "vertices");
    count("cloth/triangles", found.triangles.rows(), wanted.triangles.rows(), "triangles");
    count("cloth/names", std::ssize(found.cloth_names), std::ssize(wanted.cloth_names), "cloths");
    count("cloth/pins", std::ssize(found.pins), std::ssize(wanted.pins), "pins");
    same("cloth/names", found.cloth_names == wanted.cloth_names, "names");
    same("cloth/first_vertex", found.cloth_first_vertex == wanted.cloth_first_vertex, "cloths");
    same("cloth/first_triangle", found.cloth_first_triangle == wanted.cloth_first_triangle, "cloths");
    same("cloth/triangles", same_matrix(found.triangles, wanted.triangles), "triangles");
    same("cloth/rest", same_matrix(found.rest, wanted.rest), "places at rest");
    same("cloth/rest_triangles", found.rest_triangle == wanted.rest_triangle, "shapes at rest");
    same("cloth/pins", found.pins == wanted.pins, "pins");
  }
  void obstacles(const TrajectoryInfo& found, const TrajectoryInfo& wanted) const {
    count("obstacles", std::ssize(found.obstacles), std::ssize(wanted.obstacles), "obstacles");
    for (std::size_t k = 0; k < wanted.obstacles.size(); ++k) {
      const TrajectoryInfo::Body &its = found.obstacles[k], &own = wanted.obstacles[k];
      const std::string field = fmt::format("obstacles/{}", k);
      if (its.name != own.name) refuse(file, field + "/name", "is `" + its.name + "`, in the scene `" + own.name + "`");
      count(field + "/x", its.vertex_count, own.vertex_count, "vertices");
      same(field + "/triangles", same_matrix(its.triangles, own.triangles), "triangles");
    }
  }
};

// The checkpoint's state must be that of the trajectory's frame with its number.
void check_last_frame(const std::filesystem::path& file, const TrajectoryReader& reader, const State& state) {
  if (reader.frame_count() <= state.frame)
    refuse(file, "frames_complete",
           fmt::format("counts {}, the checkpoint was made after frame {}", counted(reader.frame_count(), "frame"),
                       state.frame));
  const Frame last = reader.frame(state.frame);
  const std::string cure = "run without --resume: checkpoint and trajectory are of different runs";
  const std::string at = fmt::format("frame {}", state.frame);
  if (last.time != state.time)
    refuse(file, "frames/report", fmt::format("has {} at {:g} s, the checkpoint at {:g} s", at, last.time, state.time),
           cure);
  if (last.x != state.x.cast<float>())
    refuse(file, "frames/x", "has other positions in " + at + " than the checkpoint", cure);
  for (std::size_t k = 0; k < state.obstacles.size(); ++k)
    if (last.obstacles[k] != state.obstacles[k].cast<float>())
      refuse(file, fmt::format("obstacles/{}/x", k), "has other positions in " + at + " than the checkpoint", cure);
}

}  // namespace

void check_input_files(const std::filesystem::path& file, const std::vector<InputFile>& before,
                       const std::vector<InputFile>& now, const std::string& reader) {
  const std::string cure = "put back the file that the run began with, or run without --resume";
  for (const InputFile& input : now) {
    const auto old = std::ranges::find(before, input.name, &InputFile::name);
    if (old == before.end())
      refuse(file, "input_names",
             "the run did not begin with the file `" + input.name + "`, which " + reader + " reads", cure);
    if (old->hash != input.hash)
      refuse(file, "input_hashes", "the file `" + input.name + "` has changed since the run began", cure);
  }
  for (const InputFile& input : before)
    if (std::ranges::find(now, input.name, &InputFile::name) == now.end())
      refuse(file, "input_names",
             "the run began with the file `" + input.name + "`, which " + reader + " does not read", cure);
}

ResumedRun read_resumed(const std::filesystem::path& folder, const Setup& setup, const StepperTraits& traits,
                        const RunInputs& inputs) {
  const std::filesystem::path saved = folder / "checkpoint.h5", file = folder / "run.h5";
  Checkpoint checkpoint = read_checkpoint(saved);
  check_kept_state(saved, checkpoint, setup, inputs);
  auto reader = std::make_unique<TrajectoryReader>(file);
  const TrajectoryInfo wanted = trajectory_info(setup.scene, setup.config, traits.name, setup.run.fps);
  const TrajectoryCheck check{file};
  check.cloth(reader->info(), wanted);
  check.obstacles(reader->info(), wanted);
  if (reader->info().fps != wanted.fps)
    refuse(file, "fps", fmt::format("is {:g}, in the scene {:g}", reader->info().fps, wanted.fps));
  check_config(file, reader->info().config, wanted.config);
  check_last_frame(file, *reader, checkpoint.state);

  check_kept_scene(saved, checkpoint, inputs);
  return {std::move(checkpoint.state), inputs, std::move(reader)};
}

State read_draping(const std::filesystem::path& file, const Setup& setup, const RunInputs& inputs) {
  Checkpoint kept = read_checkpoint(file, setup.initial.frame);
  check_kept_state(file, kept, setup, inputs);
  if (kept.state.frame >= 0) refuse(file, "frame", fmt::format("is {}, which is not before time 0", kept.state.frame));
  check_kept_scene(file, kept, inputs);
  return std::move(kept.state);
}

std::optional<EndedRun> read_ended(const std::filesystem::path& folder, const RunInputs& inputs) {
  const std::filesystem::path file = folder / "summary.json", trajectory = folder / "run.h5";
  if (!std::filesystem::exists(file)) return {};
  EndedRun ended{read_text_file(file, "summary")};
  Json json = parse_json_or_discard(ended.summary);
  if (!json.is_object() || !json.contains("end")) refuse(file, "end", "is missing: this is no summary of a run");
  if (json["end"] == "interrupted") return {};
  check_config(trajectory, TrajectoryReader(trajectory).info().config, inputs.config);
  const std::string hash = fmt::format("{:016x}", hash_of_inputs(inputs));
  if (json.value("inputs_hash", Json()) != hash)
    refuse(file, "inputs_hash",
           "is not that of the files of the scene: they have changed, or it is of another version");
  ended.clean = json.value("clean", Json()) == true;
  LabelLines add{20};
  add("ended before", fmt::format("{}, {} of {} frames, {}", json["end"].get<std::string>(), json_line(json["frames"]),
                                  json_line(json["frames_wanted"]), ended.clean ? "clean" : "not clean"));
  for (Json& outcome : json["outcomes"])
    add("outcome", outcome["name"].get<std::string>() + (outcome["came_true"] == true ? ": yes" : ": no"));
  ended.text = add.text;
  return ended;
}

Frame resumed_frame(const ResumedRun& run, int index, const std::filesystem::path& folder) {
  Frame frame = run.frames->frame(index);
  const auto is_finite = [](const PointsF& x) { return x.allFinite(); };
  if (!is_finite(frame.x) || !std::ranges::all_of(frame.obstacles, is_finite))
    refuse(folder / "run.h5", "frames/x", fmt::format("has positions in frame {} that are not finite", index));
  return frame;
}

}  // namespace selvedge
