#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/config/options.hpp"
#include "pipeline/hdf5/checkpoint.hpp"

namespace selvedge {

// The purpose of a sample. The trainer takes only those for training.
enum class Split { training, validation, test };
std::string split_name(Split);

// What is held out of training. Members are described where keys are bound to them:
// pipeline/training/training_people.cpp.
struct SplitOptions {
  std::string file;
  std::vector<std::string> validation, test;
};

const Options<SplitOptions>& split_options();

// The keys of a person: a body as in a scene, clips, and garments to wear.
const Section& person_section();

// Paths of a training file or of its base: absolute paths stay absolute, others become relative to the folder of the
// training file, which is absolute.
struct PathsOfFile {
  std::filesystem::path folder;  // of the file with the path
  std::filesystem::path from;    // of the training file
  std::string seen(const Config& entry) const;
};

// Complete the people of a training file (names, paths, and a clip for each file that a pattern matches) and the split
// (with the lists of its file). Throw Error for missing files, patterns without a match, people without clips or
// garments, and duplicate names.
void settle_people(const PathsOfFile&, std::vector<Config>& people);
void settle_split(const std::filesystem::path& folder, const Config& at, SplitOptions&);

// The split of a name. The test list has precedence.
Split split_of(const SplitOptions&, const std::string& name);
// The split of a person's clip, also by the program's own split (configs/clips.yaml).
Split split_of_clip(const SplitOptions&, const Config& clip);
// The split of a garment, also by outfits.yaml near the folder of the training file.
Split split_of_wear(const SplitOptions&, const Config& wear, const std::filesystem::path& folder);

// Throws Error, which names the entry, for a name of the split that no person has.
void check_split(const std::vector<Config>& people, const SplitOptions&, const std::string& where);

// The body's section with this clip and its keys.
Config performing(const Config& body, const Config& clip);

// The files of people, by their names, with their hashes. `folder` is the training file's.
std::vector<InputFile> files_of(const std::vector<Config>& people, const std::filesystem::path& folder);

// The people with absolute paths, where relative ones begin at the folder.
std::vector<Config> with_absolute_paths(std::vector<Config> people, const std::filesystem::path& folder);

// The people with portable paths: the last folder and the name of each.
std::vector<Config> travelling(std::vector<Config> people);

}  // namespace selvedge
