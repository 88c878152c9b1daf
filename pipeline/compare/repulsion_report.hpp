#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "learned/repulsion/neural_distance.hpp"
#include "pipeline/compare/comparison.hpp"
#include "pipeline/drapes/drape_table.hpp"

namespace selvedge {

// A finished training of drapes, measured, or why it was left out.
struct MeasuredDrapes {
  std::string name;
  std::string trouble;  // empty: nothing
  DrapesUse use = DrapesUse::garments;
  bool counted = true;  // in the means over all garments
  int vertices = 0, training = 0, test = 0;
  int shapes = 0;                           // that were trained on
  std::map<std::string, int> dropped = {};  // drapes, by reason
  std::vector<DrapeTableRow> rows = {};
  std::optional<DistanceErrors> distance = {};  // by a network, of the bodies to measure on
  std::vector<double> from_training = {};       // of each test drape: parameters from the nearest one trained on
};

// Mean over the garments that have such a row, weighted by their test models, with half of its 95 % interval.
struct MeanOverGarments {
  MeanOverModels value, backbone;  // of the same garments
  int garments = 0;
};
MeanOverGarments mean_over_garments(const std::vector<MeasuredDrapes>&, const std::string& row,
                                    MeanOverModels DrapeTableRow::*metric);

// Tables 1 to 9 of Tan et al. 2022 in form, and one of passes over edges. What has no data is left out, with a line
// that says why. Trends are those of the rows as they are printed.
std::string repulsion_tables(const std::vector<MeasuredDrapes>&);
// Their figures 6 to 9 as SVG: penetration energies, scale by the ratio of approximate and accurate distance, vertices
// inside by the distance from what was trained on.
std::string repulsion_figures(const std::vector<MeasuredDrapes>&);

}  // namespace selvedge
