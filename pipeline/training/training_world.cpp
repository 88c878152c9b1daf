#include "pipeline/training/training_world.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "learned/steppers/learned_state.hpp"
#include "pipeline/garments/garment_make.hpp"
#include "pipeline/garments/outfit.hpp"
#include "pipeline/host/bytes_of.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/scene/config_scene.hpp"
#include "pipeline/scene/setup_garment.hpp"
#include "pipeline/training/random_stream.hpp"

namespace selvedge {
namespace {

constexpr double tissue_skin_width = 0.02;  // width of the skin that moves a garment's vertex [m]

// A person to add to the world, as sections of a scene.
struct Cast {
  std::string name;
  double weight = 1;
  Config body;
  std::vector<std::pair<std::string, Config>> clips;  // each with the body's section that has the clip
  std::vector<double> weights;                        // one per clip
};

Cast mannequin_cast(const SampleOptions& options) {
  const std::string where = "samples";
  Cast cast{"mannequin",
            options.mannequin_weight.value_or(1),
            read_values(table::body_section(), {{"model", where, {"mannequin"}}}),
            {},
            {}};
  for (const std::string& name : training_clip_names(options)) {
    cast.clips.emplace_back(
        name, read_values(table::body_section(), {{"model", where, {"mannequin"}}, {"clip", where, {name}}}));
    cast.weights.push_back(1);
  }
  return cast;
}

Cast cast_of(const SampleOptions& options, const Config& person) {
  Cast cast{person["name"].text(), person["weight"].number(), person["body"], {}, {}};
  for (const Config& clip : person["clips"].items) {
    if (split_of_clip(options.split, clip) != Split::training) continue;
    cast.clips.emplace_back(clip["name"].text(), performing(person["body"], clip));
    cast.weights.push_back(clip["weight"].number());
  }
  return cast;
}

// A garment by code, or an outfit.
TrainingWear wear_by_code(const std::string& name, const SampleOptions& options, const BodyModel& body) {
  TrainingWear wear{name, {}, {}};
  for (const Outfit& outfit : read_wardrobe(config_folder() / "outfits.yaml").outfits)
    if (outfit.name == name)
      wear.garments = options.start == GarmentStart::tangled ? kept_layers(cache_folder(), outfit, body, options.edge)
                                                             : kept_outfit(cache_folder(), outfit, body, options.edge);
  GarmentOptions cut;
  cut.edge = options.edge;
  if (wear.garments.empty()) wear.garments.push_back(kept_garment(cache_folder(), name, body, cut));
  return wear;
}

TrainingWear wear_of(const Config& section, const std::filesystem::path& folder, const Performance& who,
                     std::vector<std::string>& warnings) {
  TrainingWear wear{section["name"].text(), {}, {}};
  wear.weight = section["weight"].number();
  for (const Config& garment : section["garments"].items)
    for (Garment& made : read_garments(garment, folder, who, warnings)) {
      warn_of_seams(garment, garment.where, made.skin.rest, made.skin.triangles, warnings);
      wear.garments.push_back(std::move(made));
    }
  return wear;
}

void add_wear(const SampleOptions& options, const BodyModel& body, TrainingWear wear, TrainingWorld& world) {
  for (const Garment& garment : wear.garments)
    wear.skin.push_back(options.soft_tissue ? shares_of_body(garment.skin.rest, body, tissue_skin_width)
                                            : SkinWeights{});
  wear.person = static_cast<int>(world.people.size()) - 1;
  world.people.back().wear.push_back(static_cast<int>(world.wear.size()));
  world.wear.push_back(std::move(wear));
}

// The shape number `index`, around the one in the file.
Eigen::VectorXd drawn_shape(const SampleOptions& options, std::uint64_t seed, int index, const Eigen::VectorXd& given,
                            Eigen::Index directions) {
  Eigen::VectorXd shape = Eigen::VectorXd::Zero(directions);
  shape.head(given.size()) = given;
  if (index == 0) return shape;
  RandomStream random = stream_of(seed, static_cast<std::uint64_t>(index));
  for (Eigen::Index k = 0; k < directions; ++k)
    shape[k] += std::clamp(options.shape_spread * random.normal(), -3.0, 3.0);
  return shape;
}

// The clip with one pose per time step.
Clip in_time_steps(Clip clip) {
  if (std::abs(clip.fps * learned_dt - 1) < 1e-9) return clip;
  Clip made = clip;
  made.fps = std::round(1 / learned_dt);
  made.poses.clear();
  const auto steps = static_cast<int>(std::floor(end_of(clip) / learned_dt + 1e-6));
  for (int k = 0; k <= steps; ++k) made.poses.push_back(pose_at(clip, k * learned_dt));
  return made;
}

void check_garments_take(const Config& section, const TrainingWorld& world, const TrainingPerson& person,
                         const Eigen::VectorXd& shape) {
  for (const int k : person.wear)
    for (const Garment& garment : world.wear[static_cast<std::size_t>(k)].garments)
      if (garment.skin.shape_directions.cols() < shape.size())
        section.fail("has a shape of " + std::to_string(shape.size()) + " coefficients, the garment `" + garment.name +
                         "` takes " + std::to_string(garment.skin.shape_directions.cols()),
                     "make the garment anew for this body with `selvedge dress`, or give a shorter `shape`");
}

// The person's body of this shape: one from `first` on, or a new one.
TrainingBody& body_of(const SampleOptions& options, const Config& section, const Eigen::VectorXd& shape,
                      std::size_t first, Performance& who, TrainingWorld& world) {
  for (std::size_t k = first; k < world.bodies.size(); ++k)
    if (world.bodies[k].shape == shape) return world.bodies[k];
  TrainingPerson& person = world.people.back();
  check_garments_take(section["clip"], world, person, shape);
  TrainingBody body;
  body.shape = shape;
  body.joints = joint_positions(person.body, shape);
  body.person = static_cast<int>(world.people.size()) - 1;
  body.weight = 0;
  if (options.soft_tissue) {
    perform(section, options.folder, who);
    wear(layer_count(world, person), who);
    body.soft_tissue = who.soft_tissue;
    body.room = who.known->room;
  }
  person.bodies.push_back(static_cast<int>(world.bodies.size()));
  return world.bodies.emplace_back(std::move(body));
}

// Adds all clips with the shape number `index`. A clip with its own shape gets its own body.
void add_shape(const SampleOptions& options, std::uint64_t seed, int index, const Cast& cast, Performance& who,
               TrainingWorld& world) {
  const std::size_t first = world.bodies.size();
  for (std::size_t k = 0; k < cast.clips.size(); ++k) {
    Config section = cast.clips[k].second;
    const auto go = [&] {  // without soft tissue, which takes long
      Config stiff = section;
      stiff["room"].numbers = {0};
      perform(stiff, options.folder, who);
      return who.clip;
    };
    Clip motion = go();
    const Eigen::VectorXd shape = drawn_shape(options, seed, index, who.shape, who.body.skin.shape_directions.cols());
    section["shape"].numbers.assign(shape.data(), shape.data() + shape.size());
    section["shape"].given = true;
    if (index > 0) motion = go();
    motion = in_time_steps(std::move(motion));
    if (motion.poses.size() < 2) section["clip"].fail("has fewer than two poses, at 30 a second", "leave it out");
    TrainingBody& body = body_of(options, section, shape, first, who, world);
    body.weight += cast.weights[k];
    body.clips.push_back({cast.clips[k].first, std::move(motion), cast.weights[k]});
  }
}

std::uint64_t hash_of_body(const BodyModel& body) {
  std::uint64_t hash = hash_of(body.name);
  const auto add = [&](const auto& numbers) { hash = hash_of(bytes_of(numbers), hash); };
  add(body.skin.rest);
  add(body.skin.triangles);
  add(body.skin.shape_directions);
  add(body.skin.pose_directions);
  for (const SkinWeights* matrix : {&body.skin.weights, &body.regressor})
    add(std::span(matrix->valuePtr(), static_cast<std::size_t>(matrix->nonZeros())));
  return hash;
}

TrainingPerson person_of(const Cast& cast, const Performance& who) {
  TrainingPerson person{cast.name, who.body, who.surface, {}, who.joined, {}, {}, hash_of_body(who.body), cast.weight};
  Triangles turned = who.surface.triangles;
  turned.col(1).swap(turned.col(2));
  person.mirrored = make_surface(who.surface.vertex_count, turned);
  return person;
}

void add_person(const SampleOptions& options, std::uint64_t seed, const Cast& cast, const Config* from,
                TrainingWorld& world) {
  Performance who = read_figure(cast.body, options.folder);
  who.name = cast.name;
  if (from && cast.body["shape"].given) perform(cast.body, options.folder, who);
  world.people.push_back(person_of(cast, who));
  if (!from)
    for (const std::string& name : options.garments)
      add_wear(options, who.body, wear_by_code(name, options, who.body), world);
  else
    for (const Config& wear : (*from)["wear"].items)
      if (split_of_wear(options.split, wear, options.folder) == Split::training)
        add_wear(options, who.body, wear_of(wear, options.folder, who, world.warnings), world);
  if (world.people.back().wear.empty() || cast.clips.empty())
    from->fail(
        "has nothing to train on: all that it wears, or all its clips, are held out, by `split` or by the program "
        "(configs/outfits.yaml, configs/clips.yaml)",
        "give it more of either, or name the person in `split`, to hold it out as a whole");
  const bool shapes = who.body.skin.shape_directions.cols() > 0;
  for (int k = 0; k < (shapes ? options.shapes : 1); ++k) add_shape(options, seed, k, cast, who, world);
  for (const std::string& warning : who.warnings)  // a clip that is read again warns again
    if (std::ranges::find(world.warnings, warning) == world.warnings.end()) world.warnings.push_back(warning);
}

}  // namespace

int layer_count(const TrainingWorld& world, const TrainingPerson& person) {
  std::size_t layers = 1;
  for (const int k : person.wear) layers = std::max(layers, world.wear[static_cast<std::size_t>(k)].garments.size());
  return static_cast<int>(layers);
}

TrainingWorld make_training_world(const SampleOptions& options, std::uint64_t seed) {
  TrainingWorld world;
  if (has_mannequin(options)) add_person(options, seed, mannequin_cast(options), nullptr, world);
  for (const Config& person : options.people)
    if (split_of(options.split, person["name"].text()) == Split::training)
      add_person(options, seed, cast_of(options, person), &person, world);
  return world;
}

const TrainingPerson& wearer(const TrainingWorld& world, int wear) {
  return world.people[static_cast<std::size_t>(world.wear[static_cast<std::size_t>(wear)].person)];
}

int frame_count(const TrainingWorld& world, int body, int clip) {
  return static_cast<int>(
      world.bodies[static_cast<std::size_t>(body)].clips[static_cast<std::size_t>(clip)].motion.poses.size());
}

}  // namespace selvedge
