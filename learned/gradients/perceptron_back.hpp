#pragma once

#include <functional>

#include "learned/gradients/training_layout.hpp"
#include "learned/gradients/training_tape.hpp"

namespace selvedge {

// Places of a perceptron's layers behind the first, of all biases and of the norm, in each part of the work.
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

// From the derivatives by the results of the tile at `slot`, in the thread's first rows, to those by the first layer's
// results before max(0, .), which are written to `to`. Derivatives of weights, biases behind the first layer and norm
// are added to the part.
void back_to_first(const TrainingRun&, const PerceptronBack&, int slot, int rows, float* part, float* to,
                   int to_stride);

// Pointers to `count` rows, one behind the other.
void contiguous_rows(const float* first, int stride, int count, const float** rows);

// Adds outer products of `d` and the rows `input` to a matrix, and `d` to its bias unless that is null.
void add_outer(const TrainingRun&, const float* d, int stride, int results, const float* const* input, int inputs,
               int rows, float* out, float* bias);

// Rows of `result` += the transposed layer of the rows `d`. Overwrites the thread's third rows.
void add_product(const TrainingRun&, const PackedLayer& transposed, const float* d, int stride, int rows,
                 float* const* result, int result_stride);

// Calls work(part's sums, begin, end) for parts of `rows`, each by one thread, then adds up the parts.
void for_parts(GradientParts&, int rows, int in_part, const std::function<void(float*, int, int)>& work);

}  // namespace selvedge
