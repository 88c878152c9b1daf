#include "pipeline/compare/sequences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>

#include "collision/geometry/error.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/garments/outfit.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/obstacles/setup_paths.hpp"

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

int clip_of(const SequenceOptions& sequences, int number) {
  const auto outfits = static_cast<int>(sequences.outfits.size()), clips = static_cast<int>(sequences.clips.size());
  return number / outfits % clips;
}

// Searches for the start of a tangled sequence. Returns overrides of its scene.
std::vector<std::string> searched_start(const SequenceOptions& sequences, int number, RollMaker& maker) {
  RollRequest asked;
  asked.number = 2 * static_cast<std::uint64_t>(number);  // even ones are looked for
  asked.clip = clip_of(sequences, number);
  asked.body = number % shapes;
  asked.frames = sequences.frames;
  int pairs = 0;
  const RollRequest at = tangled_place(maker, asked, pairs);
  const TrainingBody& body = maker.world.bodies[static_cast<std::size_t>(at.body)];
  return {"obstacles.person.body.clip=" + body.clips[static_cast<std::size_t>(at.clip)].name,
          "obstacles.person.body.shape=" + list_text(body.shape),
          fmt::format("obstacles.person.body.first_frame={}", at.first_frame)};
}

// A start as it is kept: a line with its key, then a line an override.
struct KeptStart {
  std::filesystem::path file;  // empty: nothing is kept
  std::string key;
};

KeptStart kept_start(const SequenceOptions& sequences, const std::string& program, const CompareScene& scene) {
  const std::string inputs =
      fmt::format("{} {} {} {} {} {:016x} {} of {}", scene.outfit, *scene.sequence, sequences.frames, sequences.seed,
                  sequences.shape_spread, hash_of_file(config_folder() / "outfits.yaml"), joined(sequences.clips),
                  sequences.outfits.size());
  const std::filesystem::path folder = cache_folder();
  if (folder.empty()) return {{}, {}};
  return {folder / "tangled" / fmt::format("{:016x}.txt", hash_of(inputs)), program + " " + inputs};
}

std::optional<std::vector<std::string>> read_start(const KeptStart& kept) {
  std::istringstream text(whole_file(kept.file));
  std::string line;
  if (!std::getline(text, line) || line != kept.key) return {};
  std::vector<std::string> overrides;
  while (std::getline(text, line)) overrides.push_back(line);
  return overrides;
}

void write_start(const KeptStart& kept, const std::vector<std::string>& overrides, std::ostream* log) {
  if (kept.file.empty()) return;
  try {
    write_cached(kept.file,
                 [&] { write_file(kept.file, fmt::format("{}\n{}\n", kept.key, fmt::join(overrides, "\n"))); });
  } catch (const Error& error) {
    if (log) *log << "warning: a tangled start is not kept: " << error.what() << "\n";
  }
}

}  // namespace

void add_sequences(Comparison& comparison) {
  const SequenceOptions& sequences = comparison.sequences;
  if (sequences.outfits.empty() || sequences.clips.empty() || sequences.file.empty())
    throw Error("lacks its scene file, outfits or clips", "`sequences`", "give all three");
  if (sequences.tangled > 0) check_bodies_unseen(comparison);
  const auto outfits = static_cast<int>(sequences.outfits.size()), clips = static_cast<int>(sequences.clips.size());
  int tangled = 0;
  for (int n = 0; n < sequences.count; ++n) {
    const Outfit outfit = outfit_of(sequences.outfits[static_cast<std::size_t>(n % outfits)]);
    const std::string& clip = sequences.clips[static_cast<std::size_t>(clip_of(sequences, n))];
    CompareScene scene;
    scene.file = comparison.file.parent_path() / sequences.file;
    scene.outfit = outfit.name;
    scene.states = 0;
    scene.overrides = {"cloths.0.garment.outfit=" + outfit.name, fmt::format("run.frames={}", sequences.frames)};
    if ((n % 2 == 1 || sequences.count == sequences.tangled) && tangled < sequences.tangled) {
      ++tangled;
      scene.tangled = true;
      scene.sequence = n;
      scene.name = fmt::format("{}_tangled_{}", outfit.name, n);
      scene.overrides.insert(scene.overrides.end(), {"cloths.0.garment.layers=alone", "obstacles.person.body.room=0"});
    } else {
      scene.name = outfit.name + "_" + clip;
      if (n >= outfits * clips) scene.name += fmt::format("_{}", n / (outfits * clips) + 1);
      scene.overrides.push_back("obstacles.person.body.clip=" + clip);
    }
    comparison.scenes.push_back(std::move(scene));
  }
}

void find_start(const Comparison& comparison, const std::string& program, std::ostream* log, TangledSearch& search,
                CompareScene& scene) {
  if (!scene.sequence) return;
  const SequenceOptions& sequences = comparison.sequences;
  const KeptStart kept = kept_start(sequences, program, scene);
  std::optional<std::vector<std::string>> start = read_start(kept);
  if (!start) {
    auto maker = search.makers.find(scene.outfit);
    if (maker == search.makers.end())
      maker = search.makers.emplace(scene.outfit, maker_of(sequences, outfit_of(scene.outfit))).first;
    start = searched_start(sequences, *scene.sequence, maker->second);
    write_start(kept, *start, log);
  }
  scene.overrides.insert(scene.overrides.end(), start->begin(), start->end());
  scene.sequence.reset();
}

}  // namespace selvedge
