#include "pipeline/training/trainer.hpp"

#include <algorithm>
#include <utility>

#include "collision/geometry/error.hpp"
#include "learned/graph/integration.hpp"
#include "learned/network/architecture_text.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "learned/network/widen_weights.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/processes/learning_sums.hpp"
#include "pipeline/processes/together.hpp"

namespace selvedge {
namespace {

// Weights of an earlier stage, or of a network with fewer inputs. Features that stages may change are not compared. The
// earlier stage's record is added to `on`.
NetworkWeights first_weights(const TrainingOptions& options, const Architecture& architecture, TrainedOn& on) {
  if (options.weights.empty()) return initial_weights(architecture, options.seed, options.optimiser.decoder_scale);
  WeightFile file = read_weight_file(weights_path(options));
  add_earlier(file.trained_on, weights_path(options).string() + ": trained_on", on);
  Architecture& theirs = file.architecture;
  const FeatureOptions &ours = architecture.features, had = theirs.features;
  theirs.name = architecture.name;
  theirs.features.contours = ours.contours;
  theirs.features.contour_force = ours.contour_force;
  theirs.features.attraction_edges = ours.attraction_edges;
  theirs.features.space = ours.space;
  theirs.passes = architecture.passes;
  if (architecture_text(theirs) == architecture_text(architecture)) return std::move(file.weights);
  Architecture wide = theirs;
  wide.features.cloth_edges = ours.cloth_edges;
  wide.features.acceleration_inputs = ours.acceleration_inputs;
  wide.features.space_edges = ours.space_edges;
  wide.node_inputs = architecture.node_inputs;
  wide.encoders = architecture.encoders;
  wide.edge_kinds = architecture.edge_kinds;
  wide.steps = architecture.steps;
  wide.statistics = architecture.statistics;
  const bool sees_more =
      (ours.acceleration_inputs && !had.acceleration_inputs) || (ours.space_edges && !had.space_edges);
  if (!sees_more || architecture_text(wide) != architecture_text(architecture))
    throw Error("holds weights of another network than `" + architecture.name + "` as configured",
                weights_path(options).string(),
                "give the architecture, width and message_steps that they were trained with");
  return widen_weights(theirs, file.weights, architecture, options.seed);
}

// Adds one state to the sums of the statistics, in its first pass. Half of the states of networks with several passes
// are in their second pass, with a random guess between free flight and the skinned garment.
void gather_state(Trainer& trainer, RollingState& state) {
  const FrameMaking making = frame_making(trainer);
  const TrainingScene& scene = *state.roll.scene;
  if (making.passes > 1 && trainer.random.heads(0.5)) {
    const SeenPositions seen = seen_positions(scene.rest, state.now, making.features);
    Points guess = inertial_guess(scene.rest, state.now, seen, making.features);
    const double part = trainer.random.uniform();
    guess += part * (state.now.target - guess).eval();
    state.now.guess = std::move(guess);
    state.now.pass = state.pass = 1;
  }
  if (!raw_graph_of(making, trainer.network.weights.tables, state, trainer.graph)) return;
  gather(making.features, trainer.graph, target_accelerations(scene.rest, state.now, making.features), trainer.sums);
}

// Each process gathers its share.
void gather_warm_up(Trainer& trainer) {
  const int count = process_count(trainer), states = (trainer.options.optimiser.warm_up + count - 1) / count;
  for (int k = 0; k < std::min(states, rolls_ahead); ++k) ask_for_roll(trainer);
  RollingState state;
  for (int k = 0; k < states; ++k) {
    begin_roll(trainer.queue->take(), state);
    if (k + rolls_ahead < states) ask_for_roll(trainer);
    gather_state(trainer, state);
  }
  if (!trainer.processes) return;
  const FeatureSums<double> own = std::exchange(trainer.sums, empty_sums(trainer.architecture.features));
  add_statistics(*trainer.processes, own, trainer.sums);
}

// Accelerations are the last normalised columns.
constexpr std::ptrdiff_t acceleration_columns = 3;
bool are_accelerations_new(const Trainer& trainer) {
  if (!trainer.architecture.features.acceleration_inputs) return false;
  const Statistics& node = trainer.network.weights.tables.node;
  return are_blank({{node.mean.end() - acceleration_columns, node.mean.end()},
                    {node.deviation.end() - acceleration_columns, node.deviation.end()}});
}

bool are_space_edges_new(const Trainer& trainer) {
  return trainer.architecture.features.space_edges && are_blank(trainer.network.weights.tables.space_edge);
}

bool is_cloth_edge(const std::string& key) { return key == "repulsion_edge" || key == "attraction_edge"; }

// Whether weights of an earlier stage lack statistics of cloth-cloth edges, because it had none.
bool are_cloth_edges_new(const Trainer& trainer) {
  return trainer.architecture.features.cloth_edges && trainer.options.contact.edges &&
         are_blank(trainer.network.weights.tables.world_edge);
}

// Cloth-cloth edges get zero weights in the node networks. New edges then do not change the output at first, and the
// weights stay zero in runs without such edges.
void silence_cloth_edges(const Architecture& architecture, NetworkWeights& weights) {
  for (std::size_t s = 0; s < architecture.steps.size(); ++s) {
    const std::vector<std::string>& keys = architecture.steps[s].edge_keys;
    for (std::size_t k = 0; k < keys.size(); ++k)
      if (is_cloth_edge(keys[k]))
        weights.steps[s]
            .node.layers.front()
            .weight.middleCols(static_cast<Eigen::Index>(k + 1) * architecture.width, architecture.width)
            .setZero();
  }
}

// Gathers the statistics of all inputs; with weights of an earlier stage, only of its missing ones.
void warm_up(Trainer& trainer) {
  FeatureTables& tables = trainer.network.weights.tables;
  const bool begins = trainer.options.weights.empty(), cloth_edges = are_cloth_edges_new(trainer),
             space_edges = are_space_edges_new(trainer), accelerations = are_accelerations_new(trainer);
  if (!begins && !cloth_edges && !space_edges && !accelerations) return;
  gather_warm_up(trainer);
  FeatureTables fresh = tables;
  freeze_statistics(trainer.sums, fresh);
  if (begins) {
    tables = fresh;
    if (!trainer.options.contact.edges) silence_cloth_edges(trainer.architecture, trainer.network.weights);
    return;
  }
  if (space_edges) tables.space_edge = fresh.space_edge;
  if (accelerations) {
    std::copy(fresh.node.mean.end() - acceleration_columns, fresh.node.mean.end(),
              tables.node.mean.end() - acceleration_columns);
    std::copy(fresh.node.deviation.end() - acceleration_columns, fresh.node.deviation.end(),
              tables.node.deviation.end() - acceleration_columns);
  }
  if (!cloth_edges) return;
  tables.world_edge = fresh.world_edge;
  silence_cloth_edges(trainer.architecture, trainer.network.weights);
}

// What states are drawn by. Process 0 has the numbers that one process has.
RandomStream states_stream(std::uint64_t seed, int rank) {
  constexpr std::uint64_t ranks_use = 5;  // uses 1 to 4 are those of roll-outs (training_roll.cpp)
  return rank == 0 ? stream_of(seed, 0) : stream_of(seed * 8 + ranks_use, static_cast<std::uint64_t>(rank));
}

void check_same_training(const Trainer& trainer) {
  std::string text = program_key() + training_yaml(trainer.options);
  for (const InputFile& file : trainer.inputs.files) text += file.name + std::to_string(file.hash);
  check_same(*trainer.processes, hash_of(text, trainer.inputs.scene), "programs, training files or inputs",
             "training " + trainer.options.name, "give every process the same program and the same files");
}

}  // namespace

Architecture trained_architecture(const TrainingOptions& options) {
  Architecture architecture = architecture_preset(options.architecture);
  if (options.width > 0) architecture.width = options.width;
  if (options.message_steps > 0)
    architecture.steps.resize(static_cast<std::size_t>(options.message_steps), architecture.steps.back());
  architecture.passes = options.pool.passes;
  FeatureOptions& features = architecture.features;
  features.contour_force = options.contour_force;
  if (features.space_edges) features.space = options.space;
  if (options.samples.forces.strongest > 0 && !sees_accelerations(features))
    throw Error("the network `" + architecture.name + "` sees no forces", options.name + ": samples.forces.strongest",
                "take the architecture small_senc, small_senc_layers, senc or student, or leave the forces out");
  if (architecture.passes > 1 && features.base == OutputBase::carried && !features.pass_inputs)
    throw Error("the network `" + architecture.name + "` makes a frame in one pass", options.name + ": pool.passes",
                "give passes: 1");
  const bool sees_what_changes =
      features.force_inputs || features.type_columns + features.level_columns + features.label_columns > 0;
  if (options.teacher.uses > 1 && (architecture.passes > 1 || sees_what_changes))
    throw Error("kept states suit networks of one pass that see no embeddings and no force of the objective",
                options.name + ": teacher.uses",
                "take the architecture student and `pool.passes: 1`, or leave `teacher.uses` out");
  features.attraction_edges = options.contact.attraction;
  if (features.cloth_edges && !options.contact.classify) features.contours = ContourRule::all_repel;
  check_architecture(architecture, options.name);
  return architecture;
}

std::unique_ptr<Trainer> make_empty_trainer(const TrainingOptions& options, Processes* processes) {
  auto trainer = std::make_unique<Trainer>();
  trainer->options = options;
  trainer->processes = processes;
  trainer->architecture = trained_architecture(options);
  trainer->adam = start_adam(trainer->architecture);
  trainer->sums = empty_sums(trainer->architecture.features);
  trainer->gradients = zero_gradients(trainer->architecture);
  trainer->random = states_stream(options.seed, rank_of(*trainer));
  trainer->pool.resize(static_cast<std::size_t>(options.pool.states));
  trainer->maker = std::make_unique<RollMaker>(
      RollMaker{options, trainer->architecture.features, make_training_world(options.samples, options.seed), {}});
  trainer->maker->world.cache = cache_folder();
  trainer->inputs.files = files_of(options.samples.people, options.samples.folder);
  trainer->inputs.scene = world_hash(trainer->maker->world);
  if (processes) check_same_training(*trainer);
  trainer->trained_on = trained_on(options.samples);
  trainer->queue = std::make_unique<RollQueue>(*trainer->maker);
  if (const TeacherWork work = teacher_work(options.objective); work.any())
    trainer->teacher = std::make_unique<Teacher>(options.teacher, work);
  trainer->taught.most = static_cast<std::size_t>(options.teacher.kept);
  return trainer;
}

std::unique_ptr<Trainer> make_trainer(const TrainingOptions& options, Processes* processes) {
  auto trainer = make_empty_trainer(options, processes);
  trainer->network =
      make_training_network(trainer->architecture, first_weights(options, trainer->architecture, trainer->trained_on));
  warm_up(*trainer);
  trainer->torch = torch_network_for(options.device, trainer->architecture, trainer->network.weights);
  place_network(*trainer);
  for (int k = 0; k < rolls_ahead; ++k) ask_for_roll(*trainer);
  return trainer;
}

int rank_of(const Trainer& trainer) { return trainer.processes ? trainer.processes->rank() : 0; }
int process_count(const Trainer& trainer) { return trainer.processes ? trainer.processes->count() : 1; }

void place_network(Trainer& trainer) {
  if (trainer.torch)
    trainer.torch->set_weights(trainer.network.weights);
  else
    lay_out(trainer.network);
}

void teach(Trainer& trainer, RollingState& state) {
  if (!trainer.teacher) return;
  trainer.teacher->ask(state);
  trainer.teacher->wait(state);
}

void set_guard(const TrainingOptions& options, RollingState& state) {
  const bool wanted = options.pool.safeguarded && state.roll.request.cloth_contact;
  state.guard = wanted ? std::make_unique<Safeguard>(state.roll.scene->scene) : nullptr;
  state.behind = make_behind(state.roll.scene->scene, options.pool.behind);
}

double progress_of(const Trainer& trainer) { return static_cast<double>(trainer.counts.step) / trainer.options.steps; }

FrameMaking frame_making(const Trainer& trainer) {
  return {trainer.architecture.features, trainer.options.objective, trainer.architecture.passes, progress_of(trainer)};
}

void ask_for_roll(Trainer& trainer) {
  const auto rank = static_cast<std::uint64_t>(rank_of(trainer)),
             count = static_cast<std::uint64_t>(process_count(trainer));
  const std::uint64_t number = trainer.counts.rolls++ * count + rank;
  trainer.queue->ask(draw_roll(trainer.options, trainer.maker->world, number, progress_of(trainer)));
}

}  // namespace selvedge
