#pragma once

#include "pipeline/drapes/drape_stages.hpp"
#include "pipeline/tools/garment_errors.hpp"

namespace selvedge {

// Post-processing of a predicted drape. naive: a push of scale 1. smooth: push_smoothly.
enum class PostProcessing { nothing, naive, smooth };

// The treatment of a predicted drape's collisions in a row of the table.
struct CollisionMethod {
  std::string name;
  const DrapeRow* row = nullptr;  // row whose layer follows the network; null: no layer
  PostProcessing after = PostProcessing::nothing;
  int edge_pass = 0;        // number of rounds
  bool by_network = false;  // post-processing uses a distance network; the layer uses what its row says
};

// Means over the test drapes with half widths of their 95 % intervals.
struct DrapeTableRow {
  std::string name;
  MeanOverModels vertex_error, inside, free, vertex_face, edge_edge, laplacian, overshoot, energy, pairs;
  MeanOverModels pushed, backbone_ms, distance_ms, push_ms, edges_ms;
  double alpha = 0, alpha_deviation = 0;  // of all pushed vertices
  int judges_differ = 0;                  // number of drapes on which FCL and exact signs differ
  std::vector<double> error_by_drape;     // [mm]
  std::vector<double> inside_by_drape;    // [%]
  std::vector<double> energy_by_drape;    // [m2]
  // For pushed vertices that are inside: the layer's distance divided by the exact one, and alpha.
  std::vector<std::pair<double, double>> ratio_and_alpha;
};

// The positions of one drape after the method.
Points method_positions(const CollisionMethod&, const DrapeModel&, const DrapeTrainingOptions&, const DrapeLessons&,
                        DrapeBody&);

// Measures the method on every test drape. Errors are measured with accurate distances.
DrapeTableRow measure_row(const CollisionMethod&, const DrapeModel&, const DrapeTrainingOptions&, DrapeLessons&);

// One line per row: with intervals for people, and everything as CSV.
std::string drape_table_text(const std::vector<DrapeTableRow>&);
std::string drape_table_csv(const std::vector<DrapeTableRow>&);

}  // namespace selvedge
