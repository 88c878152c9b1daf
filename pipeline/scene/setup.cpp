#include "pipeline/scene/setup.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "physics/scene/make_scene.hpp"
#include "pipeline/host/bounds.hpp"
#include "pipeline/obstacles/setup_mesh.hpp"
#include "pipeline/obstacles/setup_motion.hpp"
#include "pipeline/obstacles/setup_obstacle.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/scene/config_scene.hpp"
#include "pipeline/scene/massless.hpp"
#include "pipeline/scene/quality.hpp"
#include "pipeline/scene/setup_cloth.hpp"
#include "pipeline/scene/setup_outcome.hpp"
#include "pipeline/scene/setup_seams.hpp"
#include "pipeline/scene/setup_springs.hpp"
#include "pipeline/scene/setup_start.hpp"
#include "pipeline/scene/setup_warnings.hpp"

namespace selvedge {
namespace {

struct PinnedVertex {
  int vertex;  // of the scene
  const PinPart* by = nullptr;
  int place = 0;  // among the part's vertices
};

// The world over time, kept by Setup::drive_at.
struct World {
  struct PinGroup {                 // pins that move together
    std::vector<int> rows, places;  // of them all; among what `at` gives
    std::function<Points(double time)> at;
  };
  int pin_count = 0;
  std::vector<PinGroup> pins;
  std::vector<std::function<Points(double time)>> obstacles;
  std::vector<std::function<BodyFrame(double time)>> bodies;  // one an obstacle; empty: it is none
  std::function<Points(double)> skinned_targets;              // empty: nothing is worn
  Vec3 gravity = Vec3::Zero();
  std::vector<double> wind_times;
  std::vector<Vec3> wind;
  Interpolation wind_interpolation = Interpolation::linear;
};

Drive drive(const World& world, double time) {
  Drive d;
  d.pins.resize(world.pin_count, 3);
  for (const World::PinGroup& group : world.pins)
    d.pins(group.rows, Eigen::all) = group.at(time)(group.places, Eigen::all);
  for (const auto& at : world.obstacles) d.obstacles.push_back(at(time));
  if (!world.wind.empty()) d.wind = keyed_vector(world.wind_times, world.wind, world.wind_interpolation, time);
  d.acceleration = world.gravity;
  if (world.skinned_targets) d.skinned_targets = world.skinned_targets(time);
  if (std::ranges::any_of(world.bodies, [](const auto& body) { return body != nullptr; }))
    for (const auto& body : world.bodies) d.bodies.push_back(body ? body(time) : BodyFrame{});
  return d;
}

// A member of every cloth, one below the other.
Points stacked(const std::vector<ClothPart>& parts, Points ClothPart::*rows) {
  Eigen::Index count = 0;
  for (const ClothPart& part : parts) count += (part.*rows).rows();
  Points all(count, 3);
  Eigen::Index first = 0;
  for (const ClothPart& part : parts) {
    all.middleRows(first, (part.*rows).rows()) = part.*rows;
    first += (part.*rows).rows();
  }
  return all;
}

void add_cloths(const std::vector<ClothPart>& parts, Scene& scene) {
  std::vector<NewCloth> cloths;
  for (const ClothPart& part : parts)
    cloths.push_back({part.rest, part.mesh.triangles, part.material, part.name, part.rest_triangle});
  add_cloths(scene, cloths);
  scene.rest_is_flat = parts.back().rest_is_flat;
}

// Vertices without mass cannot move freely: they stay where they are, unless they follow others.
PinPart massless(const Scene& scene, const Points& x, const std::vector<ClothPart>& parts,
                 std::vector<std::string>& warnings) {
  const Eigen::VectorXd masses = lumped_masses(scene);
  std::size_t followers = 0;
  for (const ClothPart& part : parts) followers += part.followers.size();
  PinPart held{"without mass", {}, {}};
  for (int v = 0; v < masses.size(); ++v)
    if (!(masses[v] > 0)) held.vertices.push_back(v);
  if (held.vertices.size() > followers)
    warnings.push_back(counted(std::ssize(held.vertices) - static_cast<std::ptrdiff_t>(followers),
                               "vertex without mass is held in place, and holds",
                               "vertices without mass are held in place, and hold") +
                       " nothing");
  held.at = [place = Points(x(held.vertices, Eigen::all))](double) { return place; };
  return held;
}

void add_pins(const std::vector<ClothPart>& parts, const PinPart& held, Scene& scene, World& world) {
  std::vector<PinnedVertex> all;
  const auto add = [&all](const PinPart& pin, int first) {
    for (std::size_t k = 0; k < pin.vertices.size(); ++k)
      all.push_back({first + pin.vertices[k], &pin, static_cast<int>(k)});
  };
  for (std::size_t c = 0; c < parts.size(); ++c)
    for (const PinPart& pin : parts[c].pins) add(pin, scene.cloths[c].first_vertex);
  add(held, 0);
  // The first pin that names a vertex keeps it.
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.vertex < b.vertex; });
  all.erase(std::unique(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.vertex == b.vertex; }),
            all.end());
  for (const PinnedVertex& pin : all) scene.pins.push_back(pin.vertex);
  world.pin_count = static_cast<int>(all.size());
  std::vector<const PinPart*> owners;
  for (std::size_t r = 0; r < all.size(); ++r) {
    const auto owner = std::find(owners.begin(), owners.end(), all[r].by);
    if (owner == owners.end()) world.pins.emplace_back().at = all[r].by->at;
    World::PinGroup& group = world.pins[static_cast<std::size_t>(owner - owners.begin())];
    if (owner == owners.end()) owners.push_back(all[r].by);
    group.rows.push_back(static_cast<int>(r));
    group.places.push_back(all[r].place);
  }
}

