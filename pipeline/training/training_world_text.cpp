#include <algorithm>

#include <fmt/format.h>

#include "pipeline/host/bytes_of.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/training/training_world.hpp"

namespace selvedge {
namespace {

template <class Numbers>
void add_matrix(const Numbers& values, std::uint64_t& hash) {
  const std::string_view bytes = bytes_of(values);
  hash = hash_of(bytes, hash_of(fmt::format("{} ", bytes.size()), hash));
}

// "2 clips in validation, 1 in test"; empty: nothing is held out.
std::string held_out_text(const std::vector<Split>& splits, const std::string& noun) {
  std::string text;
  for (const Split split : {Split::validation, Split::test})
    if (const auto count = std::ranges::count(splits, split); count > 0)
      text += fmt::format("{}{} {} in {}", text.empty() ? "" : ", ", count, noun, split_name(split));
  return text;
}

std::string held_out_text(const SampleOptions& options, const Config& person) {
  const Split whole = split_of(options.split, person["name"].text());
  if (whole != Split::training) return "all in " + split_name(whole);
  std::vector<Split> wear, clips;
  for (const Config& item : person["wear"].items) wear.push_back(split_of_wear(options.split, item, options.folder));
  for (const Config& item : person["clips"].items) clips.push_back(split_of_clip(options.split, item));
  const std::string a = held_out_text(wear, "of what is worn"), b = held_out_text(clips, "of the clips");
  return a + (a.empty() || b.empty() ? "" : ", ") + b;
}

}  // namespace

std::uint64_t world_hash(const TrainingWorld& world) {
  std::uint64_t hash = hash_of("");
  for (const TrainingPerson& person : world.people) hash = hash_of(fmt::format("{:x} ", person.hash), hash);
  for (const TrainingWear& wear : world.wear)
    for (const Garment& garment : wear.garments) {
      add_matrix(garment.skin.rest, hash);
      add_matrix(garment.skin.triangles, hash);
      add_matrix(garment.pins, hash);
    }
  for (const TrainingBody& body : world.bodies) {
    add_matrix(body.shape, hash);
    for (const TrainingClip& clip : body.clips)
      for (const BodyPose& pose : clip.motion.poses) {
        add_matrix(pose.rotations, hash);
        add_matrix(pose.translation, hash);
      }
  }
  return hash;
}

std::string people_text(const TrainingWorld& world, const SampleOptions& options) {
  std::string text;
  for (const TrainingPerson& person : world.people) {
    std::size_t clips = 0, poses = 0;
    for (const int k : person.bodies) {
      const std::vector<TrainingClip>& own = world.bodies[static_cast<std::size_t>(k)].clips;
      clips += own.size();
      for (const TrainingClip& clip : own) poses += clip.motion.poses.size();
    }
    const auto from = std::ranges::find(options.people, person.name, [](const Config& p) { return p["name"].text(); });
    const std::string held = from == options.people.end() ? "" : held_out_text(options, *from);
    text +=
        fmt::format("trains on `{}`: {} to wear, {} bodies, {} clips of bodies with {} poses{}\n", person.name,
                    person.wear.size(), person.bodies.size(), clips, poses, held.empty() ? "" : "; held out: " + held);
  }
  for (const Config& person : options.people)
    if (split_of(options.split, person["name"].text()) != Split::training)
      text += fmt::format("held out `{}`: {}\n", person["name"].text(), held_out_text(options, person));
  return text;
}

}  // namespace selvedge
