#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace selvedge {

// The times of samples of a motion: meshes of a sequence, or poses of a clip.
struct SampleTimes {
  std::vector<double> at;  // of each sample, ascending, at least one [frames of 1 / fps]
  double fps = 30;         // above 0

  double first() const { return at.front() / fps; }  // [s]
  double last() const { return at.back() / fps; }    // [s]
};

// Samples at a steady rate from time 0 on.
SampleTimes steady(std::size_t count, double fps);

// The samples between which a time lies: the earlier one, and the share toward the next. The first and the last sample
// are held before and after.
struct SamplePlace {
  std::size_t sample = 0;
  double share = 0;  // 0 at the last sample
};
SamplePlace place_of(const SampleTimes&, double time);
SamplePlace steady_place(std::size_t count, double fps, double time);  // among steady ones

// Shifts the samples so that they begin at a time [s].
void begin_at(double time, SampleTimes&);

// Adds a warning if samples do not begin at time 0. `noun`: what moves; `cure`: how to let it begin at once.
void warn_of_begin(const std::string& noun, const std::string& cure, const SampleTimes&,
                   std::vector<std::string>& warnings);

// Adds a warning, with the frame, if samples end before the run does: the last one is held from there on.
void warn_of_end(const std::string& noun, double last, double fps, int frames, std::vector<std::string>& warnings);

}  // namespace selvedge
