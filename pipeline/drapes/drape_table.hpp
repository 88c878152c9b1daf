#pragma once

#include "pipeline/drapes/drape_stages.hpp"
#include "pipeline/tools/garment_errors.hpp"

namespace selvedge {

// What is done to one predicted drape when it is measured.
enum class AfterDrape { nothing, naive, smooth };  // naive: scale 1, accurate; smooth: push_smoothly
struct MeasuredWay {
  std::string name;
  const DrapeRow* row = nullptr;  // the layer; null: none
  AfterDrape after = AfterDrape::nothing;
  int edge_pass = 0;  // rounds
};

// Means over the test drapes with halves of their 95 % intervals.
struct DrapeTableRow {
  std::string name;
  MeanOverModels vertex_error, inside, free, vertex_face, edge_edge, laplacian, overshoot, energy, pairs;
  MeanOverModels pushed, backbone_ms, distance_ms, push_ms, edges_ms;
  double alpha = 0, alpha_deviation = 0;  // of pushed vertices, of all drapes
  int judges_differ = 0;                  // drapes of which FCL and exact signs differ
  std::vector<double> error_by_drape;     // [mm]
};

// Of every test drape. Distances that errors are told by are the accurate ones.
DrapeTableRow measure_row(const MeasuredWay&, const DrapeModel&, const DrapeTrainingOptions&, DrapeLessons&);

// A line a row: for people with intervals, and as CSV with everything.
std::string drape_table_text(const std::vector<DrapeTableRow>&);
std::string drape_table_csv(const std::vector<DrapeTableRow>&);

}  // namespace selvedge
