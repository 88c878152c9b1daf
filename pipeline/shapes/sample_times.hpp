#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace selvedge {

// When the samples of anything that moves are: meshes of a sequence, poses of a clip.
struct SampleTimes {
  std::vector<double> at;  // of each, ascending, one at least [frames of 1 / fps]
  double fps = 30;         // above 0

  double first() const { return at.front() / fps; }  // [s]
  double last() const { return at.back() / fps; }    // [s]
};

// Samples at a steady rate from time 0 on.
SampleTimes steady(std::size_t count, double fps);

// Between which samples a time is: the earlier one, and the share of the way to the next. Before the first and after
// the last sample these are held.
struct SamplePlace {
  std::size_t sample = 0;
  double share = 0;  // 0 at the last sample
};
SamplePlace place_of(const SampleTimes&, double time);
SamplePlace steady_place(std::size_t count, double fps, double time);  // among steady ones

// Lets the samples begin at a time [s] instead of where they do.
void begin_at(double time, SampleTimes&);

// Says where samples do not begin at time 0. `noun` is what moves; `cure` how it begins at once.
void warn_of_begin(const std::string& noun, const std::string& cure, const SampleTimes&,
                   std::vector<std::string>& warnings);

// Says, with the frame, where samples end [s] before a run does, because what moved is held from there on.
void warn_of_end(const std::string& noun, double last, double fps, int frames, std::vector<std::string>& warnings);

}  // namespace selvedge
