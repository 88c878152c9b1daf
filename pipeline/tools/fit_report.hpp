#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/measures/fit.hpp"

namespace selvedge {

struct FitRequest {
  std::filesystem::path run;      // trajectory, or the folder of a run.h5
  std::filesystem::path scene;    // that the run was made of; empty: config.yaml beside the trajectory
  std::string body;               // name of an obstacle; empty: the first body, or the only obstacle
  std::filesystem::path regions;  // JSON, lists of the body's vertices by name; empty: the body's joints
  int frame = -1;                 // -1: the last
  double reach = 0;               // what is nearer touches the skin [m]; 0: twice the scene's contact thickness
  std::filesystem::path out;      // page; empty: none
};

struct FitReport {
  std::string run, body, regions;  // by what: `joints`, a file's name, or `whole`
  int frame = 0;
  double time = 0;  // [s]
  FitMeasures measures;
};

// Reads a run and its scene, measures how it fits the body, and writes the page. Throws Error for a frame, an obstacle
// or regions that are not there, a scene of other cloth, and positions that are not finite.
FitReport fit(const FitRequest&);

std::string fit_text(const FitReport&);
std::string fit_json(const FitReport&);

}  // namespace selvedge
