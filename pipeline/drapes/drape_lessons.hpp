#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "collision/geometry/adjacency.hpp"
#include "learned/repulsion/neural_distance.hpp"
#include "learned/repulsion/repulsive_layer.hpp"
#include "pipeline/drapes/drape_path_hdf5.hpp"

namespace selvedge {

// One drape, and the distances of its body.
struct DrapeBody {
  DrapeSample sample;
  std::unique_ptr<DistanceField> field;  // of the body as it stands there
  std::vector<int> faces;                // where a search begins
  QueryMap query;                        // of a network of distances
  std::vector<float> condition;          // pose and shape
  std::unique_ptr<NeuralDistance> neural;

  AskDistance accurate();    // keeps a reference
  AskDistance by_network();  // the same; needs `neural`
};

struct DrapeLessons {
  std::unique_ptr<const DrapeSet> set;  // distances point into it
  Adjacency ring;
  std::vector<std::unique_ptr<DrapeBody>> training, validation, test;
};
// `bones`: what a network of distances reads. The last `validation_paths` of those to train on are kept apart. Throws
// Error where a part has no drapes.
DrapeLessons make_drape_lessons(const std::filesystem::path& drapes, int validation_paths, bool bones);

// Has the bodies' distances answered by the network as well.
void use_network(const PlainNetwork&, DrapeLessons&);

}  // namespace selvedge
