#include "pipeline/tools/plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/counted.hpp"
#include "collision/search/intersections.hpp"
#include "collision/untangle/caught.hpp"
#include "physics/linear/linear_solver.hpp"
#include "physics/scene/features.hpp"
#include "physics/solve/step_potential.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/scene/make_stepper.hpp"

namespace selvedge {

namespace {

std::string linear_solver_of(const Setup& setup) {
  const std::vector<char> free = free_vertices(setup.scene, lumped_masses(setup.scene));
  const int count = static_cast<int>(std::ranges::count(free, 1));
  const LinearSolver wanted = setup.run.conventional.implicit_euler.linear_solver;
  const LinearSolver chosen = chosen_solver(wanted, count);
  const char* name = chosen == LinearSolver::cholmod ? "CHOLMOD"
                     : chosen == LinearSolver::pcg   ? "PCG with block Jacobi"
                                                     : "PCG with a multigrid V-cycle";
  return fmt::format("{}, {}{}", name, wanted == LinearSolver::automatic ? "for " : "as asked for, ",
                     counted(count, "free vertex", "free vertices"));
}

// Lines for a stepper of any kind. Throws Error where a run would throw for missing weights.
void append_common_lines(const Setup& setup, std::vector<PlanLine>& lines) {
  const RefuRun& refu = setup.run.refu;
  if (refu.on) read_refu_weights(setup);
  lines.push_back({"repulsive layer", refu.on,
                   !refu.on               ? "not asked for by run.refu.on"
                   : refu.weights.empty() ? "behind every frame: what is inside a closed body is pushed out"
                                          : "behind every frame, its scales by the network " + refu.weights});
  if (setup.initial.frame < 0)
    lines.push_back({"draped start", true, counted(-setup.initial.frame, "frame") + " before time 0, not recorded"});
  if (!setup.initial.cut_out.empty()) lines.push_back({"cut start", true, setup.prepared + " until they are free"});
}

constexpr int frames_looked_at = 24;  // of a run, evenly spaced, beside its start

// An obstacle's crossings with itself in the frames looked at.
struct OwnCrossing {
  int frames = 0, pairs = 0, worst_frame = 0, triangles = 0;
  bool moves_rigidly = true;

