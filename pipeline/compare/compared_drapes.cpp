#include "pipeline/compare/compared_drapes.hpp"

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "collision/search/intersections.hpp"
#include "physics/scene/make_scene.hpp"
#include "pipeline/drapes/drape_run.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/view/view.hpp"

namespace selvedge {
namespace {

std::vector<const DrapeCase*> cases_of(const std::vector<std::unique_ptr<DrapeBody>>& bodies) {
  std::vector<const DrapeCase*> cases;
  for (const std::unique_ptr<DrapeBody>& body : bodies) cases.push_back(&body->sample.drape);
  return cases;
}

// What the network reads of each test drape, from the nearest drape that it was trained on.
std::vector<double> distances_from_training(const DrapeRun& run) {
  const FeatureRows trained = drape_inputs(run.backbone.drape, cases_of(run.lessons.training));
  const FeatureRows tested = drape_inputs(run.backbone.drape, cases_of(run.lessons.test));
  std::vector<double> distances;
  for (Eigen::Index k = 0; k < tested.rows(); ++k)
    distances.push_back(static_cast<double>((trained.rowwise() - tested.row(k)).rowwise().norm().minCoeff()));
  return distances;
}

MeasuredDrapes describe_drapes(const ComparedDrapes& asked, const DrapeRun& run) {
  const DrapeSet& set = *run.lessons.set;
  MeasuredDrapes made{asked.name, {}, asked.use, asked.counted};
  made.vertices = set.world.surface.vertex_count;
  made.training = static_cast<int>(run.lessons.training.size() + run.lessons.validation.size());
  made.test = static_cast<int>(run.lessons.test.size());
  std::vector<std::vector<double>> shapes;
  for (const auto* paths : {&set.training, &set.test})
    for (const DrapePath& path : *paths) {
      if (paths == &set.training) shapes.emplace_back(path.shape.begin(), path.shape.end());
      for (const auto& [reason, count] : path.dropped) made.dropped[reason] += count;
    }
  std::ranges::sort(shapes);
  made.shapes = static_cast<int>(std::unique(shapes.begin(), shapes.end()) - shapes.begin());
  if (!run.distance.layers.empty()) made.distance = distance_errors_of(run.options.distance, run.lessons, run.distance);
  made.from_training = distances_from_training(run);
  return made;
}

// One method on some test drapes, a frame each, with the triangles marked that meet the body.
ViewRun view_of(const DrapeRun& run, const std::string& name, const std::function<Points(DrapeBody&)>& positions,
                const std::vector<std::size_t>& picked) {
  const DrapeWorld& world = run.lessons.set->world;
  ViewRun view{name, {}, static_cast<int>(picked.size()), {}};
  TrajectoryInfo& info = view.info;
  info.stepper = name;
  info.fps = 1;
  info.self_audited = false;
  info.cloth_names = {world.options.garment};
  info.triangles = world.surface.triangles;
  info.cloth_first_vertex = {0, world.surface.vertex_count};
  info.cloth_first_triangle = {0, static_cast<int>(info.triangles.rows())};
  info.rest = run.lessons.test[picked.front()]->sample.drape.rest;
  info.rest_triangle = flattened(info.rest, info.triangles);
  info.obstacles = {{"body", world.body_surface.triangles, world.body_surface.vertex_count, true}};
  view.frame = [&run, positions, picked](int index) {
    DrapeBody& body = *run.lessons.test[picked[static_cast<std::size_t>(index)]];
    const Surface& garment = run.lessons.set->world.surface;
    const Points x = positions(body);
    Frame frame;
    frame.time = index;
    frame.x = x.cast<float>();
    frame.obstacles = {body.sample.body.cast<float>()};
    IntersectionCache own, theirs;
    const auto pairs = intersecting_pairs(garment, x, own, body.field->surface(), body.field->positions(), theirs);
    frame.obstacle_pairs = static_cast<int>(pairs.size());
    for (const auto& [triangle, other] : pairs) frame.bad_triangles.push_back(triangle);
    std::ranges::sort(frame.bad_triangles);
    frame.bad_triangles.erase(std::unique(frame.bad_triangles.begin(), frame.bad_triangles.end()),
                              frame.bad_triangles.end());
    return frame;
  };
  return view;
}

// A page of the named methods that the run has, and of the truth; none where there are fewer than two.
void write_method_page(const DrapeRun& run, std::initializer_list<const char*> names,
                       const std::filesystem::path& page) {
  constexpr std::size_t most_picked = 8, most_bytes = 12'000'000;
  std::vector<std::size_t> picked;
  const std::size_t count = run.lessons.test.size();
  for (std::size_t k = 0; k < std::min(count, most_picked); ++k)
    picked.push_back(k * count / std::min(count, most_picked));
  std::vector<ViewRun> views;
  const std::vector<MeasuredMethod> methods = measured_methods(run);
  for (const char* name : names)
    for (const MeasuredMethod& one : methods)
      if (one.method.name == name)
        views.push_back(view_of(
            run, name,
            [&run, one](DrapeBody& body) {
              return method_positions(one.method, *one.model, run.options, run.lessons, body);
            },
            picked));
  if (views.size() < 2) return;
  views.push_back(view_of(
      run, "truth", [](DrapeBody& body) { return body.sample.drape.truth; }, picked));
  write_view_page(views, page, {.limit = most_bytes});
}

std::string one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

}  // namespace

std::optional<MeasuredDrapes> measured_drapes(const ComparedDrapes& asked, const std::filesystem::path& views,
                                              std::ostream* log, const std::function<bool()>& stop) {
  const auto tell = [&](const std::string& line) {
    if (log) *log << asked.name << ": " << line << std::endl;
  };
  std::optional<DrapeRun> run;
  try {
    if (!std::filesystem::exists(asked.run))
      throw Error("there is no trained run", asked.run.string(), "train it: docs/repulsion.md");
    run = open_drape_run(asked.run);
  } catch (const Error& error) {
    MeasuredDrapes left_out{asked.name, one_line(error.what()), asked.use, asked.counted};
    tell("left out: " + left_out.trouble);
    return left_out;
  }
  MeasuredDrapes made = describe_drapes(asked, *run);
  for (const MeasuredMethod& one : measured_methods(*run)) {
    if (stop && stop()) return {};
    made.rows.push_back(measure_row(one.method, *one.model, run->options, run->lessons));
    tell("measured " + one.method.name);
  }
  make_folder(views);
  try {
    write_method_page(*run, {"control", "control, smooth", "collision_loss", "learned", "hybrid"},
                      views / (asked.name + ".html"));
    write_method_page(*run, {"fixed_approximate", "approximate", "hybrid"}, views / (asked.name + "_scales.html"));
  } catch (const Error& error) {
    tell(std::string("no page that shows it: ") + error.what());
  }
  return made;
}

}  // namespace selvedge
