#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "collision/geometry/adjacency.hpp"
#include "learned/repulsion/neural_distance.hpp"
#include "learned/repulsion/repulsive_layer.hpp"
#include "pipeline/drapes/drape_set.hpp"

namespace selvedge {

// One drape, and the distances of its body.
struct DrapeBody {
  DrapeSample sample;
  std::unique_ptr<DistanceField> field;  // of the posed body
  std::vector<int> faces;                // faces at which a search begins
  QueryMap query;                        // input of a distance network
  std::vector<float> condition;          // pose and shape
  std::unique_ptr<NeuralDistance> neural;

  AskDistance accurate();    // keeps a reference to this
  AskDistance by_network();  // as above; needs `neural`
};

struct DrapeLessons {
  std::unique_ptr<const DrapeSet> set;  // distances refer to it
  Adjacency ring;
  std::vector<std::unique_ptr<DrapeBody>> training, validation, test;
};
// `bones` selects the query of a distance network. The last `validation_paths` training paths are kept for validation.
// Throws Error where a part has no drapes.
DrapeLessons make_drape_lessons(const std::filesystem::path& drapes, int validation_paths, bool bones);

// Adds distances by the network to all bodies.
void use_network(const PlainNetwork&, DrapeLessons&);

}  // namespace selvedge
