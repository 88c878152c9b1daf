#pragma once

#include <filesystem>
#include <string>

#include "pipeline/measures/fit.hpp"

namespace selvedge {

struct FitRequest {
  std::filesystem::path run;      // trajectory, or the folder of a run.h5
  std::filesystem::path scene;    // scene of the run; empty: config.yaml beside the trajectory
  std::string body;               // name of an obstacle; empty: the first body, or the only obstacle
  std::filesystem::path regions;  // JSON: lists of the body's vertices by name; empty: the body's joints
  int frame = -1;                 // -1: the last one
  double reach = 0;           // distance at which cloth touches the skin [m]; 0: twice the scene's contact thickness
  std::filesystem::path out;  // file of the page; empty: none
};

struct FitReport {
  std::string run, body, regions;  // regions: `joints`, a file's name, or `whole`
  int frame = 0;
  double time = 0;  // [s]
  FitMeasures measures;
};

// Reads a run and its scene, measures the fit on the body, and writes the page. Throws Error for a missing frame,
// obstacle or region, a scene with other cloth, and positions that are not finite.
FitReport fit(const FitRequest&);

std::string fit_text(const FitReport&);
std::string fit_json(const FitReport&);

}  // namespace selvedge
