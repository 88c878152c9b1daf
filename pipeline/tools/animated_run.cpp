#include "pipeline/tools/animated_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numeric>
#include <set>

#include "collision/geometry/box_diagonal.hpp"
#include "collision/geometry/error.hpp"
#include "collision/geometry/same_places.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/config/config_units.hpp"
#include "pipeline/exports/driven_mesh.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/mesh_mtl.hpp"
#include "pipeline/formats/polygon.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"

namespace selvedge {
namespace {

std::string file_name(const std::string& name) {
  std::string safe = name;
  for (char& c : safe)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
  return safe;
}

// The colours of the page (pipeline/view/palette.js) in linear form; there they are sRGB.
Eigen::Vector3d colour_of(int cloth) {
  constexpr std::array<std::array<int, 3>, 5> colours = {
      {{0x4a, 0x7f, 0xb5}, {0xc9, 0x8a, 0x5a}, {0x5d, 0x9c, 0x84}, {0x8d, 0x76, 0xb3}, {0xb9, 0xbd, 0xc2}}};
  const auto& srgb = cloth < 0 ? colours.back() : colours[static_cast<std::size_t>(cloth % 4)];
  Eigen::Vector3d linear;
  for (int k = 0; k < 3; ++k) {
    const double c = srgb[static_cast<std::size_t>(k)] / 255.0;
    linear[k] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return linear;
}

// Positions of a surface, by those of all cloths.
using PositionsOf = std::function<PointsF(const PointsF& all)>;

// Those of vertices by their numbers in the run.
PositionsOf rows_of_run(std::vector<int> rows) {
  return [rows = std::move(rows)](const PointsF& all) -> PointsF { return all(rows, Eigen::all); };
}

// Gives a surface the vertices and faces of its file; x: positions of the file's vertices, to cut polygons.
void show(const Look& look, const Points& x, AnimatedSurface& surface) {
  surface.look = look;
  surface.vertex_count = static_cast<int>(x.rows());
  surface.cut = cut_polygons(x, look.corners, look.begin);
  surface.triangles = surface.cut.unaryExpr([&](int corner) { return look.corners[static_cast<std::size_t>(corner)]; });
}

struct ClothSource {
  AnimatedSurface surface;
  PositionsOf positions;
};

// A run in the making.
class RunSurfaces {
 public:
  explicit RunSurfaces(const ExportRequest& request)
      : request_(request), reader_(std::make_shared<TrajectoryReader>(request.trajectory)), looks_(reader_->looks()) {
    if (reader_->frame_count() < 1)
      throw Error("the run has no full frame", request.trajectory.string(), "wait for its first frame");
  }

  AnimatedRun made() {
    if (!request_.onto.empty()) add_driven();
    for (int c = 0; c < cloths(); ++c)
      if (!is_driver(c) && info().cloth_first_triangle[c] < info().cloth_first_triangle[c + 1]) add_cloth(c);
    name_files();
    AnimatedRun run;
    run.surfaces.fps = info().fps;
    run.surfaces.frame_count = reader_->frame_count();
    std::vector<PositionsOf> positions;
    for (ClothSource& cloth : sources_) {
      run.surfaces.surfaces.push_back(std::move(cloth.surface));
      positions.push_back(std::move(cloth.positions));
    }
    for (std::size_t k = 0; request_.obstacles && k < info().obstacles.size(); ++k) {
      const TrajectoryInfo::Body& body = info().obstacles[k];
      const std::string name = fmt::format("obstacle_{}_{}", k, file_name(body.name));
      run.surfaces.surfaces.push_back(
          {name, body.triangles, body.vertex_count, false, body.moving, colour_of(-1), name});
    }
    run.surfaces.frame = [reader = reader_, positions, obstacles = request_.obstacles, progress = request_.progress,
                          reads = run.reads, done = std::make_shared<int>(0)](int index) {
      check_stop();
      Frame frame = reader->frame(index);
      std::vector<PointsF> all;
      for (const PositionsOf& one : positions) all.push_back(one(frame.x));
      if (obstacles) std::ranges::move(frame.obstacles, std::back_inserter(all));
      if (progress) progress(++*done, *reads);
      return all;
    };
    return run;
  }

 private:
  const TrajectoryInfo& info() const { return reader_->info(); }
  int cloths() const { return static_cast<int>(info().cloth_names.size()); }
  bool is_driver(int cloth) const {
    return !request_.onto.empty() && (request_.cloth.empty() || info().cloth_names[cloth] == request_.cloth);
  }
  Triangles triangles_of(int cloth) const {
    const int first = info().cloth_first_triangle[cloth];
    return info().triangles.middleRows(first, info().cloth_first_triangle[cloth + 1] - first);
  }
  // The cloth's own vertices, and behind them those of others to which seams join its triangles.
  std::vector<int> rows_of(int cloth) const {
    std::vector<int> rows(static_cast<std::size_t>(info().cloth_first_vertex[cloth + 1] - first_of(cloth)));
    std::iota(rows.begin(), rows.end(), first_of(cloth));
    std::set<int> others;
    const Triangles triangles = triangles_of(cloth);
    for (const int v : triangles.reshaped())
      if (v < first_of(cloth) || v >= info().cloth_first_vertex[cloth + 1]) others.insert(v);
    rows.insert(rows.end(), others.begin(), others.end());
    return rows;
  }
  int first_of(int cloth) const { return info().cloth_first_vertex[cloth]; }
  // By the numbers of the run.
  std::vector<int> look_rows(int cloth) const {
    std::vector<int> rows = looks_[static_cast<std::size_t>(cloth)].vertex;
    for (int& v : rows) v += first_of(cloth);
    return rows;
  }

  void add_cloth(int c) {
    ClothSource& cloth = sources_.emplace_back();
    cloth.surface.name = info().cloth_names[c];
    cloth.surface.colour = colour_of(c);
    const Look& look = looks_[static_cast<std::size_t>(c)];
    if (!look.empty()) {
      show(look, info().rest(look_rows(c), Eigen::all), cloth.surface);
      cloth.positions = rows_of_run(look_rows(c));
      return;
    }
    const std::vector<int> rows = rows_of(c);
    const int own = info().cloth_first_vertex[c + 1] - first_of(c);
    cloth.surface.vertex_count = static_cast<int>(rows.size());
    cloth.surface.triangles = triangles_of(c).unaryExpr([&](int v) {
      const bool others = v < first_of(c) || v >= first_of(c) + own;
      return others ? static_cast<int>(std::lower_bound(rows.begin() + own, rows.end(), v) - rows.begin())
                    : v - first_of(c);
    });
    cloth.positions = rows_of_run(rows);
  }

  // The vertices of the run at the places of the mesh's, if its file is that of the cloths.
  std::vector<int> same_vertices(const std::vector<int>& drivers, const Mesh& mesh, double size) const {
    std::vector<std::vector<int>> candidates(1);
    for (const int c : drivers) {
      const std::vector<int> own = rows_of(c);
      candidates[0].insert(candidates[0].end(), own.begin(), own.end());
      candidates.push_back(look_rows(c));
    }
    for (std::vector<int>& rows : candidates)
      if (std::ssize(rows) == mesh.x.rows() &&
          (info().rest(rows, Eigen::all) - mesh.x).rowwise().norm().maxCoeff() < 1e-5 * size)
        return std::move(rows);
    return {};
  }

  PositionsOf bound(const std::vector<int>& drivers, double size, Mesh& mesh) const {
    Triangles triangles(0, 3);
    for (const int c : drivers) {
      const Triangles own = triangles_of(c);
      triangles.conservativeResize(triangles.rows() + own.rows(), 3);
      triangles.bottomRows(own.rows()) = own;
    }
    if (triangles.rows() == 0) throw Error("has no triangles", "--cloth " + request_.cloth, "name another cloth");
    Binding binding = bound_to(info().rest, triangles, mesh.x);
    constexpr double far = 0.05;  // of the cloths' size, as mean distance
    if (!(binding.mean_distance < far * size))
      throw Error(fmt::format("lies {:.3g} m from the rest shape of the cloth on average", binding.mean_distance),
                  "--onto " + request_.onto.string(),
                  "give the mesh where the cloth's own file has it, its unit by --onto-unit, its cloth by --cloth");
    mesh.look.vertex = same_places(mesh.x);
    return [binding = std::move(binding)](const PointsF& all) { return driven(binding, all); };
  }

  double onto_metres() const {
    try {
      return metres_per_unit(request_.onto_unit);
    } catch (const Error& error) {
      throw Error(error.problem(), "--onto-unit", error.cure());
    }
  }

  void add_driven() {
    if (!request_.cloth.empty() && std::ranges::find(info().cloth_names, request_.cloth) == info().cloth_names.end())
      throw Error("is no cloth of the run", "--cloth " + request_.cloth,
                  "cloths: " + joined(info().cloth_names) + suggestion(request_.cloth, info().cloth_names));
    Mesh mesh = read_mesh(request_.onto);
    read_materials(mesh);
    mesh.x *= onto_metres();
    std::vector<int> drivers, rows;
    for (int c = 0; c < cloths(); ++c)
      if (is_driver(c)) drivers.push_back(c);
    for (const int c : drivers)
      for (const int v : rows_of(c)) rows.push_back(v);
    const Points rest = info().rest(rows, Eigen::all);
    const double size = box_diagonal(rest);
    ClothSource& cloth = sources_.emplace_back();
    cloth.surface.name = request_.onto.stem().string();
    cloth.surface.colour = colour_of(drivers.empty() ? 0 : drivers[0]);
    rows = same_vertices(drivers, mesh, size);
    if (rows.empty()) {
      cloth.positions = bound(drivers, size, mesh);
    } else {
      mesh.look.vertex = rows;
      cloth.positions = rows_of_run(rows);
    }
    cloth.surface.triangles = mesh.triangles;
    cloth.surface.vertex_count = static_cast<int>(mesh.x.rows());
    if (!mesh.look.empty()) show(mesh.look, mesh.x, cloth.surface);
    for (const std::string& warning : mesh.warnings)
      if (request_.warn) request_.warn(warning);
  }

  // One cloth alone has the files `cloth`; several are named after themselves.
  void name_files() {
    std::set<std::string> taken;
    for (ClothSource& cloth : sources_) {
      const std::string name = sources_.size() == 1 ? "cloth" : file_name(cloth.surface.name);
      cloth.surface.file = name;
      for (int k = 1; !taken.insert(cloth.surface.file).second; ++k) cloth.surface.file = fmt::format("{}_{}", name, k);
    }
  }

  const ExportRequest& request_;
  std::shared_ptr<TrajectoryReader> reader_;
  std::vector<Look> looks_;
  std::vector<ClothSource> sources_;
};

}  // namespace

AnimatedRun animated_run(const ExportRequest& request) { return RunSurfaces(request).made(); }

}  // namespace selvedge
