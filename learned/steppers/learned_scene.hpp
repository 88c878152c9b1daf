#pragma once

#include <span>
#include <string>
#include <vector>

#include "learned/graph/graph_state.hpp"
#include "learned/losses/loss_garment.hpp"
#include "learned/network/architecture.hpp"
#include "physics/scene/scene.hpp"

namespace selvedge {

// A scene as networks see it. All obstacles are one body, numbered one after the other.
struct LearnedScene {
  GraphScene graph;
  std::vector<std::string> clamped;  // a sentence for each material outside of the range of training
};

// Materials become numbers between 0 and 1 over the ranges of training (the authors' configurations): bending and mu by
// their logarithms, lambda linearly. A value outside counts as the nearest end and is named. Membrane coefficients are
// divided by the authors' thickness of 0.47 mm. A curvature stiffness B becomes the hinge coefficient 4 B, which stores
// the same energy in a cylinder on a mesh of equilateral triangles, averaged over directions. Woven cloth
// (Baraff-Witkin) counts as isotropic, with the mean of warp and weft and without lateral contraction.
//
// `omitted_body_vertices` get no edges. Throws Error for a vertex that does not exist.
LearnedScene learned_scene(const Scene&, const std::vector<int>& omitted_body_vertices = {});

// The same numbers for materials given per vertex, V x 3.
FeatureRows material_inputs(std::span<const VertexMaterial>);

// A material as losses and networks take it: isotropic, with a hinge coefficient (learned_scene).
VertexMaterial vertex_material(const Material&);

// The other way: a material of a scene with these numbers.
Material isotropic_material(const VertexMaterial&);

// The cloth of a scene as losses need it.
LossGarment loss_garment(const Scene&);

// Throws Error for a network whose inputs, outputs or passes are not those that the stepper makes.
void check_runnable(const Architecture&);

}  // namespace selvedge
