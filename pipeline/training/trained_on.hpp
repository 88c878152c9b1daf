#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/training/training_options.hpp"

namespace selvedge {

// A garment or clip: its name, and a hash of the bytes of its files, or of the name of what the program makes.
struct TrainedItem {
  std::string name;
  std::uint64_t content = 0;
};

// A person. `body` is a hash of the body's file or name, and of the given shape.
struct TrainedPerson {
  std::string name;
  std::uint64_t body = 0;
  std::vector<TrainedItem> wear, clips;
};

// The people of this training and of those whose weights it began with. Weight files keep them.
struct TrainedOn {
  std::vector<TrainedPerson> people;
  bool whole = true;  // false: it began with weights without such a record
};

// All people of the file in order, also those that its split holds out. Reads the bytes of their files.
std::vector<TrainedPerson> contents_of(const SampleOptions&);

// The people, garments and clips that the options train on.
TrainedOn trained_on(const SampleOptions&);

// Adds the record of earlier weights (trained_on_json). An empty text makes `on` incomplete.
void add_earlier(const std::string& record, const std::string& where, TrainedOn&);

// The record as JSON, and back. Throws Error, which names `where`, for any other text.
std::string trained_on_json(const TrainedOn&);
TrainedOn read_trained_on(const std::string& json, const std::string& where);

// For people: "`anna`: to wear skirt; clips kick, swing". Long lists are cut.
std::string trained_on_text(const TrainedOn&);

// A held-out sequence: a person who wears `wear[0]` in the clip `clips[0]`, and which of the three is held out.
struct HeldOut {
  TrainedPerson who;
  bool person = false, wear = false, clip = false;
};

// Names a held-out thing that the network was trained on, such as "the clip `kick`"; empty: none. Garments and clips
// are compared by content, not by name. A person is compared by body and name, or by body, garment and clip.
std::string seen_in_training(const TrainedOn&, const HeldOut&);

}  // namespace selvedge
