#pragma once

#include <array>
#include <map>
#include <memory>

#include "learned/graph/rest_graph.hpp"
#include "learned/losses/loss_garment.hpp"
#include "physics/scene/stepper.hpp"
#include "physics/solve/assembly.hpp"
#include "pipeline/training/random_stream.hpp"
#include "pipeline/training/training_world.hpp"

namespace selvedge {

// The start of a hanging sheet, without a body and in place of a garment: flat, or with a corner folded through it.
enum class HungStart { none, flat, folded };

// The start and the length of a roll-out. The same request gives the same bits.
struct RollRequest {
  std::uint64_t number = 0;  // number of the roll-out in the run
  int wear = 0, body = 0, clip = 0;
  int first_frame = 0, frames = 1;
  bool still = true;  // begins at rest, with a frame of 1/3 s in which the cloth falls
  bool mirrored = false;
  bool with_body = true;
  bool cloth_contact = false;
  double yaw = 0;  // [rad]
  HungStart sheet = HungStart::none;
  bool wind = false;          // the force is that of a wind
  Vec3 force = Vec3::Zero();  // beside gravity [m/s2]; for wind: on a triangle that faces it
  int simulated = 0;          // frames that the solver makes before the roll-out begins
  double noise = 0;           // deviation of the noise on start positions; 0: as SampleOptions have it [m]
  bool operator==(const RollRequest&) const = default;
};

// The material of a garment: `one` at the lower end of its rest shape along `direction`, `other` at the upper end, and
// mixed in between, mu and bending by their logarithms.
struct MaterialDraw {
  VertexMaterial one, other;
  Vec3 direction{0, 1, 0};
};

// A scene as network and losses take it.
struct TrainingScene {
  std::vector<VertexMaterial> materials;  // one per vertex
  Scene scene;
  GraphScene graph;
  RestGraph rest;
  LossGarment losses;
  Elastic elastic;  // of networks that see the elastic forces (FeatureOptions::guess_inputs)
};

// The prepared world of a roll-out: entry k is frame first_frame - 1 + k of the clip, frames + 2 in all.
struct Roll {
  RollRequest request;
  std::shared_ptr<const TrainingScene> scene;
  std::vector<PointsF> body, cloth;  // cloth: skinned; body: empty matrices if there is none
  Points start;                      // of free vertices: skinned or simulated, perhaps untangled, perhaps with noise
  Points velocity;                   // of a simulated start [m/frame]; no rows: that of the skinned garment
  bool usable = true;                // false: the start is not untangled, wholly cut out, or was not simulated
  int parting = 0;                   // iterations that untangled the start
  int cut = 0;                       // triangles cut out at the start
  std::vector<std::vector<char>> body_left_out;  // by entry: faces of the body that meet others; empty: soft tissue
  int pairs = 0;                                 // intersecting pairs of triangles at a tangled start
  bool space_edges = true;                       // false: no space edges, because cloth has no contact with cloth
  bool shows_forces = false;                     // the network has inputs for accelerations
  bool carried = false;                          // its output is added to the carried guess
  Drive forces;                                  // acceleration, including gravity, and wind
};

// Draws the request number `number`. `progress` of the run limits its length.
RollRequest draw_roll(const TrainingOptions&, const TrainingWorld&, std::uint64_t number, double progress);

// Prepares roll-outs of a world. One thread at a time may use it.
struct RollMaker {
  TrainingOptions options;
  FeatureOptions features;
  TrainingWorld world;
  std::map<std::array<int, 6>, std::shared_ptr<const TrainingScene>> scenes;  // with the fixed material
};
Roll make_roll(RollMaker&, const RollRequest&);

// Chooses the place of a tangled start and counts its intersecting pairs. For even numbers it is the first of up to
// eight random places in the clips with 20 pairs or more in the skinned garment, or the one with most. For odd numbers
// it is `asked`.
RollRequest tangled_place(RollMaker&, const RollRequest& asked, int& pairs);

// The materials of the roll-out, one per garment.
std::vector<MaterialDraw> drawn_materials(const RollMaker&, const RollRequest&);

// The garment, outfit or sheet of the roll-out with these materials.
std::shared_ptr<const TrainingScene> make_training_scene(const RollMaker&, const RollRequest&,
                                                         const std::vector<MaterialDraw>&);

// The same scene without some triangles, which are ascending. Vertices without a triangle are pinned to the skinned
// target, and take part in no loss, edge or pair (Grigorev et al. 2024, as released).
std::shared_ptr<const TrainingScene> cut_scene(const RollMaker&, const RollRequest&, const TrainingScene&,
                                               const std::vector<int>& triangles);

}  // namespace selvedge