void read_wind(const Config& section, Wind& wind, World& world) {
  if (!section.given) return;
  wind = wind_options().read(section);
  wind.on = wind.air_density > 0 && (wind.drag > 0 || wind.lift > 0);
  world.wind_interpolation = read_interpolation(section["interpolation"]);
  const Config& keyframes = section["keyframes"];
  if (!keyframes.items.empty() && section["velocity"].given)
    section["velocity"].fail("is given beside keyframes", "give one of them");
  check_ascending_times(keyframes);
  for (const Config& key : keyframes.items) {
    world.wind_times.push_back(key["time"].number());
    world.wind.push_back(key["velocity"].vector());
  }
  if (keyframes.items.empty()) {
    world.wind_times = {0};
    world.wind = {section["velocity"].vector()};
  }
}

// What the scene file gives, over the defaults.
RunOptions read_run(const Config& scene) {
  RunOptions run = run_options().read(scene["run"]);
  read_options(output_options().rows, scene["output"], run);
  read_options(solver_options().rows, scene["solver"], run.conventional);
  run.icm.substeps = run.conventional.substeps;
  run.icm.max_substeps = run.conventional.max_substeps;
  run.icm.implicit_euler = run.conventional.implicit_euler;
  run.icm.substep = run.conventional.substep;
  return run;
}

// Adds the name of an item of a list to those that are taken.
void take_name(const Config& item, const std::string& name, std::vector<std::string>& taken) {
  if (std::find(taken.begin(), taken.end(), name) != taken.end())
    item.fail("has the name `" + name + "` of another", "give every one its own name");
  taken.push_back(name);
}

std::vector<ClothPart> read_all_cloths(Config& list, const std::filesystem::path& folder, const Performances& bodies,
                                       std::vector<std::string>& warnings) {
  if (list.items.empty()) list.fail("is empty", "give at least one cloth");
  std::vector<ClothPart> parts;
  std::vector<std::string> names;
  Eigen::Index vertices = 0;
  for (std::size_t c = 0; c < list.items.size(); ++c) {
    for (ClothPart& part : read_cloths(list.items[c], fmt::format("cloth{}", c), folder, bodies, warnings)) {
      take_name(list.items[c], part.name, names);
      vertices += part.mesh.x.rows();
      parts.push_back(std::move(part));
    }
    if (vertices > most_vertices || std::ssize(parts) > most_parts)
      list.items[c].fail(fmt::format("brings the scene to {} cloths of {} vertices; {} of {} are the most",
                                     parts.size(), vertices, most_parts, most_vertices),
                         "give fewer cloths, or coarser ones");
    const auto garment = std::ranges::find_if(parts, [](const ClothPart& part) { return part.worn != nullptr; });
    if (parts.back().worn && (parts.back().draping != garment->draping || parts.back().cut != garment->cut))
      list.items[c].fail("starts otherwise than the first garment", "give all garments of a scene the same `start`");
    if (parts.back().rest_is_flat != parts.front().rest_is_flat)
      list.items[c]["rest"]["flat"].fail("differs from the first cloth's", "all cloths of a scene rest alike");
  }
  return parts;
}

