#include "pipeline/training/training_step.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <numbers>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "learned/graph/integration.hpp"
#include "learned/graph/unite_graphs.hpp"
#include "pipeline/processes/learning_sums.hpp"

namespace selvedge {
namespace {

// Calls `work` for every sample, on several threads where there are several. Throws what the first of them throws.
void for_samples(std::vector<Sample>& samples, const std::function<void(Sample&)>& work) {
  std::vector<std::exception_ptr> thrown(samples.size());
#pragma omp parallel for schedule(dynamic, 1) if (samples.size() > 1)
  for (std::size_t k = 0; k < samples.size(); ++k) try {
      work(samples[k]);
    } catch (...) {
      thrown[k] = std::current_exception();
    }
  for (const std::exception_ptr& one : thrown)
    if (one) std::rethrow_exception(one);
}

// Begins roll-outs until the state has one to go on with.
void begin_anew(Trainer& trainer, RollingState& state) {
  while (state.over) {
    Roll roll = trainer.queue->take();
    ask_for_roll(trainer);
    if (!roll.usable) continue;
    if (trainer.options.samples.start == GarmentStart::tangled && roll.request.cloth_contact &&
        roll.request.sheet == HungStart::none)
      trainer.start_pairs.push_back(roll.pairs);
    begin_roll(std::move(roll), state);
    set_guard(trainer.options, state);
  }
}

bool keeps_states(const Trainer& trainer) { return trainer.teacher && trainer.options.teacher.uses > 1; }

// Whether the step learns from states again. One of `uses` steps takes new ones. So do the first steps, until as many
// states are kept as one of them is used.
bool is_repetition(const Trainer& trainer) {
  const int uses = trainer.options.teacher.uses;
  const auto kept = static_cast<int>(trainer.taught.all.size());
  return keeps_states(trainer) &&
         kept >= std::min(std::max(uses, trainer.options.optimiser.batch), trainer.options.teacher.kept) &&
         trainer.counts.step % uses != 0;
}

// Draws as many different ones of the kept states as the batch has samples.
void draw_again(Trainer& trainer) {
  const int batch = trainer.options.optimiser.batch;
  trainer.samples.resize(static_cast<std::size_t>(batch));
  const std::vector<TaughtState*> drawn = trainer.taught.draw(trainer.random, batch);
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    Sample& sample = trainer.samples[k];
    sample.again = drawn[k];
    sample.state = &drawn[k]->state;
    sample.record = {};
    sample.record.pass = sample.state->pass;
  }
}

// Draws as many different states of the pool as the batch has samples.
void draw_samples(Trainer& trainer) {
  if (is_repetition(trainer)) return draw_again(trainer);
  std::vector<RollingState*> left;
  for (RollingState& state : trainer.pool) left.push_back(&state);
  trainer.samples.resize(static_cast<std::size_t>(trainer.options.optimiser.batch));
  for (Sample& sample : trainer.samples) {
    sample.again = nullptr;
    const auto drawn = left.begin() + trainer.random.below(static_cast<int>(left.size()));
    sample.state = *drawn;
    left.erase(drawn);
    begin_anew(trainer, *sample.state);
    if (trainer.teacher) trainer.teacher->ask(*sample.state);
    sample.record = {};
    sample.record.pass = sample.state->pass;
  }
  if (!trainer.teacher) return;
  for (Sample& sample : trainer.samples) sample.record.bad = trainer.teacher->wait(*sample.state).refused;
}

// Asks the teacher for the frames that the samples' states make next, so that they are there when they are drawn.
void ask_ahead(Trainer& trainer) {
  for (Sample& sample : trainer.samples) {
    if (sample.again) continue;
    begin_anew(trainer, *sample.state);
    trainer.teacher->ask(*sample.state);
  }
}

// Makes the normalised graphs of all samples. Statistics are gathered on unless they are frozen.
void make_graphs(Trainer& trainer, const FrameMaking& making) {
  FeatureTables& tables = trainer.network.weights.tables;
  for_samples(trainer.samples, [&](Sample& sample) {
    if (!sample.record.bad.empty()) return;
    if (sample.again) {
      sample.graph = sample.again->raw;
      return;
    }
    if (!raw_graph_of(making, tables, *sample.state, sample.graph)) sample.record.bad = sample.state->found.refused;
    if (keeps_states(trainer) && sample.record.bad.empty()) sample.kept = taught_copy(*sample.state, sample.graph);
  });
  if (!trainer.options.optimiser.freeze_statistics && trainer.options.weights.empty()) {
    FeatureSums<double> of_step = empty_sums(making.features);  // where others add theirs
    for (const Sample& sample : trainer.samples) {
      if (!sample.record.bad.empty() || sample.again) continue;
      const RollingState& state = *sample.state;
      gather(making.features, sample.graph, target_accelerations(state.roll.scene->rest, state.now, making.features),
             trainer.processes ? of_step : trainer.sums);
    }
    if (trainer.processes) add_statistics(*trainer.processes, of_step, trainer.sums);
    freeze_statistics(trainer.sums, tables);
  }
  for_samples(trainer.samples, [&](Sample& sample) {
    if (sample.record.bad.empty()) normalise(making.features, tables, sample.graph);
  });
}

std::vector<const Graph*> good_graphs(const std::vector<Sample>& samples) {
  std::vector<const Graph*> graphs;
  for (const Sample& sample : samples)
    if (sample.record.bad.empty()) graphs.push_back(&sample.graph);
  return graphs;
}

// The derivative of the sample's objective by the network's output. Returns false if it is not finite.
bool output_gradient(const Trainer& trainer, const RollingState& state, Points gradient, FeatureRows& d_output) {
  const TrainingScene& scene = *state.roll.scene;
  gradient = by_acceleration(scene.rest, state.now, trainer.architecture.features, std::move(gradient));
  const std::vector<float>& deviation = trainer.network.weights.tables.output.deviation;
  double scale = 1;
  if (trainer.options.optimiser.normalise_samples) {
    // Divides the gradient by its norm over the inverse masses, so that the lengths of its rows sum up to about one.
    double mass = 0;
    for (const double m : scene.losses.mass) mass += m;
    mass /= static_cast<double>(scene.losses.mass.size());
    const double size = inverse_mass_norm(scene.losses, gradient);
    const double unit = (static_cast<double>(deviation[0]) + deviation[1] + deviation[2]) / 3;
    scale = 1 / (size * std::sqrt(mass) * unit);
    if (!std::isfinite(scale)) return false;
  }
  d_output.resize(gradient.rows(), 3);
  for (Eigen::Index k = 0; k < 3; ++k)
    d_output.col(k) =
        (scale * static_cast<double>(deviation[static_cast<std::size_t>(k)]) * gradient.col(k)).cast<float>();
  return d_output.allFinite();
}

bool are_finite(const std::vector<LossTerm>& terms) {
  for (const LossTerm& term : terms)
    if (!std::isfinite(term.value) || !std::isfinite(term.gradient_norm)) return false;
  return true;
}

// The losses of what the network has made of the sample, and their gradient.
void take_losses(const Trainer& trainer, const FrameMaking& making, const FeatureRows& output, Sample& sample) {
  RollingState& state = *sample.state;
  const TrainingScene& scene = *state.roll.scene;
  sample.next = integrate(scene.rest, state.now, making.features, trainer.network.weights.tables.output, output);
  const SeenPositions seen = seen_positions(scene.rest, state.now, making.features);
  Points gradient = Points::Zero(sample.next.x.rows(), 3);
  SampleRecord& record = sample.record;
  record.terms = add_losses_with_share(inputs_of(state, seen, sample.next.x, making.progress), making.losses,
                                       state.losses, gradient);
  record.sum = sum_of(record.terms);
  if (!output.allFinite() || !are_finite(record.terms) || !output_gradient(trainer, state, gradient, sample.d_output))
    record.bad = "a loss or its gradient is not finite";
}

FeatureRows forward(Trainer& trainer, const Graph& graph) {
  return trainer.torch ? trainer.torch->run_forward(graph) : run_forward(trainer.network, graph, trainer.tape);
}

void backward(Trainer& trainer, const Graph& graph, const FeatureRows& d_output) {
  set_zero(trainer.architecture, trainer.gradients);
  if (trainer.torch)
    trainer.torch->run_backward(graph, trainer.network.weights.tables, d_output, trainer.gradients);
  else
    run_backward(trainer.network, graph, trainer.tape, d_output, trainer.gradients);
}

// Runs the network on the good samples as one graph and takes their losses. Where that drops some it does so again with
// the others, for numbers that are not finite would spread through the backward run. Returns the graph; null if no
// sample is good.
const Graph* forward_with_losses(Trainer& trainer, const FrameMaking& making) {
  for (;;) {
    const std::vector<const Graph*> graphs = good_graphs(trainer.samples);
    if (graphs.empty()) return nullptr;
    if (graphs.size() > 1) unite_graphs(graphs, trainer.graph);
    const Graph& graph = graphs.size() > 1 ? trainer.graph : *graphs.front();
    const FeatureRows output = forward(trainer, graph);
    std::vector<Eigen::Index> first;
    Eigen::Index next = 0;
    for (const Sample& sample : trainer.samples) {
      first.push_back(next);
      if (sample.record.bad.empty()) next += sample.graph.cloth_nodes;
    }
    for_samples(trainer.samples, [&](Sample& sample) {
      if (!sample.record.bad.empty()) return;
      const auto k = static_cast<std::size_t>(&sample - trainer.samples.data());
      take_losses(trainer, making, output.middleRows(first[k], sample.graph.cloth_nodes), sample);
    });
    if (good_graphs(trainer.samples).size() == graphs.size()) return &graph;
  }
}

AdamOptions adam_options(const Trainer& trainer) {
  const OptimiserOptions& options = trainer.options.optimiser;
  AdamOptions adam;
  adam.learning_rate = options.learning_rate * learning_factor(options.decay, progress_of(trainer), trainer.counts.step,
                                                               options.halving_steps, options.floor);
  (options.clip_median ? adam.clip_median : adam.clip_norm) = options.clip;
  return adam;
}

// Forward, losses and backward. Returns the number of good samples, of which the gradients are the mean.
int take_gradients(Trainer& trainer, const FrameMaking& making) {
  make_graphs(trainer, making);
  const Graph* graph = forward_with_losses(trainer, making);
  if (!graph) return 0;
  FeatureRows d_output(graph->cloth_nodes, 3);
  Eigen::Index next = 0;
  const auto count = static_cast<float>(good_graphs(trainer.samples).size());
  for (const Sample& sample : trainer.samples) {
    if (!sample.record.bad.empty()) continue;
    d_output.middleRows(next, sample.graph.cloth_nodes) = sample.d_output / count;
    next += sample.graph.cloth_nodes;
  }
  backward(trainer, *graph, d_output);
  return static_cast<int>(count);
}

// Gradients of this process and of all others, and the optimiser.
AdamReport learn(Trainer& trainer, const FrameMaking& making) {
  int samples = take_gradients(trainer, making);
  if (trainer.processes)
    samples = average_gradients(*trainer.processes, trainer.architecture, samples, trainer.gradients);
  if (samples == 0) return {.taken = false};
  const AdamReport adam =
      adam_step(trainer.architecture, adam_options(trainer), trainer.gradients, trainer.adam, trainer.network.weights);
  if (adam.taken) place_network(trainer);
  for (Sample& sample : trainer.samples)
    if (!adam.taken && sample.record.bad.empty()) sample.record.bad = "the gradient of the weights is not finite";
  return adam;
}

void count_bad(Trainer& trainer, Sample& sample) {
  sample.state->over = true;
  ++trainer.counts.bad;
  if (++trainer.counts.bad_in_a_row > trainer.options.watch.most_bad_samples)
    throw Error(fmt::format("{} samples in a row had no finite loss, the last: {}", trainer.counts.bad_in_a_row,
                            sample.record.bad),
                "training " + trainer.options.name,
                "take a smaller learning rate, or go on from an earlier checkpoint with another seed");
}

// Advances the states of the samples to their next pass or frame.
void advance(Trainer& trainer, const FrameMaking& making) {
  const PoolOptions& pool = trainer.options.pool;
  std::vector<char> given_up(trainer.samples.size(), 0);
  for_samples(trainer.samples, [&](Sample& sample) {
    if (!sample.record.bad.empty() || sample.again) return;
    RollingState& state = *sample.state;
    const bool last_pass = state.pass + 1 == making.passes;
    if (last_pass && pool.gate > 0) sample.next = gated(making, pool.gate, sample.next, state);
    if (last_pass && !(pass_guard(making, state, sample.next) && pass_behind(state, sample.next)))
      given_up[static_cast<std::size_t>(&sample - trainer.samples.data())] = 1;
    else
      take_pass(making, sample.next, pool.reset_distance, state);
  });
  for (std::size_t k = 0; k < trainer.samples.size(); ++k) {
    Sample& sample = trainer.samples[k];
    if (!sample.record.bad.empty()) {
      count_bad(trainer, sample);
      continue;
    }
    trainer.counts.bad_in_a_row = 0;
    if (sample.again) {
      ++trainer.counts.again;
      continue;
    }
    if (sample.kept) trainer.taught.add(std::move(sample.kept));
    RollingState& state = *sample.state;
    if (given_up[k]) {
      ++trainer.counts.given_up;
      state.over = true;
      continue;
    }
    if (sample.record.pass + 1 == making.passes) ++trainer.counts.frames;
    if (state.over && state.frame < state.roll.request.frames) ++trainer.counts.lost;
  }
  if (trainer.teacher) ask_ahead(trainer);
}

}  // namespace

double learning_factor(Decay decay, double progress, long step, long halving_steps, double floor) {
  if (decay == Decay::cosine) return 0.5 * (1 + std::cos(std::numbers::pi * std::clamp(progress, 0.0, 1.0)));
  if (decay == Decay::none) return 1;
  return std::pow(0.5, static_cast<double>(step / std::max(halving_steps, 1L))) + floor;
}

StepRecord train_step(Trainer& trainer) {
  draw_samples(trainer);
  const FrameMaking making = frame_making(trainer);
  StepRecord record;
  record.adam = learn(trainer, making);
  if (record.adam.taken) ++trainer.counts.step;
  advance(trainer, making);
  for (const Sample& sample : trainer.samples) record.samples.push_back(sample.record);
  return record;
}

}  // namespace selvedge
