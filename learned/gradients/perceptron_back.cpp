#include "learned/gradients/perceptron_back.hpp"

#include <algorithm>

namespace selvedge {

PartPlaces add_places(GradientParts& parts, Perceptron& gradient) {
  PartPlaces places;
  for (std::size_t layer = 0; layer < gradient.layers.size(); ++layer) {
    AffineLayer& affine = gradient.layers[layer];
    if (layer > 0) places.layers.push_back(parts.add(affine.weight, 0, affine.weight.cols()));
    places.biases.push_back(parts.add(affine.bias));
  }
  if (!gradient.scale.empty()) {
    places.scale = parts.add(gradient.scale);
    places.shift = parts.add(gradient.shift);
  }
  return places;
}

void add_outer(const TrainingRun& run, const float* d, int stride, int results, const float* const* input, int inputs,
               int rows, float* out, float* bias) {
  run.training.outer({d, stride, padded(results), input, padded(inputs), out, bias, rows});
}

void contiguous_rows(const float* first, int stride, int count, const float** rows) {
  for (int r = 0; r < count; ++r) rows[r] = first + static_cast<std::ptrdiff_t>(r) * stride;
  fill_rows_up(rows, count);
}

void back_to_first(const TrainingRun& run, const PerceptronBack& p, int slot, int rows, float* part, float* to,
                   int to_stride) {
  ThreadRows& mine = run.thread_rows();
  float *d = mine.first.row(0), *other = mine.second.row(0);
  int stride = mine.first.stride;
  if (p.forward.scale.size() > 0)
    run.training.norm_back({d, stride, p.forward.outputs, rows, p.tape.values.row(slot), p.tape.values.stride,
                            p.tape.factor.data() + slot, p.forward.scale.data(), part + p.places.scale,
                            part + p.places.shift});
  const float* input[training_rows];
  for (std::size_t layer = p.backward.layers.size(); layer-- > 0;) {
    const PackedLayer& transposed = p.backward.layers[layer];
    const LatentRows& hidden = p.tape.hidden[layer];
    for (int r = 0; r < rows; ++r) input[r] = hidden.row(slot + r);
    add_outer(run, d, stride, transposed.inputs, input, run.width(), rows, part + p.places.layers[layer],
              part + p.places.biases[layer + 1]);
    contiguous_rows(d, stride, rows, input);
    LayerTile tile = transposed.tile(input, layer == 0 ? to : other, layer == 0 ? to_stride : stride, rows);
    tile.mask = hidden.row(slot);
    tile.mask_stride = hidden.stride;
    run.kernels.multiply(tile);
    std::swap(d, other);
  }
}

void add_product(const TrainingRun& run, const PackedLayer& transposed, const float* d, int stride, int rows,
                 float* const* result, int result_stride) {
  LatentRows& mine = run.thread_rows().third;
  const float* input[training_rows];
  contiguous_rows(d, stride, rows, input);
  run.kernels.multiply(transposed.tile(input, mine.row(0), mine.stride, rows));
  run.training.add({mine.row(0), mine.stride, result_stride, rows, result});
}

void for_parts(GradientParts& parts, int rows, int in_part, const std::function<void(float*, int, int)>& work) {
  const int count = tiles_of(rows, in_part);
#pragma omp parallel for schedule(dynamic, 1)
  for (int part = 0; part < count; ++part)
    work(parts.start(part), part * in_part, std::min(rows, (part + 1) * in_part));
  parts.finish();
}

void for_tiles(GradientParts& parts, int rows, const std::function<void(float*, int, int)>& work) {
  for_parts(parts, rows, rows_in_part(rows), [&work](float* part, int from, int end) {
    for (int begin = from; begin < end; begin += training_rows) work(part, begin, std::min(training_rows, end - begin));
  });
}

}  // namespace selvedge
