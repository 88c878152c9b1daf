#include "pipeline/measures/hood_measure.hpp"

#include "learned/losses/force_input.hpp"
#include "learned/steppers/learned_scene.hpp"
#include "learned/steppers/learned_state.hpp"
#include "pipeline/measures/minimise.hpp"

namespace selvedge {
namespace {

struct JudgedInputs {
  LossInputs inputs;
  Points velocity;
};

// Keeps references to all three.
void fill(const HoodJudge& judge, const JudgedFrame& frame, JudgedInputs& judged) {
  judged.velocity = frame.now - frame.before;
  LossInputs& inputs = judged.inputs;
  inputs.garment = &judge.garment;
  inputs.x = &frame.now;
  inputs.velocity = &judged.velocity;
  inputs.predicted = &frame.next;
  inputs.acceleration = &frame.acceleration;
  if (frame.body_now.rows() == 0) return;
  inputs.body = &judge.body;
  inputs.body_previous = &frame.body_before;
  inputs.body_now = &frame.body_now;
  inputs.body_next = &frame.body_next;
}

void hold_pins(const HoodJudge& judge, Points& gradient) {
  for (const int pin : judge.pins) gradient.row(pin).setZero();
}

}  // namespace

HoodJudge make_hood_judge(const Scene& scene) {
  HoodJudge judge;
  judge.garment = loss_garment(scene);
  judge.body = learned_scene(scene).graph.body;
  judge.pins = scene.pins;
  judge.losses = hood_losses();
  return judge;
}

HoodLosses hood_losses_of(HoodJudge& judge, const JudgedFrame& frame) {
  JudgedInputs judged;
  fill(judge, frame, judged);
  Points gradient = Points::Zero(frame.next.rows(), 3);
  HoodLosses losses;
  for (const LossTerm& term : add_losses(judged.inputs, judge.losses, judge.search, &gradient)) {
    losses.terms[term.name == "forces" ? "gravity" : term.name] = term.value;
    losses.total += term.value;
  }
  hold_pins(judge, gradient);
  const auto free = gradient.rows() - static_cast<Eigen::Index>(judge.pins.size());
  if (free > 0) losses.grad_norm = gradient.rowwise().norm().sum() / static_cast<double>(free);
  return losses;
}

Suboptimality suboptimality_of(HoodJudge& judge, const JudgedFrame& frame) {
  constexpr int most_evaluations = 300;
  JudgedInputs judged;
  fill(judge, frame, judged);
  const auto evaluate = [&](const Points& x, Points& gradient) {
    gradient.setZero(x.rows(), 3);
    judged.inputs.predicted = &x;
    const double sum = sum_of(add_losses(judged.inputs, judge.losses, judge.search, &gradient));
    hold_pins(judge, gradient);
    return sum;
  };
  Points gradient;
  Suboptimality found;
  const double here = evaluate(frame.next, gradient);
  found.residual = inverse_mass_norm(judge.garment, gradient);
  const std::vector<double> diagonal = jacobi_diagonal(judge.garment, learned_dt);
  found.excess = here - minimised(evaluate, diagonal, frame.next, most_evaluations).value;
  return found;
}

}  // namespace selvedge
