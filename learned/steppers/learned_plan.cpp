#include "learned/steppers/learned_scene.hpp"
#include "learned/steppers/learned_state.hpp"
#include "learned/steppers/learned_stepper.hpp"

namespace selvedge {
namespace {

PlanLine body_edges_line(const Scene& scene, const FeatureOptions& options) {
  if (options.body_key.empty())
    return {"body edges", false,
            options.body_inputs ? "the network has none: vertices see the body's nearest face among their inputs"
                                : "the network has none"};
  if (scene.obstacles.empty()) return {"body edges", false, "there is no obstacle"};
  return {"body edges", true, "obstacles are one body of " + std::to_string(scene.obstacles.size()) + " parts"};
}

PlanLine cloth_edges_line(const Scene& scene, const FeatureOptions& options) {
  if (!options.cloth_edges) return {"world edges", false, "the network has none: cloth does not see cloth"};
  if (!sees_cloth_edges(scene)) return {"world edges", false, "no second garment, and contact.self is off"};
  return {"world edges", true, "between cloth and cloth, repelling and attracting by contours"};
}

PlanLine settling_line(const Architecture& architecture, bool settle) {
  if (!may_settle(architecture)) return {"settling pass", false, "the network goes on from the carried guess"};
  if (architecture.integration == Integration::relaxation_frame)
    return {"settling pass", true, "first, out of the body and 1/3 s long, as HOOD starts"};
  return {"settling pass", settle,
          settle ? "first, as run.learned.settle asks" : "not asked for by run.learned.settle"};
}

}  // namespace

std::vector<PlanLine> learned_plan_lines(const Scene& scene, const Architecture& architecture,
                                         const LearnedOptions& learned) {
  const FeatureOptions& options = architecture.features;
  std::vector<PlanLine> lines;
  lines.push_back({"network", true,
                   architecture.name + ", " + std::to_string(parameter_count(architecture)) + " parameters, " +
                       std::to_string(architecture.steps.size()) + " message-passing steps"});
  lines.push_back(settling_line(architecture, learned.settle));
  if (options.base == OutputBase::carried)
    lines.push_back({"step lengths", learned.step_lengths,
                     learned.step_lengths
                         ? "the output is followed as far as the solver's forces agree"
                         : "the whole output is taken, by run.learned.step_lengths or before a solve"});
  lines.push_back({"libtorch", learned.device != NetworkDevice::cpu, device_sentence(learned.device)});
  if (learned.device == NetworkDevice::cpu) {
    const bool whole = kernels_of(learned.numbers) == InstructionSet::vnni;
    lines.push_back({"16-bit integers", whole,
                     whole ? "in the network's products, as run.learned.numbers asks"
                     : learned.numbers == NetworkNumbers::automatic ? "this processor has no instruction for them"
                                                                    : "not asked for by run.learned.numbers"});
  }
  lines.push_back({"coarse edges", !options.coarse_sets.empty(),
                   std::to_string(options.coarse_sets.size()) + " of " + std::to_string(options.coarse_levels) +
                       " levels; a piece too small for one has none"});
  lines.push_back(body_edges_line(scene, options));
  lines.push_back(cloth_edges_line(scene, options));
  if (options.space_edges)
    lines.push_back({"space edges", true, "between vertices of cloth that are near each other and no mesh edge joins"});
  for (const std::string& text : learned_scene(scene).clamped) lines.push_back({"material", false, text});
  const bool forces = sees_accelerations(options);
  if (forces && features_of(scene).wind) lines.push_back({"wind", true, "on each triangle, among the inputs"});
  for (const PlanLine& line : ignored_lines(scene, learned_traits(architecture))) lines.push_back(line);
  lines.push_back(
      {"gravity", forces,
       forces ? "the scene's, among the inputs" : "as the network was trained in it, whatever the scene says"});
  lines.push_back({"substeps", false, "the network makes whole frames, whatever the scene says"});
  lines.push_back({"detection and response", false, "what passes through is found by the audits"});
  return lines;
}

}  // namespace selvedge
