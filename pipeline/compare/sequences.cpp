#include "pipeline/compare/sequences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "collision/geometry/error.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/garments/outfit.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/training/training_roll.hpp"

namespace selvedge {
namespace {

constexpr int shapes = 20;  // of bodies, among which tangled starts are looked for

Outfit outfit_of(const std::string& name) {
  const std::vector<Outfit> all = read_wardrobe(config_folder() / "outfits.yaml").outfits;
  const auto found = std::ranges::find(all, name, &Outfit::name);
  if (found != all.end()) return *found;
  throw Error("names the unknown outfit `" + name + "`", "`outfits`", "outfits: " + joined(names_of(all)));
}

RollMaker maker_of(const SequenceOptions& sequences, const Outfit& outfit) {
  RollMaker maker;
  SampleOptions& samples = maker.options.samples;
  samples.garments = {outfit.name};
  samples.edge = outfit.small_edge;
  samples.clips = sequences.clips;
  samples.shapes = shapes;
  samples.shape_spread = sequences.shape_spread;
  samples.soft_tissue = false;
  samples.start = GarmentStart::tangled;
  maker.options.seed = sequences.seed;
  maker.world = make_training_world(samples, sequences.seed);
  return maker;
}

std::string list_text(const Eigen::VectorXd& values) {
  std::string text = "[";
  for (const double value : values) text += fmt::format("{}{}", text.size() > 1 ? ", " : "", value);
  return text + "]";
}

// Training draws its bodies from its seed as `make_tangled` does from that of the sequences. A bare network that has
// seen them would be judged by what it has learned from.
void check_bodies_unseen(const Comparison& comparison) {
  const std::string seed = std::to_string(comparison.sequences.seed);
  for (const CompareSetting& setting : comparison.settings) {
    const StepperKind* kind = comparison.kinds.find(setting.stepper);
    if (!kind || kind->network != NetworkUse::alone || !std::filesystem::exists(setting.weights)) continue;
    for (const auto& [name, value] : read_weight_file(setting.weights).origin)
      if (name == "seed" && value == seed)
        throw Error(fmt::format("{} is the seed with which {} was trained: the row `{}` would start from bodies of its "
                                "training",
                                seed, setting.weights.filename().string(), setting.name),
                    "`seed`", "give another `sequences.seed`");
  }
}

void make_tangled(const SequenceOptions& sequences, RollMaker& maker, int number, int clip, CompareScene& scene) {
  RollRequest asked;
  asked.number = 2 * static_cast<std::uint64_t>(number);  // even ones are looked for
  asked.clip = clip;
  asked.body = number % shapes;
  asked.frames = sequences.frames;
  int pairs = 0;
  const RollRequest at = tangled_place(maker, asked, pairs);
  const auto body = static_cast<std::size_t>(at.body), which = static_cast<std::size_t>(at.clip);
  scene.tangled = true;
  scene.name = fmt::format("{}_tangled_{}", scene.outfit, number);
  scene.overrides.insert(scene.overrides.end(),
                         {"cloths.0.garment.layers=alone", "obstacles.person.body.room=0",
                          "obstacles.person.body.clip=" + maker.world.bodies[body].clips[which].name,
                          "obstacles.person.body.shape=" + list_text(maker.world.bodies[body].shape),
                          fmt::format("obstacles.person.body.first_frame={}", at.first_frame)});
}

}  // namespace

void add_sequences(Comparison& comparison) {
  const SequenceOptions& sequences = comparison.sequences;
  if (sequences.outfits.empty() || sequences.clips.empty() || sequences.file.empty())
    throw Error("lacks its scene file, outfits or clips", "`sequences`", "give all three");
  if (sequences.tangled > 0) check_bodies_unseen(comparison);
  const auto outfits = static_cast<int>(sequences.outfits.size()), clips = static_cast<int>(sequences.clips.size());
  std::vector<std::optional<RollMaker>> makers(sequences.outfits.size());
  int tangled = 0;
  for (int n = 0; n < sequences.count; ++n) {
    const auto which = static_cast<std::size_t>(n % outfits);
    const int clip = n / outfits % clips;
    const Outfit outfit = outfit_of(sequences.outfits[which]);
    CompareScene scene;
    scene.file = comparison.file.parent_path() / sequences.file;
    scene.outfit = outfit.name;
    scene.states = 0;
    scene.name = outfit.name + "_" + sequences.clips[static_cast<std::size_t>(clip)];
    if (n >= outfits * clips) scene.name += fmt::format("_{}", n / (outfits * clips) + 1);
    scene.overrides = {"cloths.0.garment.outfit=" + outfit.name, fmt::format("run.frames={}", sequences.frames)};
    if ((n % 2 == 1 || sequences.count == sequences.tangled) && tangled < sequences.tangled) {
      ++tangled;
      if (!makers[which]) makers[which] = maker_of(sequences, outfit);
      make_tangled(sequences, *makers[which], n, clip, scene);
    } else {
      scene.overrides.push_back("obstacles.person.body.clip=" + sequences.clips[static_cast<std::size_t>(clip)]);
    }
    comparison.scenes.push_back(std::move(scene));
  }
}

}  // namespace selvedge