  void look(const Surface& surface, const Points& start, const Points& x, int frame, IntersectionCache& cache) {
    moves_rigidly = moves_rigidly && selvedge::moves_rigidly(surface, start, x);
    const int found = static_cast<int>(intersecting_pairs(surface, x, cache).size());
    frames += found > 0;
    if (found <= pairs) return;
    pairs = found;
    worst_frame = frame;
    triangles = static_cast<int>(may_be_switched_off(surface, x).size());
  }
};

std::string text_of(const OwnCrossing& found, const std::string& name, int looked) {
  const std::string where =
      fmt::format("`{}` crosses itself in {} of {} looked at, in {} in frame {}: ", name, found.frames,
                  counted(looked, "frame"), counted(found.pairs, "pair"), found.worst_frame);
  return where + (found.moves_rigidly
                      ? "it keeps its shape, so that contact with its outside stays on"
                      : fmt::format("up to {} of its triangles can be switched off, for cloth that its parts catch",
                                    found.triangles));
}

// Lines on the contact that can be switched off, by obstacle.
void append_crossing_lines(const Setup& setup, std::vector<PlanLine>& lines) {
  const std::size_t count = setup.scene.obstacles.size();
  if (count == 0) return;
  std::vector<OwnCrossing> found(count);
  std::vector<IntersectionCache> caches(count);
  const int steps = std::min(frames_looked_at, setup.run.frames);
  const std::vector<Points> start = setup.drive_at(0).obstacles;
  for (int i = 0; i <= steps; ++i) {
    const int frame = steps > 0 ? static_cast<int>(std::int64_t{setup.run.frames} * i / steps) : 0;
    const std::vector<Points> now = i == 0 ? start : setup.drive_at(frame / setup.run.fps).obstacles;
    for (std::size_t k = 0; k < count; ++k)
      found[k].look(setup.scene.obstacles[k].surface, start[k], now[k], frame, caches[k]);
  }
  const std::size_t before = lines.size();
  for (std::size_t k = 0; k < count; ++k)
    if (found[k].frames > 0)
      lines.push_back(
          {"switching off", !found[k].moves_rigidly, text_of(found[k], setup.scene.obstacles[k].name, steps + 1)});
  if (lines.size() == before)
    lines.push_back(
        {"switching off", false, "no obstacle crosses itself in " + counted(steps + 1, "frame") + " looked at"});
}

// Lines on what soft tissue costs, by body. They follow the look at a run's frames, which has posed the bodies.
void append_tissue_lines(const Setup& setup, std::vector<PlanLine>& lines) {
  for (std::size_t k = 0; k < setup.bodies.size(); ++k) {
    if (!setup.bodies[k]) continue;
    const PosedBodies& body = *setup.bodies[k];
    const std::string& name = setup.scene.obstacles[k].name;
    if (body.room > 0)
      lines.push_back({"soft tissue", true,
                       fmt::format("the parts of `{}` leave {:.3g} mm for cloth, {:.0f} ms a pose here; its `room: 0` "
                                   "leaves this out",
                                   name, 1000 * body.room, 1000 * body.seconds / std::max(1, body.poses))});
    else
      lines.push_back({"soft tissue", false, fmt::format("`{}` stands still, or its room is 0", name)});
  }
}

// Lines on the needs of a stepper that solves.
void append_solver_lines(const Setup& setup, std::vector<PlanLine>& lines) {
  for (PlanLine& line : plan_lines(setup.scene)) lines.push_back(std::move(line));
  append_crossing_lines(setup, lines);
  append_tissue_lines(setup, lines);
  lines.push_back({"quality", true, setup.quality});
  lines.push_back({"linear solver", true, linear_solver_of(setup)});
  const bool networked = setup.kind.network != NetworkUse::none, rest = setup.run.rest && !networked;
  lines.push_back({"cloths at rest", !rest,
                   networked ? "stepped like others: a network sees all of the cloth"
                   : rest    ? "left out of a step as long as nothing that moves comes near them"
                             : "stepped like others, as run.rest asks"});
}

std::vector<PlanLine> lines_of(const Setup& setup) {
  std::vector<PlanLine> lines;
  if (setup.kind.network != NetworkUse::alone) append_solver_lines(setup, lines);
  if (setup.kind.plan)
    for (PlanLine& line : setup.kind.plan(setup)) lines.push_back(std::move(line));
  append_common_lines(setup, lines);
  return lines;
}

}  // namespace

std::string plan_json(const Setup& setup) {
  Json lines = Json::array();
  for (const PlanLine& line : lines_of(setup))
    lines.push_back({{"feature", line.feature}, {"in", line.in}, {"why", line.why}});
  return json_text({{"scene", setup.file.string()},
                    {"stepper", setup.run.stepper},
                    {"frames", setup.run.frames},
                    {"fps", setup.run.fps},
                    {"vertices", setup.scene.surface.vertex_count},
                    {"triangles", setup.scene.surface.triangles.rows()},
                    {"self", setup.scene.contact.self ? "audited" : "not audited"},
                    {"plan", lines},
                    {"warnings", scene_warnings(setup)}});
}

std::string plan_text(const Setup& setup) {
  const std::vector<PlanLine> lines = lines_of(setup);
  std::size_t width = 0;
  for (const PlanLine& line : lines) width = std::max(width, line.feature.size());
  std::string text = fmt::format("{}: {}, {}, {} at {} a second, stepper {}\n", setup.file.string(),
                                 counted(setup.scene.surface.vertex_count, "vertex", "vertices"),
                                 counted(setup.scene.surface.triangles.rows(), "triangle"),
                                 counted(setup.run.frames, "frame"), setup.run.fps, setup.run.stepper);
  for (const PlanLine& line : lines)
    text += fmt::format("  {:<3}  {:<{}}  {}\n", line.in ? "in" : "out", line.feature, width, line.why);
  for (const std::string& warning : scene_warnings(setup)) text += "  warning: " + warning + "\n";
  return text;
}

}  // namespace selvedge
