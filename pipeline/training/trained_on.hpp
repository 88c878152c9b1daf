#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/training/training_options.hpp"

namespace selvedge {

// What is worn or a clip: its name, and a hash of the bytes of its files. What the program makes has one of its name.
struct TrainedItem {
  std::string name;
  std::uint64_t content = 0;
};

// One who wears and moves. `body` is a hash of the body's file, or name, and of the shape that is given.
struct TrainedPerson {
  std::string name;
  std::uint64_t body = 0;
  std::vector<TrainedItem> wear, clips;
};

// Who and what a network was trained on, in this run and in those whose weights it began with. Weight files keep it.
struct TrainedOn {
  std::vector<TrainedPerson> people;
  bool whole = true;  // false: it began with weights that do not say what they were trained on
};

// All of the file's people, in its order, whatever its split holds out. Reads the bytes of their files.
std::vector<TrainedPerson> contents_of(const SampleOptions&);

// What the options train on.
TrainedOn trained_on(const SampleOptions&);

// Adds what the earlier weights say, as trained_on_json has it; an empty text says nothing.
void add_earlier(const std::string& record, const std::string& where, TrainedOn&);

// As JSON, and back. Throws Error, naming `where`, for what is no such record.
std::string trained_on_json(const TrainedOn&);
TrainedOn read_trained_on(const std::string& json, const std::string& where);

// For people: "`anna`: to wear skirt; clips kick, swing". Of long lists the first names.
std::string trained_on_text(const TrainedOn&);

// A sequence of what is held out: one who wears `wear[0]` in the clip `clips[0]`, and which of the three is held out.
struct HeldOut {
  TrainedPerson who;
  bool person = false, wear = false, clip = false;
};

// What of that which is held out a network was trained on, such as "the clip `kick`"; empty: nothing. Wear and clips
// are known by their content, whatever their names. A person is known by body and name, or by body, wear and clip.
std::string seen_in_training(const TrainedOn&, const HeldOut&);

}  // namespace selvedge
