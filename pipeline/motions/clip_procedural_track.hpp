#pragma once

#include <vector>

#include "pipeline/motions/clip_procedural_figure.hpp"

namespace selvedge {

struct FigureKey {
  double time = 0;
  Figure figure;
};

// A foot is lifted, moved to another place and put down. Between steps it stands still.
struct Footstep {
  int side = 0;
  double from = 0, to = 0;  // [s]
  Vec3 place = Vec3::Zero();
  double yaw = 0;
  double lift = 0.05;              // [m]
  double toe_off = 0, strike = 0;  // lift of the heel as it leaves, and of the toes as it comes down
};

// Both feet are in the air: the body moves along a parabola.
struct Flight {
  double from = 0, to = 0;  // [s]
};

// A foot swings up, in addition to its step.
struct Swing {
  int side = 0;
  double from = 0, to = 0;  // [s]
  double height = 0;        // [m]
};

// A procedural motion before inverse kinematics.
struct Movement {
  double seconds = 0;
  double smoothing = 0.12;          // [s]
  std::vector<FigureKey> keys;      // ascending times
  std::array<FootPose, 2> start{};  // of the feet
  std::vector<Footstep> steps;      // ascending times for each foot, without overlap
  std::vector<Swing> swings;
  std::vector<Flight> flights;
};

// A ramp max(t, 0) averaged three times over `width` [s]: three times differentiable, and equal to the ramp from 1.5
// widths on.
double smooth_ramp(double t, double width);

// Linear between keys, averaged three times over `width`: without overshoot, and constant parts stay constant.
double smooth_between(const std::vector<double>& times, const std::vector<double>& values, double width, double t);

// The poses of a movement, at 30 frames per second.
std::vector<BodyPose> performed(const Movement&, const Skeleton&);

}  // namespace selvedge
