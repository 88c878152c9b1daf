#pragma once

#include <string>

#include "learned/steppers/network_device.hpp"
#include "physics/steppers/conventional_stepper.hpp"
#include "physics/steppers/hybrid_stepper.hpp"
#include "physics/steppers/icm_stepper.hpp"
#include "physics/steppers/recovering_stepper.hpp"
#include "physics/steppers/resting_stepper.hpp"

namespace selvedge {

// Options of the stepper `learned`. Members are described where keys are bound to them: pipeline/scene/config_run.cpp.
struct LearnedRun {
  std::string weights;
  bool settle = false;
  NetworkDevice device = NetworkDevice::cpu;
  NetworkNumbers numbers = NetworkNumbers::float32;
  bool step_lengths = true;
};

// The repulsive layer behind the stepper (learned/steppers/refu_stepper.hpp). Members are described where keys are
// bound to them: pipeline/scene/config_run.cpp.
struct RefuRun {
  bool on = false;
  double alpha = 1;
  std::string weights;
  int edge_pass = 0;
  double order = 0.03;
};

// What a scene file says of the run beside the Scene itself. Members are described where keys are bound to them:
// pipeline/scene/config_run.cpp.
struct RunOptions {
  int frames = 60;
  double fps = 30;
  std::string quality = "standard";
  std::string stepper = "conventional";
  bool rest = true;
  std::string output;
  ConventionalOptions conventional;
  RecoveryOptions recovery;
  RestingOptions resting;
  IcmOptions icm;
  LearnedRun learned;
  HybridOptions hybrid;
  RefuRun refu;
};

}  // namespace selvedge
