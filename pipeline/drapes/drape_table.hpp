#pragma once

#include "pipeline/drapes/drape_stages.hpp"
#include "pipeline/tools/garment_errors.hpp"

namespace selvedge {

// Post-processing of a predicted drape. naive: a push of scale 1. smooth: push_smoothly.
enum class PostProcessing { nothing, naive, smooth };

// How collisions of a predicted drape are handled when a row of the table is measured.
struct CollisionMethod {
  std::string name;
  const DrapeRow* row = nullptr;  // the row whose layer is behind the network; null: no layer
  PostProcessing after = PostProcessing::nothing;
  int edge_pass = 0;        // rounds
  bool by_network = false;  // post-processing reads distances by a network; the layer reads those of its row
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

// The positions of one drape after the method.
Points method_positions(const CollisionMethod&, const DrapeModel&, const DrapeTrainingOptions&, const DrapeLessons&,
                        DrapeBody&);

// Measures the method on every test drape. Errors are measured with accurate distances.
DrapeTableRow measure_row(const CollisionMethod&, const DrapeModel&, const DrapeTrainingOptions&, DrapeLessons&);

// A line a row: for people with intervals, and as CSV with everything.
std::string drape_table_text(const std::vector<DrapeTableRow>&);
std::string drape_table_csv(const std::vector<DrapeTableRow>&);

}  // namespace selvedge
