#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/config/options.hpp"
#include "pipeline/formats/checkpoint.hpp"

namespace selvedge {

// What a sample is for. The trainer takes none but those for training.
enum class Split { training, validation, test };
std::string split_name(Split);

// What is held out of training. Members are described where keys are bound to them:
// pipeline/training/training_people.cpp.
struct SplitOptions {
  std::string file;
  std::vector<std::string> validation, test;
};

const Options<SplitOptions>& split_options();

// The table of one of `people`: a body as a scene has it, its clips, and what it wears.
const Section& person_section();
const Section& person_clip_section();
const Section& wear_section();

// How paths of a training file, or of a base of it, are kept: absolute where they are so in the file, else as they are
// seen from the folder of the training file, which is absolute.
struct PathsOfFile {
  std::filesystem::path folder;  // of the file that names them
  std::filesystem::path from;    // of the training file
  std::string seen(const Config& entry) const;
};

// Readies the people of a training file: names for all, paths as said above, a clip for each file that a pattern finds,
// and the lists of the split's file among its own. Throws Error for files that are not there, patterns that find
// nothing, people without clips or garments, and names that come twice.
void settle_people(const PathsOfFile&, std::vector<Config>& people);
void settle_split(const std::filesystem::path& folder, const Config& at, SplitOptions&);

// What the split says of a name; of two lists the later one.
Split split_of(const SplitOptions&, const std::string& name);
// Of a person's clip: held out as well where the program's own split holds it out (configs/clips.yaml).
Split split_of_clip(const SplitOptions&, const Config& clip);
// Of what is worn, likewise (outfits.yaml near the folder of the training file).
Split split_of_wear(const SplitOptions&, const Config& wear, const std::filesystem::path& folder);

// Throws Error, naming the entry, where the split names nothing that the people have.
void check_split(const std::vector<Config>& people, const SplitOptions&, const std::string& where);

// The body's section with the clip and its keys.
Config performing(const Config& body, const Config& clip);

// The files that people are read from, as they are named, with their hashes. `folder` is the training file's.
std::vector<InputFile> files_of(const std::vector<Config>& people, const std::filesystem::path& folder);

// The people with absolute paths; relative ones begin at the folder.
std::vector<Config> with_absolute_paths(std::vector<Config> people, const std::filesystem::path& folder);

// The people with paths that travel: the last folder and the name of each.
std::vector<Config> travelling(std::vector<Config> people);

}  // namespace selvedge
