#pragma once

#include <array>
#include <map>
#include <memory>

#include "learned/graph/rest_graph.hpp"
#include "learned/losses/loss_garment.hpp"
#include "physics/scene/stepper.hpp"
#include "pipeline/training/random_stream.hpp"
#include "pipeline/training/skinned_frame.hpp"

namespace selvedge {

// A hung sheet without a body, in place of a garment: as it hangs, or with a corner folded through it.
enum class HungStart { none, flat, folded };

// What a roll-out starts from and how long it goes on: enough to prepare it again, to the bit.
struct RollRequest {
  std::uint64_t number = 0;  // of all roll-outs of the run
  int wear = 0, body = 0, clip = 0;
  int first_frame = 0, frames = 1;
  bool still = true;  // begins at rest, with a frame of 1/3 s in which the cloth falls
  bool mirrored = false;
  bool with_body = true;
  bool cloth_contact = false;
  double yaw = 0;  // [rad]
  HungStart sheet = HungStart::none;
  bool wind = false;          // the force is a wind's
  Vec3 force = Vec3::Zero();  // beside gravity [m/s2]; of wind: what it does to a triangle that faces it
  bool operator==(const RollRequest&) const = default;
};

// A garment's material: `one` at the lower end of its rest shape along `direction`, `other` at the upper end, and mixed
// in between, mu and bending by their logarithms.
struct MaterialDraw {
  VertexMaterial one, other;
  Vec3 direction{0, 1, 0};
};

// A scene as network and losses see it.
struct TrainingScene {
  std::vector<VertexMaterial> materials;  // of each vertex
  Scene scene;
  GraphScene graph;
  RestGraph rest;
  LossGarment losses;
};

// A roll-out's world, prepared: entry k is frame first_frame - 1 + k of the clip, frames + 2 in all.
struct Roll {
  RollRequest request;
  std::shared_ptr<const TrainingScene> scene;
  std::vector<PointsF> body, cloth;  // cloth: as worn; body: empty matrices where there is none
  Points start;                      // where free vertices begin: as worn, parted where that is asked for, with noise
  bool usable = true;                // false: what was to be parted did not come apart
  int parting = 0;                   // iterations that parted the start
  int cut = 0;                       // triangles that were cut out where it begins
  std::vector<std::vector<char>>
      body_left_out;          // of each entry, faces of the body that meet others; empty: it gives way
  int pairs = 0;              // of triangles of cloth that intersect where it begins; counted of tangled starts
  bool space_edges = true;    // of networks that have them; false: left out with all contact of cloth with cloth
  bool shows_forces = false;  // the network has inputs for accelerations
  Drive forces;               // acceleration, gravity with it, and wind
};

// The number-th roll-out; `progress` of the run says how long it may be.
RollRequest draw_roll(const TrainingOptions&, const TrainingWorld&, std::uint64_t number, double progress);

// Prepares roll-outs of a world. One thread at a time.
struct RollMaker {
  TrainingOptions options;
  FeatureOptions features;
  TrainingWorld world;
  std::map<std::array<int, 6>, std::shared_ptr<const TrainingScene>> scenes;  // of the fixed material
};
Roll make_roll(RollMaker&, const RollRequest&);

// Where a tangled start is taken from: of every second number, by which it is random, the first of up to eight places
// in the clips at which the skinned garment has 20 intersecting pairs or more, or the one with the most; of others the
// place that was asked for. Says how many pairs there are.
RollRequest tangled_place(RollMaker&, const RollRequest& asked, int& pairs);

// A material over the ranges of the authors' training (their configurations): density and lambda uniform, mu and
// bending by their logarithms.
VertexMaterial random_material(RandomStream&);

// The materials that the roll-out's garments have, one a garment.
std::vector<MaterialDraw> drawn_materials(const RollMaker&, const RollRequest&);

// The garment, outfit or sheet that the roll-out asks for, with these materials, as network and losses see it.
std::shared_ptr<const TrainingScene> make_training_scene(const RollMaker&, const RollRequest&,
                                                         const std::vector<MaterialDraw>&);

// The same scene without some triangles, which are ascending. Vertices that are left alone are pinned: they go as the
// garment is worn, and no loss, edge or pair has them (Grigorev et al. 2024, as released).
std::shared_ptr<const TrainingScene> cut_scene(const RollMaker&, const RollRequest&, const TrainingScene&,
                                               const std::vector<int>& triangles);

}  // namespace selvedge
