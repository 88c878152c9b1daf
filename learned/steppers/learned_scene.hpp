#pragma once

#include <span>
#include <string>
#include <vector>

#include "learned/graph/graph_state.hpp"
#include "learned/losses/loss_garment.hpp"
#include "learned/network/architecture.hpp"
#include "physics/scene/scene.hpp"

namespace selvedge {

// A scene as networks see it. All obstacles are one body, numbered one behind the other.
struct LearnedScene {
  GraphScene graph;
  std::vector<std::string> clamped;  // materials outside of the range that networks were trained in, a sentence each
};

// Materials become numbers between 0 and 1 over the ranges of training (the authors' configurations): bending and mu by
// their logarithms, lambda linearly. What lies outside counts as the nearest end and is named. Membrane coefficients
// are divided by the authors' thickness of 0.47 mm. A curvature stiffness B stands for the hinge coefficient 4 B: on a
// mesh of equilateral triangles a cylinder then stores the same energy, taken over all directions. Woven cloth
// (Baraff-Witkin) counts as isotropic, with the mean of warp and weft and without lateral contraction.
LearnedScene learned_scene(const Scene&);

// The same, with body vertices that get no edges. Throws Error for one that is not there.
LearnedScene learned_scene(const Scene&, const std::vector<int>& omitted_body_vertices);

// The same numbers of materials that are one a vertex, V x 3.
FeatureRows material_inputs(std::span<const VertexMaterial>);

// A material as losses and networks take it: isotropic, bending by dihedral angles; what is said above.
VertexMaterial vertex_material(const Material&);

// The cloth of a scene as losses need it.
LossGarment loss_garment(const Scene&);

// Throws Error for a network whose inputs, outputs or passes are not those that the stepper makes.
void check_runnable(const Architecture&);

}  // namespace selvedge
