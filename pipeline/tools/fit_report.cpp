#include "pipeline/tools/fit_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "collision/geometry/error.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/scene/config_scene.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/view/view.hpp"

namespace selvedge {
namespace {

std::string listed_names(const std::vector<TrajectoryInfo::Body>& obstacles) {
  return obstacles.empty() ? "none" : joined(names_of(obstacles));
}

// The obstacle that the cloth should fit.
std::size_t obstacle_to_fit(const FitRequest& request, const TrajectoryInfo& info, const Performances& bodies) {
  const auto& obstacles = info.obstacles;
  for (std::size_t k = 0; k < obstacles.size(); ++k)
    if (request.body.empty() ? bodies[k] != nullptr : obstacles[k].name == request.body) return k;
  if (request.body.empty() && obstacles.size() == 1) return 0;
  if (request.body.empty())
    throw Error("the run has no body, and not exactly one obstacle", request.run.string(),
                "name one with --body; obstacles: " + listed_names(obstacles));
  throw Error("names the unknown obstacle `" + request.body + "`", "--body", "obstacles: " + listed_names(obstacles));
}

int frame_to_measure(const FitRequest& request, int count) {
  if (count < 1) throw Error("the run has no full frame", request.run.string(), "wait for its first frame");
  if (request.frame < -1 || request.frame >= count)
    throw Error(fmt::format("frame {} is not in the run", request.frame), "--frame",
                fmt::format("0 to {}, or leave it out for the last", count - 1));
  return request.frame < 0 ? count - 1 : request.frame;
}

void check_same_cloth(const Scene& scene, const TrajectoryInfo& info, const std::filesystem::path& file) {
  const bool cloth = scene.surface.vertex_count == static_cast<int>(info.rest.rows()) &&
                     scene.surface.triangles.rows() == info.triangles.rows() &&
                     scene.surface.triangles == info.triangles;
  bool obstacles = scene.obstacles.size() == info.obstacles.size();
  for (std::size_t k = 0; obstacles && k < scene.obstacles.size(); ++k)
    obstacles = scene.obstacles[k].surface.vertex_count == info.obstacles[k].vertex_count;
  if (!cloth || !obstacles)
    throw Error("the scene has other cloths or obstacles than the run", file.string(),
                "name the scene that the run was made of with --scene");
}

std::filesystem::path scene_file(const FitRequest& request) {
  if (!request.scene.empty()) return request.scene;
  const auto folder = std::filesystem::is_directory(request.run) ? request.run : request.run.parent_path();
  if (std::filesystem::exists(folder / "config.yaml")) return folder / "config.yaml";
  throw Error("there is no config.yaml beside it with the materials of the cloth", request.run.string(),
              "name the scene that the run was made of with --scene");
}

// The ease per vertex [mm]: that of its row, or NaN.
std::vector<float> ease_by_vertex(const FitMeasures& measures) {
  std::vector<float> values;
  for (const int row : measures.row) {
    const std::optional<double> ease = row < 0 ? std::nullopt : measures.rows[static_cast<std::size_t>(row)].ease;
    values.push_back(ease ? static_cast<float>(1e3 * *ease) : std::numeric_limits<float>::quiet_NaN());
  }
  return values;
}

ViewMap map_of(const std::string& name, const std::string& unit, std::vector<float> values, bool from_zero) {
  std::vector<float> known;
  for (const float value : values)
    if (std::isfinite(value)) known.push_back(value);
  std::ranges::sort(known);
  ViewMap map{name, unit, 0, 1, std::move(values)};
  if (known.empty()) return map;
  map.low = from_zero ? 0 : known.front();
  map.high =
      std::max<double>(map.low + 1e-6, known[static_cast<std::size_t>(0.98 * static_cast<double>(known.size() - 1))]);
  return map;
}

std::vector<float> scaled(const Eigen::VectorXd& values, double by) {
  std::vector<float> all;
  for (const double value : values) all.push_back(static_cast<float>(by * value));
  return all;
}

const std::vector<std::string>& titles() {
  static const std::vector<std::string> names = {"region",   "cloth",      "ease mm",   "least mm",    "gap mm",
                                                 "strain %", "99 % below", "touches %", "pressure Pa", "99 % below"};
  return names;
}

std::vector<std::string> cells(const FitRow& row) {
  const auto number = [](const std::optional<double>& value, double by) {
    return value ? fmt::format("{:.1f}", by * *value) : std::string("-");
  };
  return {row.region,
          row.cloth,
          number(row.ease, 1e3),
          number(row.least_ease, 1e3),
          number(row.gap, 1e3),
          number(row.strain, 100),
          number(row.strain_99, 100),
          fmt::format("{:.0f}", 100 * row.contact),
          number(row.pressure, 1),
          number(row.pressure_99, 1)};
}

void write_fit_page(const FitRequest& request, const FitReport& report, ViewRun run) {
  const FitMeasures& found = report.measures;
  run.frame_count = 1;
  run.frame = [frame = run.frame, index = report.frame](int) { return frame(index); };
  run.maps = {map_of("ease", "mm", ease_by_vertex(found), false), map_of("gap", "mm", scaled(found.gap, 1e3), true),
              map_of("strain", "%", scaled(found.strain, 100), true),
              map_of("pressure", "Pa", scaled(found.pressure, 1), true)};
  run.table.titles = titles();
  for (const FitRow& row : found.rows) run.table.rows.push_back(cells(row));
  write_view_page({run}, request.out);
}

}  // namespace

FitReport fit(const FitRequest& request) {
  const ViewRun run = open_view_run(request.run);
  FitReport report;
  report.run = run.name;
  report.frame = frame_to_measure(request, run.frame_count);
  const std::filesystem::path file = scene_file(request);
  const Setup setup = read_setup(file);
  check_same_cloth(setup.scene, run.info, file);
  const Config config = read_config(file, scene_section());
  const Performances bodies = read_performances(config["obstacles"], files_folder(config, file));
  const std::size_t k = obstacle_to_fit(request, run.info, bodies);
  report.body = run.info.obstacles[k].name;

  const Frame frame = run.frame(report.frame);
  report.time = frame.time;
  const Points x = frame.x.cast<double>(), body_x = frame.obstacles[k].cast<double>();
  if (!x.allFinite() || !body_x.allFinite())
    throw Error(fmt::format("frame {} has positions that are not finite", report.frame), request.run.string(),
                "choose another --frame");
  const Drive drive = setup.drive_at(frame.time);
  FitRegions regions;
  if (!request.regions.empty()) {
    regions = regions_of_file(request.regions, body_x);
    report.regions = request.regions.filename().string();
  } else if (bodies[k]) {
    regions = regions_by_weights(bodies[k]->body, drive.bodies[k].joints);
    report.regions = "joints";
  } else {
    regions = whole_body(body_x);
    report.regions = "whole";
  }
  const double reach = request.reach > 0 ? request.reach : 2 * setup.scene.contact.thickness;
  report.measures =
      measure_fit(setup.scene, x, drive.acceleration, setup.scene.obstacles[k].surface, body_x, regions, reach);
  if (!request.out.empty()) write_fit_page(request, report, run);
  return report;
}

std::string fit_text(const FitReport& report) {
  std::string text = fmt::format("{} on {}, frame {} at {:.3g} s, regions by {}\n", report.run, report.body,
                                 report.frame, report.time, report.regions);
  std::vector<std::vector<std::string>> table = {titles()};
  for (const FitRow& row : report.measures.rows) table.push_back(cells(row));
  std::vector<std::size_t> widths(titles().size(), 0);
  for (const auto& line : table)
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  for (const auto& line : table) {
    for (std::size_t c = 0; c < line.size(); ++c)
      text += c < 2 ? fmt::format("{:<{}}  ", line[c], widths[c]) : fmt::format("{:>{}}  ", line[c], widths[c]);
    text += "\n";
  }
  return text;
}

std::string fit_json(const FitReport& report) {
  Json rows = Json::array();
  for (const FitRow& row : report.measures.rows)
    rows.push_back({{"region", row.region},
                    {"cloth", row.cloth},
                    {"vertices", row.vertices},
                    {"area", row.area},
                    {"ease", number_or_null(row.ease)},
                    {"least_ease", number_or_null(row.least_ease)},
                    {"gap", row.gap},
                    {"strain", row.strain},
                    {"strain_99", row.strain_99},
                    {"contact", row.contact},
                    {"pressure", number_or_null(row.pressure)},
                    {"pressure_99", number_or_null(row.pressure_99)}});
  const Json json = {{"run", report.run},   {"body", report.body},       {"frame", report.frame},
                     {"time", report.time}, {"regions", report.regions}, {"rows", rows}};
  return json_text(json);
}

}  // namespace selvedge
