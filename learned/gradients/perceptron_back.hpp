#pragma once

#include <functional>

#include "learned/gradients/training_tape.hpp"

namespace selvedge {

// Places in each part of the work: of the layers after the first, of all biases and of the norm.
struct PartPlaces {
  std::vector<int> layers, biases;
  int scale = 0, shift = 0;
};
PartPlaces add_places(GradientParts&, Perceptron& gradient);

// One perceptron in the backward pass.
struct PerceptronBack {
  const PackedPerceptron &forward, &backward;
  const PerceptronTape& tape;
  PartPlaces places;
};

// Goes back from the results of the tile at `slot` to the first layer's results before max(0, .). Takes derivatives
// from the thread's first rows and writes them to `to`. Adds those of weights, of biases after the first and of the
// norm to the part.
void back_to_first(const TrainingRun&, const PerceptronBack&, int slot, int rows, float* part, float* to,
                   int to_stride);

// Pointers to `count` contiguous rows, filled up to a whole tile.
void contiguous_rows(const float* first, int stride, int count, const float** rows);

// Adds outer products of `d` and the rows `input` to a matrix, and `d` to its bias unless that is null.
void add_outer(const TrainingRun&, const float* d, int stride, int results, const float* const* input, int inputs,
               int rows, float* out, float* bias);

// Multiplies the rows `d` with the transposed layer and adds them to `result`. Overwrites the thread's third rows.
void add_product(const TrainingRun&, const PackedLayer& transposed, const float* d, int stride, int rows,
                 float* const* result, int result_stride);

// Calls work(sums of the part, begin, end) in parallel for each part of the rows, then adds up the parts.
void for_parts(GradientParts&, int rows, int in_part, const std::function<void(float*, int, int)>& work);

// Calls work(sums of the part, begin, count) in parallel for each tile of the rows, then adds up the parts, of which
// there are as many as `tile_parts_of` says.
void for_tiles(GradientParts&, int rows, const std::function<void(float*, int, int)>& work);

}  // namespace selvedge
