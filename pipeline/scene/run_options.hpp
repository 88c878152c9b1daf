#pragma once

#include <string>

#include "learned/steppers/network_device.hpp"
#include "physics/steppers/conventional_stepper.hpp"
#include "physics/steppers/hybrid_stepper.hpp"
#include "physics/steppers/icm_stepper.hpp"
#include "physics/steppers/recovering_stepper.hpp"
#include "physics/steppers/resting_stepper.hpp"

namespace selvedge {

// Of the stepper `learned`.
struct LearnedRun {
  std::string weights;  // weight file, seen from the scene file's folder
  bool settle = false;
  NetworkDevice device = NetworkDevice::cpu;
};

// The repulsive layer behind the stepper (learned/steppers/refu_stepper.hpp).
struct RefuRun {
  bool on = false;
  double alpha = 1;
  std::string weights;  // of scales by neighbours, seen from the scene file's folder; empty: alpha
  int edge_pass = 0;    // rounds
  double order = 0.03;  // height over the body up to which cloth goes along with what is pushed [m]
};

// What a scene file says of the run beside the Scene itself.
struct RunOptions {
  int frames = 60;
  double fps = 30;
  std::string quality = "standard";  // quality.hpp
  std::string stepper = "conventional";
  bool rest = true;    // cloths that rest are left out
  std::string output;  // folder for the results; empty: chosen by the command
  ConventionalOptions conventional;
  RecoveryOptions recovery;
  RestingOptions resting;
  IcmOptions icm;
  LearnedRun learned;
  HybridOptions hybrid;
  RefuRun refu;
};

}  // namespace selvedge
