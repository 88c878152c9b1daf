#include "pipeline/training/training_roll.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collision/search/intersections.hpp"
#include "collision/untangle/untangle.hpp"
#include "learned/losses/force_input.hpp"
#include "learned/steppers/learned_scene.hpp"
#include "learned/steppers/learned_state.hpp"
#include "physics/recovery/cut_out.hpp"
#include "pipeline/scene/setup_cloth.hpp"
#include "pipeline/training/hung_sheet.hpp"
#include "pipeline/training/simulate_frames.hpp"
#include "pipeline/training/teacher_step.hpp"

namespace selvedge {
namespace {

// Separate random streams for the uses of one number.
enum Use : std::uint64_t { drawing = 1, start_noise = 2, material_draw = 3, place = 4 };

RandomStream stream_for(std::uint64_t seed, Use use, std::uint64_t number) { return stream_of(seed * 8 + use, number); }

void add_cloth_part(const std::string& name, Points rest, Triangles own, const std::vector<int>& pins, bool mirrored,
                    const Material& material, Scene& scene, Triangles& triangles) {
  if (mirrored) {
    rest.col(0) *= -1;
    own.col(1).swap(own.col(2));
  }
  const auto v = static_cast<int>(scene.rest.rows()), t = static_cast<int>(triangles.rows());
  scene.cloths.push_back({name, material, v, static_cast<int>(rest.rows()), t, static_cast<int>(own.rows())});
  const std::vector<RestTriangle> flat = flattened(rest, own, Vec3(0, 1, 0));
  scene.rest_triangle.insert(scene.rest_triangle.end(), flat.begin(), flat.end());
  scene.rest.conservativeResize(v + rest.rows(), 3);
  scene.rest.bottomRows(rest.rows()) = rest;
  triangles.conservativeResize(t + own.rows(), 3);
  triangles.bottomRows(own.rows()) = own.array() + v;
  for (const int pin : pins) scene.pins.push_back(v + pin);
}

VertexMaterial mixed(const MaterialDraw& draw, double part) {
  if (draw.one == draw.other) return draw.one;
  const auto plain = [&](double a, double b) { return a + part * (b - a); };
  const auto by_logarithm = [&](double a, double b) { return std::exp(plain(std::log(a), std::log(b))); };
  return {plain(draw.one.density, draw.other.density), by_logarithm(draw.one.lame_mu, draw.other.lame_mu),
          plain(draw.one.lame_lambda, draw.other.lame_lambda), by_logarithm(draw.one.bending, draw.other.bending)};
}

void add_materials(const MaterialDraw& draw, const Points& rest, std::vector<VertexMaterial>& materials) {
  const Eigen::VectorXd along = rest * draw.direction;
  const double low = along.minCoeff(), length = along.maxCoeff() - low;
  for (const double at : along) materials.push_back(mixed(draw, length > 0 ? (at - low) / length : 0));
}

// Adds graph and losses to a scene with cloths, rest shape and pins.
std::shared_ptr<const TrainingScene> with_graph(const RollMaker& maker, const RollRequest& request,
                                                const Triangles& triangles, std::shared_ptr<TrainingScene> made) {
  Scene& scene = made->scene;
  scene.surface = make_surface(static_cast<int>(scene.rest.rows()), triangles);
  made->graph = learned_scene(scene).graph;
  std::vector<char> pinned(static_cast<std::size_t>(scene.surface.vertex_count), 0);
  for (const int pin : scene.pins) pinned[static_cast<std::size_t>(pin)] = 1;
  const std::vector<VertexMaterial>& materials = made->materials;
  made->losses = make_loss_garment(scene.surface, scene.rest, pinned, materials.front());
  if (std::ranges::any_of(materials, [&](const VertexMaterial& m) { return m != materials.front(); })) {
    set_materials(made->losses, materials);
    made->graph.materials = material_inputs(materials);
    made->graph.mass = made->losses.mass;
  }
  set_springs(scene.springs, made->losses);
  made->rest = make_rest_graph(made->graph, maker.features);
  if (maker.features.guess_inputs) made->elastic = make_elastic(scene);
  if (request.sheet != HungStart::none)
    made->losses.closed = close_surface(scene.surface, {}, scene.pins);  // it has no inside
  return made;
}

// Mirrors x at x = 0, then turns it about the vertical, as the request says.
void turn(const RollRequest& request, PointsF& x) {
  if (request.mirrored) x.col(0) *= -1;
  if (request.yaw == 0) return;
  const Eigen::Matrix3f rotation =
      Eigen::AngleAxisd(request.yaw, Vec3::UnitY()).toRotationMatrix().cast<float>().transpose();
  x = (x * rotation).eval();
}

// Noise on the coordinates of free vertices.
Points start_noise_of(const TrainingOptions& options, const Roll& roll) {
  RandomStream random = stream_for(options.seed, start_noise, roll.request.number);
  const double deviation = roll.request.noise > 0 ? roll.request.noise : options.samples.noise;
  Points noise(roll.cloth[1].rows(), 3);
  for (Eigen::Index i = 0; i < noise.size(); ++i) noise.data()[i] = deviation * random.normal();
  for (const int pin : roll.scene->rest.pinned) noise.row(pin).setZero();
  return noise;
}

// Sets the start: folded, or with noise, or untangled without noise, which would tangle it again.
void set_start(const TrainingOptions& options, Roll& roll) {
  if (roll.request.sheet == HungStart::folded) {
    RandomStream fold = stream_for(options.seed, place, roll.request.number);
    PointsF start = folded(hung_sheet(options.samples.edge).rest, fold).cast<float>();
    turn(roll.request, start);
    roll.start = start.cast<double>();
    return;
  }
  roll.start = roll.cloth[1].cast<double>();
  if (options.samples.start != GarmentStart::untangle || !roll.request.cloth_contact) {
    roll.start += start_noise_of(options, roll);
    return;
  }
  // Tangles that come apart do so soon; the others would take most of the time.
  UntangleOptions untangling;
  untangling.iterations = 60;
  untangling.patience = 15;
  untangling.second_rule = false;
  const UntangleResult parted = untangle(roll.scene->scene.surface, roll.start, {}, untangling);
  roll.usable = parted.pairs_after == 0 && parted.vertex_pairs_after == 0;
  roll.parting = parted.iterations;
  roll.start = parted.x;
}

// Cuts out the triangles that meet other cloth at the start.
void cut_start(const RollMaker& maker, Roll& roll) {
  Scene alone = roll.scene->scene;
  alone.obstacles.clear();
  State state;
  state.x = roll.start;
  const std::vector<char> all(static_cast<std::size_t>(alone.surface.triangles.rows()), 1);
  const std::vector<int> cut = cut_out_at_start(alone, state, all);
  roll.cut = static_cast<int>(cut.size());
  if (cut.empty()) return;
  roll.usable = cut.size() < all.size();
  if (!roll.usable) return;
  roll.scene = cut_scene(maker, roll.request, *roll.scene, cut);
  for (const int pin : roll.scene->rest.pinned) roll.start.row(pin) = roll.cloth[1].row(pin).cast<double>();
}

// One flag per triangle: it meets another one.
std::vector<char> meeting(const Surface& surface, const Points& x, IntersectionCache& cache) {
  std::vector<char> marks(static_cast<std::size_t>(surface.triangles.rows()), 0);
  for (const auto& [a, b] : intersecting_pairs(surface, x, cache))
    marks[static_cast<std::size_t>(a)] = marks[static_cast<std::size_t>(b)] = 1;
  return marks;
}

// A scene with the fixed material is made once.
std::shared_ptr<const TrainingScene> scene_of(RollMaker& maker, const RollRequest& request) {
  if (maker.options.samples.sample_materials != MaterialSampling::none)
    return make_training_scene(maker, request, drawn_materials(maker, request));
  constexpr std::size_t most_scenes = 128;
  if (maker.scenes.size() > most_scenes) maker.scenes.clear();
  auto& scene = maker.scenes[{request.wear, request.body, request.mirrored, request.with_body,
                              request.sheet != HungStart::none, request.wind}];
  if (!scene) scene = make_training_scene(maker, request, drawn_materials(maker, request));
  return scene;
}

// Body and garments in a frame, turned as the roll-out is.
SkinnedFrame frame_of(RollMaker& maker, const RollRequest& request, const RollRequest& at, int k) {
  SkinnedFrame frame;
  if (request.sheet != HungStart::none)
    frame.cloth = hung_sheet(maker.options.samples.edge).rest.cast<float>();
  else
    frame = skinned_frame(maker.world, at.wear, at.body, at.clip, at.first_frame - 1 + k);
  turn(request, frame.body);
  turn(request, frame.cloth);
  if (!request.with_body) frame.body = PointsF(0, 3);
  return frame;
}

// Sets gravity and the roll-out's own force. A wind is given by its speed.
void set_forces(const RollMaker& maker, Roll& roll) {
  const RollRequest& request = roll.request;
  roll.shows_forces = sees_accelerations(maker.features);
  roll.carried = maker.features.base == OutputBase::carried;
  roll.forces.acceleration = Vec3(0, -maker.options.objective.gravity_strength, 0);
  if (!request.wind) {
    roll.forces.acceleration += request.force;
    return;
  }
  const Wind& wind = roll.scene->scene.wind;
  const double density = roll.scene->scene.cloths.front().material.density, strength = request.force.norm();
  if (strength > 0)
    roll.forces.wind = std::sqrt(2 * strength * density / (wind.air_density * wind.drag)) / strength * request.force;
}

// Sets the start where the solver brings the skinned garment over the frames before, with noise if it is asked for.
void simulate_start(RollMaker& maker, const RollRequest& at, Roll& roll) {
  const RollRequest& request = roll.request;
  const Scene& scene = roll.scene->scene;
  std::vector<SkinnedFrame> frames;  // the first one gives the velocity at the start
  for (int k = -request.simulated; k <= 1; ++k) frames.push_back(frame_of(maker, request, at, k));
  State state;
  state.x = frames[1].cloth.cast<double>();
  state.v = (state.x - frames[0].cloth.cast<double>()) / learned_dt;
  if (!scene.obstacles.empty()) state.obstacles = {frames[1].body.cast<double>()};
  const auto solver = make_teacher_stepper(scene, maker.options.teacher);
  roll.usable = simulate_frames(*solver, scene, roll.forces, std::span(frames).subspan(2), state);
  if (!roll.usable) return;
  roll.start = state.x;
  roll.velocity = state.v * learned_dt;
  if (request.noise > 0) roll.start += start_noise_of(maker.options, roll);
}

void hang(HungStart sheet, RollRequest& request) {
  request.sheet = sheet;
  request.with_body = false;
}

void draw_force(const ForceSampling& forces, RandomStream& random, RollRequest& request) {
  if (forces.strongest == 0) return;
  if (random.heads(forces.sheet_share)) hang(HungStart::flat, request);
  request.wind = random.heads(forces.wind_share);
  const double up = random.between(-1, 1), turned = random.between(0, 2 * std::numbers::pi),
               across = std::sqrt(std::max(0.0, 1 - up * up));
  request.force = random.between(0, forces.strongest) * Vec3(across * std::cos(turned), up, across * std::sin(turned));
}

// Draws one of `all` by weight.
template <class List, class Weight>
std::size_t drawn(const List& all, RandomStream& random, const Weight& weight) {
  if (std::ranges::all_of(all, [&](const auto& one) { return weight(one) == weight(all[0]); }))
    return static_cast<std::size_t>(random.below(static_cast<int>(all.size())));
  double sum = 0, below = 0;
  for (const auto& one : all) sum += weight(one);
  const double at = random.uniform() * sum;
  for (std::size_t k = 0; k + 1 < all.size(); ++k)
    if (at < (below += weight(all[k]))) return k;
  return all.size() - 1;
}

// Draws a body of the person, and a clip of that body.
void draw_performance(const TrainingWorld& world, const TrainingPerson& who, RandomStream& random,
                      RollRequest& request) {
  const auto body = [&](int k) -> const TrainingBody& { return world.bodies[static_cast<std::size_t>(k)]; };
  request.body = who.bodies[drawn(who.bodies, random, [&](int k) { return body(k).weight; })];
  request.clip =
      static_cast<int>(drawn(body(request.body).clips, random, [](const TrainingClip& clip) { return clip.weight; }));
}

constexpr int many_pairs = 20;  // of a start that counts as tangled (Grigorev et al. 2024, figure 5, has more)
constexpr double least_noise = 1e-3, most_noise = 1e-2;  // of a start with strong noise [m]
constexpr int most_attempts = 8;                         // to find such a start

// A material drawn over the ranges of the authors' training (their configurations): density and lambda uniform, mu and
// bending by their logarithms.
VertexMaterial random_material(RandomStream& random) {
  constexpr double thickness = 4.7e-4;  // [m], of the authors
  VertexMaterial material;
  material.density = random.between(0.0434, 0.7);
  material.lame_mu = thickness * std::exp(random.between(std::log(15909.0), std::log(63636.0)));
  material.lame_lambda = thickness * random.between(3535.41, 93333.74);
  material.bending = std::exp(random.between(std::log(6.3708e-8), std::log(1.31397e-3)));
  return material;
}

}  // namespace

RollRequest tangled_place(RollMaker& maker, const RollRequest& asked, int& pairs) {
  RandomStream random = stream_for(maker.options.seed, place, asked.number);
  RollRequest best = asked, tried = asked;
  IntersectionCache cache;
  pairs = -1;
  for (int attempt = 0; attempt < most_attempts && pairs < many_pairs; ++attempt) {
    const std::shared_ptr<const TrainingScene> scene = scene_of(maker, tried);
    const SkinnedFrame frame = skinned_frame(maker.world, tried.wear, tried.body, tried.clip, tried.first_frame);
    Points x = frame.cloth.cast<double>();
    if (tried.mirrored) x.col(0) *= -1;
    const auto found = static_cast<int>(intersecting_pairs(scene->scene.surface, x, cache).size());
    if (found > pairs) {
      pairs = found;
      best = tried;
    }
    if (asked.number % 2 == 1) break;
    draw_performance(maker.world, wearer(maker.world, tried.wear), random, tried);
    tried.first_frame = random.below(std::max(1, frame_count(maker.world, tried.body, tried.clip) - asked.frames));
  }
  return best;
}

RollRequest draw_roll(const TrainingOptions& options, const TrainingWorld& world, std::uint64_t number,
                      double progress) {
  RandomStream random = stream_for(options.seed, drawing, number);
  const SampleOptions& samples = options.samples;
  const PoolOptions& pool = options.pool;
  RollRequest request;
  request.number = number;
  const std::vector<TrainingPerson>& people = world.people;
  const TrainingPerson& who =
      people[people.size() > 1 ? drawn(people, random, [](const TrainingPerson& one) { return one.weight; }) : 0];
  request.wear =
      who.wear[drawn(who.wear, random, [&](int k) { return world.wear[static_cast<std::size_t>(k)].weight; })];
  draw_performance(world, who, random, request);
  request.still = random.heads(samples.still_share);
  request.mirrored = samples.mirror && random.heads(0.5);
  request.with_body = !random.heads(samples.no_body_share);
  request.cloth_contact = options.contact.edges && !random.heads(pool.no_contact_share);
  const double turned = random.uniform();
  request.yaw = samples.yaw ? 2 * std::numbers::pi * turned : 0;
  const bool is_long = random.heads(pool.long_share);
  const int most = std::max(1, static_cast<int>(weight_at(pool.frames, progress)));
  const int some = pool.random_length ? 1 + random.below(most) : most;
  const int there = frame_count(world, request.body, request.clip);
  request.frames = std::min(is_long ? pool.long_frames : some, there - 1);
  request.first_frame = random.below(std::max(1, there - request.frames));
  draw_force(samples.forces, random, request);
  if (samples.folded_share > 0 && request.cloth_contact && random.heads(samples.folded_share)) {
    hang(HungStart::folded, request);
    request.still = false;  // cloth does not meet cloth in a settling frame
  }
  if (samples.noise_share > 0 && random.heads(samples.noise_share))
    request.noise = random.between(least_noise, most_noise);
  if (samples.simulated_share > 0 && random.heads(samples.simulated_share) && request.sheet != HungStart::folded) {
    request.simulated =
        samples.random_simulated ? 1 + random.below(samples.simulated_frames) : samples.simulated_frames;
    request.still = false;
  }
  return request;
}

std::vector<MaterialDraw> drawn_materials(const RollMaker& maker, const RollRequest& request) {
  const SampleOptions& samples = maker.options.samples;
  const std::size_t garments =
      request.sheet != HungStart::none ? 1 : maker.world.wear[static_cast<std::size_t>(request.wear)].garments.size();
  std::vector<MaterialDraw> draws(garments, {samples.material, samples.material});
  if (samples.sample_materials == MaterialSampling::none) return draws;
  RandomStream random = stream_for(maker.options.seed, material_draw, request.number);
  for (MaterialDraw& draw : draws) {
    draw.one = draw.other = random_material(random);
    if (samples.sample_materials == MaterialSampling::garment) continue;
    draw.other = random_material(random);
    for (double& part : draw.direction) part = random.normal();
  }
  return draws;
}

std::shared_ptr<const TrainingScene> make_training_scene(const RollMaker& maker, const RollRequest& request,
                                                         const std::vector<MaterialDraw>& draws) {
  const TrainingWorld& world = maker.world;
  auto made = std::make_shared<TrainingScene>();
  Scene& scene = made->scene;
  Triangles triangles;
  const auto add = [&](const std::string& name, const Points& rest, const Triangles& own,
                       const std::vector<int>& pins) {
    const MaterialDraw& draw = draws[scene.cloths.size()];
    add_materials(draw, rest, made->materials);
    add_cloth_part(name, rest, own, pins, request.mirrored, isotropic_material(mixed(draw, 0.5)), scene, triangles);
  };
  if (request.sheet != HungStart::none) {
    const HungSheet sheet = hung_sheet(maker.options.samples.edge);
    add("sheet", sheet.rest, sheet.triangles, sheet.pins);
  } else {
    const Eigen::VectorXd& shape = world.bodies[static_cast<std::size_t>(request.body)].shape;
    for (const Garment& garment : world.wear[static_cast<std::size_t>(request.wear)].garments) {
      const auto first = static_cast<int>(scene.rest.rows());
      for (const auto& [a, b, rest_length] : garment.stitches)
        scene.springs.push_back({first + a, first + b, rest_length});
      add(garment.name, rest_shape(garment, wearer(world, request.wear).body, shape), garment.skin.triangles,
          garment.pins);
    }
  }
  scene.wind.on = request.wind;
  scene.contact.self = maker.options.contact.edges;
  if (request.with_body) {
    const TrainingPerson& who = wearer(world, request.wear);
    scene.obstacles.push_back({"body", request.mirrored ? who.mirrored : who.surface, true});
  }
  return with_graph(maker, request, triangles, std::move(made));
}

std::shared_ptr<const TrainingScene> cut_scene(const RollMaker& maker, const RollRequest& request,
                                               const TrainingScene& whole, const std::vector<int>& cut) {
  auto made = std::make_shared<TrainingScene>();
  made->materials = whole.materials;
  made->scene = whole.scene;
  Scene& scene = made->scene;
  const Triangles& all = whole.scene.surface.triangles;
  Triangles triangles(all.rows() - static_cast<Eigen::Index>(cut.size()), 3);
  std::vector<char> alone(static_cast<std::size_t>(scene.rest.rows()), 1);
  scene.rest_triangle.clear();
  Eigen::Index kept = 0;
  for (Cloth& cloth : scene.cloths) {
    const int first = cloth.first_triangle, end = first + cloth.triangle_count;
    cloth.first_triangle = static_cast<int>(kept);
    for (int t = first; t < end; ++t) {
      if (std::ranges::binary_search(cut, t)) continue;
      triangles.row(kept++) = all.row(t);
      scene.rest_triangle.push_back(whole.scene.rest_triangle[static_cast<std::size_t>(t)]);
      for (const int v : all.row(t)) alone[static_cast<std::size_t>(v)] = 0;
    }
    cloth.triangle_count = static_cast<int>(kept) - cloth.first_triangle;
  }
  std::erase_if(scene.springs, [&](const Spring& spring) {
    return alone[static_cast<std::size_t>(spring.a)] != 0 || alone[static_cast<std::size_t>(spring.b)] != 0;
  });
  for (const int pin : scene.pins) alone[static_cast<std::size_t>(pin)] = 0;
  for (int v = 0; v < static_cast<int>(alone.size()); ++v)
    if (alone[static_cast<std::size_t>(v)]) scene.pins.push_back(v);
  return with_graph(maker, request, triangles, std::move(made));
}

Roll make_roll(RollMaker& maker, const RollRequest& request) {
  Roll roll;
  roll.request = request;
  roll.space_edges = request.cloth_contact || !maker.options.contact.edges;
  const bool looks =
      maker.options.samples.start == GarmentStart::tangled && request.cloth_contact && request.sheet == HungStart::none;
  const RollRequest at = looks ? tangled_place(maker, request, roll.pairs) : request;
  roll.scene = scene_of(maker, at);
  const bool crosses_itself = request.with_body && !maker.options.samples.soft_tissue;
  IntersectionCache cache;
  for (int k = 0; k < request.frames + 2; ++k) {
    SkinnedFrame frame = frame_of(maker, request, at, k);
    if (crosses_itself) roll.body_left_out.push_back(meeting(roll.scene->graph.body, frame.body.cast<double>(), cache));
    roll.body.push_back(std::move(frame.body));
    roll.cloth.push_back(std::move(frame.cloth));
  }
  set_forces(maker, roll);
  if (request.simulated > 0)
    simulate_start(maker, at, roll);
  else
    set_start(maker.options, roll);
  if (maker.options.samples.start == GarmentStart::cut && request.cloth_contact) cut_start(maker, roll);
  return roll;
}

}  // namespace selvedge
