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
  int edge_pass = 0;        // rounds
  bool by_network = false;  // distances of what is done afterwards; the layer's row knows its own
};

// Means over the test drapes with halves of their 95 % intervals.
struct DrapeTableRow {
  std::string name;
  MeanOverModels vertex_error, inside, free, vertex_face, edge_edge, laplacian, overshoot, energy, pairs;
  MeanOverModels pushed, backbone_ms, distance_ms, push_ms, edges_ms;
  double alpha = 0, alpha_deviation = 0;  // of pushed vertices, of all drapes
  int judges_differ = 0;                  // drapes of which FCL and exact signs differ
  std::vector<double> error_by_drape;     // [mm]
  std::vector<double> inside_by_drape;    // [%]
  std::vector<double> energy_by_drape;    // [m2]
  // Of pushed vertices that are inside indeed: the distance that the layer was told over the accurate one, and alpha.
  std::vector<std::pair<double, double>> ratio_and_alpha;
};

// Where a way takes one drape of the lessons.
Points way_positions(const MeasuredWay&, const DrapeModel&, const DrapeTrainingOptions&, const DrapeLessons&,
                     DrapeBody&);

// Of every test drape. Distances that errors are told by are the accurate ones.
DrapeTableRow measure_row(const MeasuredWay&, const DrapeModel&, const DrapeTrainingOptions&, DrapeLessons&);

// A line a row: for people with intervals, and as CSV with everything.
std::string drape_table_text(const std::vector<DrapeTableRow>&);
std::string drape_table_csv(const std::vector<DrapeTableRow>&);

}  // namespace selvedge
