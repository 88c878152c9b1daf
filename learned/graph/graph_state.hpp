#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"
#include "learned/graph/graph.hpp"
#include "physics/scene/scene.hpp"

namespace selvedge {

// Vertex types, as rows of the authors' type embedding.
enum VertexType : int { free_vertex = 0, body_vertex = 1, omitted_body_vertex = 2, pinned_vertex = 3 };

// What stays the same while a scene is simulated. All cloths are one surface, and so are all obstacles.
struct GraphScene {
  Surface cloth;
  Points rest;                  // [m]
  std::vector<double> mass;     // of each cloth vertex [kg]
  std::vector<int> types;       // of each cloth vertex: free_vertex or pinned_vertex
  FeatureRows materials;        // V x 3: bending, mu, lambda as numbers between 0 and 1
  Surface body;                 // without vertices where there is none
  std::vector<int> body_types;  // body_vertex, or omitted_body_vertex: it gets no edges
  std::vector<Spring> springs;  // stitches and buttons: networks see each as an edge of the mesh
};

// What a step starts from. Velocities are per frame [m/frame]. For pinned vertices `target` is where they will be.
struct GraphState {
  Points x, previous, target, velocity;     // of the cloth, V x 3
  Points body, body_previous, body_target;  // W x 3
  Points acceleration;                      // by gravity and other forces without contact, V x 3 [m/s2]; empty: none
  double timestep = 1.0 / 30;               // [s]
  bool is_init = false;                     // the cloth is to fall to rest (ContourCraft's flag)
  bool no_cloth_edges = false;              // of cloth with cloth; the authors' training samples begin without
  bool no_space_edges = false;              // between vertices near each other

  // For models that see the objective (FeatureOptions::force_inputs, pass_inputs, strain_inputs).
  Points guess;  // where this pass begins, the result of the one before; empty: x + velocity, pinned vertices at target
  Points force;  // at the guess: minus the objective's gradient over its diagonal, a displacement [m]; empty: zero
  int pass = 0;  // of this frame, from 0
};

}  // namespace selvedge
