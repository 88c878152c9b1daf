#include "pipeline/training/own_states_hdf5.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

namespace selvedge {
namespace {

using FieldsOut = h5::SummedFieldsOut;
using FieldsIn = TrainingFieldsIn;

// The numbers of a roll-out in the order of the file.
template <class Request, class Visit>
void visit_request(Request& r, const Visit& visit) {
  const auto visit_all = [&visit](auto&... fields) { (visit(fields), ...); };
  visit_all(r.number, r.wear, r.body, r.clip, r.first_frame, r.frames, r.still, r.mirrored, r.with_body,
            r.cloth_contact, r.yaw, r.sheet, r.wind, r.force[0], r.force[1], r.force[2], r.simulated, r.noise);
}

std::vector<double> numbers_of(const RollRequest& request) {
  std::vector<double> numbers;
  visit_request(request, [&numbers](const auto& field) { numbers.push_back(static_cast<double>(field)); });
  return numbers;
}

constexpr std::size_t request_numbers = 18;

RollRequest request_of(const FieldsIn& in, const TrainingWorld& world, std::span<const double> n) {
  if (!std::ranges::all_of(n.first(request_numbers), [](double v) { return std::isfinite(v); }))
    in.fail("has a roll-out of numbers that are not finite");
  RollRequest r;
  std::size_t at = 0;
  visit_request(r, [&]<class Field>(Field& field) {
    const double number = n[at++];
    if constexpr (std::is_same_v<Field, double>)
      field = number;
    else if constexpr (std::is_same_v<Field, bool>)
      field = number != 0;
    else
      field = static_cast<Field>(in.whole("roll-out", number, sizeof(Field) > 4 ? 1e15 : 1e9));
  });
  const bool known = r.wear < int(world.wear.size()) && r.body < int(world.bodies.size()) &&
                     world.wear[std::size_t(r.wear)].person == world.bodies[std::size_t(r.body)].person &&
                     r.clip < int(world.bodies[std::size_t(r.body)].clips.size()) && r.frames >= 1 &&
                     r.frames < 100000 && r.simulated < 100000 && r.sheet <= HungStart::folded;
  if (!known) in.fail("names a roll-out that the configuration does not have");
  return r;
}

// A roll-out in progress: its request, whether it is over, and unless it is the place in it.
void write_rolling(FieldsOut& out, const std::string& name, const RollingState& state) {
  std::vector<double> numbers = numbers_of(state.roll.request);
  const KeptRolling kept_state = kept(state);
  numbers.insert(numbers.end(), {double(state.over), double(kept_state.frame), double(kept_state.pass)});
  out.numbers(name + "roll", numbers);
  if (state.over) return;
  out.points(name + "x", kept_state.x);
  out.points(name + "previous", kept_state.previous);
  out.points(name + "velocity", kept_state.velocity);
  out.points(name + "guess", kept_state.guess);
}

void write_pool(FieldsOut& out, const Trainer& trainer) {
  std::vector<double> waiting;
  for (const RollRequest& request : trainer.queue->waiting()) {
    const std::vector<double> numbers = numbers_of(request);
    waiting.insert(waiting.end(), numbers.begin(), numbers.end());
  }
  out.numbers("waiting", waiting);
  for (std::size_t k = 0; k < trainer.pool.size(); ++k)
    write_rolling(out, fmt::format("state_{}_", k), trainer.pool[k]);
}

// What write_rolling wrote.
struct WrittenRolling {
  bool over = true;
  RollRequest request;
  KeptRolling kept;
};

WrittenRolling read_rolling(FieldsIn& in, const std::string& name, const TrainingWorld& world) {
  const std::vector<double> numbers = in.numbers(name + "roll");
  if (numbers.size() != request_numbers + 3) in.fail("the field `" + name + "roll` has another length");
  if (numbers[request_numbers] != 0) return {};
  const auto integer = [&](std::size_t n) { return int(in.whole(name + "roll", numbers[request_numbers + n], 1e9)); };
  return {false,
          request_of(in, world, numbers),
          {integer(1), integer(2), in.points(name + "x"), in.points(name + "previous"), in.points(name + "velocity"),
           in.points(name + "guess")}};
}

// The roll-out is prepared without the frames that the solver made before its start, which is long past.
void ask_to_go_on(RollRequest request, Trainer& trainer) {
  request.simulated = 0;
  trainer.queue->ask(request);
}

// Goes on with the roll-out that was asked for.
void go_on(const FieldsIn& in, const WrittenRolling& written, Trainer& trainer, RollingState& state) {
  Roll roll = trainer.queue->take();
  roll.request = written.request;
  const Eigen::Index rows = roll.start.rows();
  const KeptRolling& from = written.kept;
  if (from.x.rows() != rows || from.previous.rows() != rows || from.velocity.rows() != rows ||
      (from.guess.rows() != rows && from.guess.rows() != 0) || from.frame >= roll.request.frames ||
      from.pass >= trainer.architecture.passes)
    in.fail("has a state that does not fit its garment");
  resume_roll(std::move(roll), from, state);
}

// Prepares the roll-outs again.
void read_pool(FieldsIn& in, Trainer& trainer) {
  const std::vector<double> waiting = in.numbers("waiting");
  std::vector<WrittenRolling> states;
  for (std::size_t k = 0; k < trainer.pool.size(); ++k) {
    states.push_back(read_rolling(in, fmt::format("state_{}_", k), trainer.maker->world));
    if (!states.back().over) ask_to_go_on(states.back().request, trainer);
  }
  for (std::size_t k = 0; k < states.size(); ++k) {
    if (states[k].over) continue;
    go_on(in, states[k], trainer, trainer.pool[k]);
    set_guard(trainer.options, trainer.pool[k]);
  }
  for (std::size_t k = 0; k + request_numbers <= waiting.size(); k += request_numbers)
    trainer.queue->ask(request_of(in, trainer.maker->world, std::span(waiting).subspan(k)));
}

void write_taught(FieldsOut& out, const TaughtStates& taught) {
  out.numbers("taught", {double(taught.all.size()), double(taught.oldest)});
  for (std::size_t k = 0; k < taught.all.size(); ++k) {
    const std::string name = fmt::format("taught_{}_", k);
    write_rolling(out, name, taught.all[k]->state);
    out.points(name + "target", taught.all[k]->state.taught.get().x);
  }
}

// Makes what the network sees of the states again.
void read_taught(FieldsIn& in, Trainer& trainer) {
  const std::vector<double> numbers = in.numbers("taught");
  if (numbers.size() != 2) in.fail("the field `taught` has another length");
  const std::int64_t count = in.whole("taught", numbers[0], double(trainer.taught.most));
  trainer.taught.oldest = std::size_t(in.whole("taught", numbers[1], double(trainer.taught.most) - 1));
  const FrameMaking making = frame_making(trainer);
  for (std::int64_t k = 0; k < count; ++k) {
    const std::string name = fmt::format("taught_{}_", k);
    const WrittenRolling written = read_rolling(in, name, trainer.maker->world);
    Points target = in.points(name + "target");
    if (written.over || target.rows() != written.kept.x.rows()) in.fail("has a target that does not fit its state");
    RollingState state;
    ask_to_go_on(written.request, trainer);
    go_on(in, written, trainer, state);
    state.taught = made_target(std::move(target));
    Graph raw;
    if (!raw_graph_of(making, trainer.network.weights.tables, state, raw)) in.fail("has a state without a graph");
    trainer.taught.all.push_back(taught_copy(state, std::move(raw)));
  }
}

}  // namespace

void write_own_states(h5::SummedFieldsOut& out, const Trainer& trainer) {
  write_taught(out, trainer.taught);
  write_pool(out, trainer);
}

void read_own_states(TrainingFieldsIn& in, Trainer& trainer) {
  read_taught(in, trainer);
  read_pool(in, trainer);
}

}  // namespace selvedge
