#include "pipeline/tools/check_measures.hpp"

#include <algorithm>

#include "collision/exact/penetration_depth.hpp"
#include "collision/geometry/error.hpp"
#include "learned/steppers/learned_scene.hpp"
#include "physics/energies/measures.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/measures/published_measures.hpp"
#include "pipeline/measures/run_measures.hpp"

namespace selvedge {
namespace {

// A scene with the trajectory's cloths, rest shape and obstacles, and with HOOD's material.
Scene scene_of(const TrajectoryInfo& info) {
  Scene scene;
  scene.surface = make_surface(static_cast<int>(info.rest.rows()), info.triangles);
  scene.rest = info.rest;
  scene.rest_triangle = info.rest_triangle;
  scene.pins = info.pins;
  Cloth cloth;
  cloth.material = isotropic_material(VertexMaterial{});
  cloth.vertex_count = scene.surface.vertex_count;
  cloth.triangle_count = static_cast<int>(info.triangles.rows());
  scene.cloths.push_back(cloth);
  for (const TrajectoryInfo::Body& body : info.obstacles)
    scene.obstacles.push_back({body.name, make_surface(body.vertex_count, body.triangles), body.moving});
  return scene;
}

struct MeasuredPositions {
  Points x, body;
  Audit found;
  double depth = 0;
};

MeasuredPositions positions_of(const Scene& scene, const Frame& frame) {
  MeasuredPositions at;
  at.x = frame.x.cast<double>();
  std::vector<Points> bodies;
  for (const PointsF& obstacle : frame.obstacles) bodies.push_back(obstacle.cast<double>());
  std::vector<AuditBody> audited;
  for (std::size_t k = 0; k < bodies.size(); ++k) audited.push_back({&scene.obstacles[k].surface, &bodies[k]});
  at.found = audit(scene.surface, at.x, audited);
  for (std::size_t k = 0; at.found.inside_vertices > 0 && k < bodies.size(); ++k)
    at.depth = std::max(at.depth, penetration_depth(scene.obstacles[k].surface, bodies[k], at.x));
  at.body = joined_rows(bodies);
  return at;
}

}  // namespace

std::map<std::string, double> measures_against(const std::filesystem::path& run,
                                               const std::filesystem::path& reference) {
  const TrajectoryReader mine(run), theirs(reference);
  if (mine.info().triangles.rows() != theirs.info().triangles.rows() ||
      (mine.info().triangles.array() != theirs.info().triangles.array()).any())
    throw Error("the reference has other triangles than the run", reference.string(),
                "give a run of the same cloths, resolved alike");
  const int frames = std::min(mine.frame_count(), theirs.frame_count());
  if (frames < 2) throw Error("there is no frame to compare", run.string(), "give runs of one frame at least");
  const Scene scene = scene_of(mine.info());
  const Eigen::VectorXd masses = lumped_masses(scene);
  RunMeasures measures(scene, frames - 1, 0);
  const MeasuredPositions start = positions_of(scene, mine.frame(0));
  measures.begin(start.x, start.body, static_cast<int>(start.found.self_pairs.size()));
  Points before = start.x;
  double l2 = 0, relative = 0;
  for (int i = 1; i < frames; ++i) {
    MeasuredPositions at = positions_of(scene, mine.frame(i));
    const Points other = theirs.frame(i).x.cast<double>();
    l2 += l2_mm(at.x, other);
    relative += e3d(at.x, other);
    MeasuredFrame frame;
    frame.acceleration = Points::Zero(at.x.rows(), 3);
    frame.acceleration.col(1).setConstant(-9.81);
    frame.pairs = static_cast<int>(at.found.self_pairs.size());
    frame.meets_body = !at.found.obstacle_pairs.empty() || at.found.inside_vertices > 0;
    frame.depth = at.depth;
    frame.kinetic = 0.5 * masses.dot(((at.x - before) * mine.info().fps).rowwise().squaredNorm());
    before = at.x;
    frame.x = std::move(at.x);
    frame.body = std::move(at.body);
    measures.add(std::move(frame));
  }
  std::map<std::string, double> values = measures.values();
  values["l2_mm"] = l2 / (frames - 1);
  values["e3d"] = relative / (frames - 1);
  return values;
}

}  // namespace selvedge