std::vector<ObstaclePart> read_all_obstacles(const Config& list, const std::filesystem::path& folder,
                                             const Performances& bodies, std::vector<std::string>& warnings) {
  std::vector<ObstaclePart> parts;
  std::vector<std::string> names;
  for (std::size_t o = 0; o < list.items.size(); ++o) {
    parts.push_back(bodies[o] ? obstacle_of(bodies[o]) : read_obstacle(list.items[o], o, folder, warnings));
    take_name(list.items[o], parts.back().obstacle.name, names);
    if (bodies[o])
      warn_of_extent(list.items[o], "body `" + parts.back().obstacle.name + "`", largest_body, false,
                     list.items[o]["scale"].number() * shaped(bodies[o]->body.skin, bodies[o]->shape),
                     bodies[o]->body.skin.triangles, warnings);
  }
  return parts;
}

// What the file puts into the world, each part by itself.
struct SceneParts {
  Performances bodies;
  std::vector<ClothPart> cloths;
  std::vector<ObstaclePart> obstacles;
  int begin_frame = 0;  // the scene's time begins here, before 0 where garments are to be draped
  std::vector<std::string> cloth_warnings, obstacle_warnings;
};

// The values of materials are written back into the configuration.
SceneParts read_parts(Config& config, const std::filesystem::path& folder, double fps) {
  SceneParts parts;
  parts.bodies = read_performances(config["obstacles"], folder);
  parts.cloths = read_all_cloths(config["cloths"], folder, parts.bodies, parts.cloth_warnings);
  for (const auto& who : parts.bodies) {
    if (!who) continue;
    const auto worn = [&](const ClothPart& part) { return part.worn && part.worn->by == who; };
    wear(static_cast<int>(std::ranges::count_if(parts.cloths, worn)), *who);
  }
  parts.begin_frame = -begin_draped(parts.bodies, fps, parts.cloths);
  for (const auto& who : parts.bodies)
    if (who) parts.obstacle_warnings.insert(parts.obstacle_warnings.end(), who->warnings.begin(), who->warnings.end());
  parts.obstacles = read_all_obstacles(config["obstacles"], folder, parts.bodies, parts.obstacle_warnings);
  return parts;
}

// The parts as one scene, numbered on end, and the world over time.
struct JoinedScene {
  Scene scene;
  std::function<Drive(double time)> drive_at;
  Drive start;  // the world when the scene's time begins
  Points x;     // the cloths then, pins where they are held
  std::vector<Follower> followers;
  std::vector<std::string> warnings;
};

JoinedScene join_scene(const Config& config, const SceneParts& parts, double begin_time) {
  JoinedScene joined;
  Scene& scene = joined.scene;
  const auto world = std::make_shared<World>();
  joined.warnings = parts.cloth_warnings;
  scene.contact = contact_options().read(config["contact"]);
  add_cloths(parts.cloths, scene);
  joined.x = stacked(parts.cloths, &ClothPart::first);
  add_pins(parts.cloths, massless(scene, joined.x, parts.cloths, joined.warnings), scene, *world);
  joined.followers = followers_of(parts.cloths, scene);
  joined.warnings.insert(joined.warnings.end(), parts.obstacle_warnings.begin(), parts.obstacle_warnings.end());
  for (const ObstaclePart& part : parts.obstacles) {
    scene.obstacles.push_back(part.obstacle);
    world->obstacles.push_back(part.at);
    world->bodies.push_back(part.body);
  }
  world->gravity = config["gravity"].vector();
  read_wind(config["wind"], scene.wind, *world);
  warn_of_storm(world->wind, joined.warnings);
  warn_of_thickness(scene, joined.warnings);
  joined.start = drive(*world, begin_time);
  for (std::size_t k = 0; k < joined.start.obstacles.size(); ++k)
    refuse_far(config["obstacles"].items[k], "obstacle `" + scene.obstacles[k].name + "`", joined.start.obstacles[k]);
  warn_of_rounding(scene, joined.x, joined.start.obstacles, joined.warnings);
  for (std::size_t p = 0; p < scene.pins.size(); ++p)
    joined.x.row(scene.pins[p]) = joined.start.pins.row(static_cast<Eigen::Index>(p));
  warn_of_pins_inside(parts.cloths, scene, joined.x, joined.start.obstacles, joined.warnings);
  warn_of_stretched_seams(parts.cloths, scene, joined.x, joined.warnings);
  scene.springs = read_springs(config["springs"], parts.cloths, scene, joined.x, joined.warnings);
  world->skinned_targets = skinned_targets_of(parts.cloths, scene);
  joined.drive_at = [world](double time) { return drive(*world, time); };
  return joined;
}

