#pragma once

#include <vector>

#include "physics/scene/scene.hpp"

namespace selvedge {

// Principal strains |s - 1| of a cloth's triangles, two each.
struct StrainMeasure {
  double mean = 0, p99 = 0, most = 0;
};
StrainMeasure strain_of(const Scene&, const Points& x);

// The percentile: the lowest value that the share `part` of all values (0 to 1) does not exceed; 0 without values.
double percentile(std::vector<double>, double part);

// The last frames, for the jitter.
struct MotionTrace {
  Points x1, x2, x3;  // the last frame, the one before, ...

  // Adds a frame. Returns the mean square over vertices of the change of acceleration in the last four frames
  // [m2/frame4]; 0 before there are four.
  double add(const Points& x);
};

// Oscillation of the cloth: the spectrum of velocities of up to 500 vertices, spread evenly over the vertex numbers.
struct MotionSpectrum {
  std::vector<Points> x;  // of those vertices, by frame

  void add(const Points& all);
  // Power of velocities [m2/frame2] by frequency: entry k is k / frames of the frame rate, up to its half; the mean
  // velocity of each vertex, entry 0, is left at 0. Empty before there are three frames.
  std::vector<double> power() const;
  // The share of the power above a quarter of the frame rate: 0 for smooth motion, about a half for noise of
  // velocities.
  double high_share() const;
};

}  // namespace selvedge