// The garments on their bodies when the scene's time begins. One that is not on its body is warned of, and not watched.
std::vector<WornCloth> worn_cloths(const SceneParts& parts, const JoinedScene& joined, double begin_time,
                                   std::vector<std::string>& warnings) {
  std::vector<WornCloth> all;
  for (std::size_t c = 0; c < parts.cloths.size(); ++c) {
    const auto& worn = parts.cloths[c].worn;
    if (!worn || worn->garment.skin.rest.rows() == 0) continue;
    const auto o = static_cast<std::size_t>(
        std::ranges::find_if(parts.bodies, [&](const auto& who) { return who == worn->by; }) - parts.bodies.begin());
    WornWatch watch{parts.cloths[c].name, parts.obstacles[o].obstacle.name, {}};
    watch.part = worn_part(skinned_at(*worn, begin_time), joined.start.obstacles[o]);
    if (watch.part.places.empty())
      warnings.push_back(
          fmt::format("garment `{}` is not worn: hardly a vertex lies on its body `{}`, so that it is "
                      "not known whether it leaves it",
                      watch.garment, watch.body));
    else
      all.push_back({static_cast<int>(c), static_cast<int>(o), std::move(watch)});
  }
  return all;
}

// The state when the scene's time begins, with the velocity of time 0.
State begin_state(const SceneParts& parts, const JoinedScene& joined, double begin_time) {
  State state = first_state(joined.scene, joined.x, joined.start.obstacles);
  state.frame = parts.begin_frame;
  state.time = begin_time;
  state.v = stacked(parts.cloths, &ClothPart::velocity);
  for (const int pin : joined.scene.pins) state.v.row(pin).setZero();
  begin_cut(parts.cloths, joined.scene, state);
  return state;
}

}  // namespace

Setup read_setup(const std::filesystem::path& file, const std::vector<std::string>& overrides, const Kinds& kinds) {
  Setup setup;
  setup.table = scene_table(kinds);
  Config config = read_config(file, setup.table->scene, overrides);
  setup.file = file;
  setup.quality = set_quality(config);
  setup.run = read_run(config);
  const std::filesystem::path folder = files_folder(config, file);
  if (Config& given = config["folder"]; given.given) {  // the text of the setup may be kept anywhere
    given.words = {std::filesystem::absolute(folder).lexically_normal().string()};
    for (std::string* weights : {&setup.run.learned.weights, &setup.run.refu.weights})
      if (!weights->empty()) *weights = std::filesystem::absolute(folder / *weights).string();
  }
  setup.kind = *kinds.find(setup.run.stepper);
  if (setup.kind.options) setup.kind_options = config["run"][setup.kind.name];
  if (setup.kind.check) setup.kind.check(config);
  setup.networks = std::make_shared<std::map<std::filesystem::path, WeightFile>>();
  const SceneParts parts = read_parts(config, folder, setup.run.fps);
  const double begin_time = parts.begin_frame / setup.run.fps;
  JoinedScene joined = join_scene(config, parts, begin_time);
  setup.initial = begin_state(parts, joined, begin_time);
  setup.worn = worn_cloths(parts, joined, begin_time, joined.warnings);
  setup.velocity = setup.initial.v;
  if (parts.begin_frame < 0) setup.initial.v.setZero();
  setup.scene = std::move(joined.scene);
  setup.drive_at = std::move(joined.drive_at);
  setup.followers = std::move(joined.followers);
  setup.warnings = std::move(joined.warnings);
  warn_of_fast_pins(parts.cloths, setup.run.fps, setup.run.frames, setup.warnings);
  for (const ObstaclePart& part : parts.obstacles)
    if (part.ends)
      warn_of_end("the motion of obstacle `" + part.obstacle.name + "`", *part.ends, setup.run.fps, setup.run.frames,
                  setup.warnings);
  if (std::ranges::any_of(parts.cloths, &ClothPart::cut))
    setup.prepared =
        fmt::format("cut: {} of {} triangles out", setup.initial.cut_out.size(), setup.scene.surface.triangles.rows());
  for (const auto& who : parts.bodies) setup.bodies.push_back(who ? who->known : nullptr);
  if (std::ranges::any_of(parts.cloths, [](const ClothPart& part) { return !part.mesh.look.empty(); }))
    for (const ClothPart& part : parts.cloths) setup.looks.push_back(part.mesh.look);
  setup.outcomes = read_outcomes(config["outcome"], parts.cloths, setup.scene);
  setup.short_form = config["short_form"].words;
  setup.config = to_yaml(config);
  return setup;
}

}  // namespace selvedge
