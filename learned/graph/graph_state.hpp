#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"
#include "learned/graph/graph.hpp"
#include "physics/scene/scene.hpp"

namespace selvedge {

// Vertex types are rows of the authors' type embedding.
enum VertexType : int { free_vertex = 0, body_vertex = 1, omitted_body_vertex = 2, pinned_vertex = 3 };

// The constant part of a simulated scene. All cloths are one surface, and so are all obstacles.
struct GraphScene {
  Surface cloth;
  Points rest;                  // [m]
  std::vector<double> mass;     // one per cloth vertex [kg]
  std::vector<int> types;       // one per cloth vertex: free_vertex or pinned_vertex
  FeatureRows materials;        // V x 3: bending, mu, lambda as numbers between 0 and 1
  Surface body;                 // without vertices if there is no obstacle
  std::vector<int> body_types;  // body_vertex, or omitted_body_vertex, which gets no edges
  std::vector<Spring> springs;  // stitches and buttons: networks see each as an edge of the mesh
};

// The start of a step. Velocities are per frame [m/frame]. `target` has the next positions of pinned vertices.
struct GraphState {
  Points x, previous, target, velocity;     // of the cloth, V x 3
  Points body, body_previous, body_target;  // W x 3
  Points acceleration;                      // by all forces but contact, V x 3 [m/s2]; empty: none
  double timestep = 1.0 / 30;               // [s]
  bool is_init = false;                     // the cloth falls to rest (ContourCraft's flag)
  bool no_cloth_edges = false;              // no edges of cloth with cloth; the authors' training samples begin so
  bool no_space_edges = false;              // no edges between vertices near each other

  // For models that see the objective (FeatureOptions::force_inputs, pass_inputs, strain_inputs, guess_inputs).
  // Start of this pass: the result of the last one, or in the first the carried guess (OutputBase::carried). Empty: x +
  // velocity, pinned vertices at target.
  Points guess;
  Points force;  // minus the objective's gradient over its diagonal, at the guess [m]; empty: zero
  int pass = 0;  // number of the pass in this frame, from 0

  Points elastic;  // the motion by elastic forces alone, from the guess (elastic_motion); empty: zero

  // For networks beside the carried guess (OutputBase::carried).
  Mat3 heading = Mat3::Identity();  // turns what they see, as if worn cloth faced as its rest shape does, into space
  std::vector<Mat3> frames;         // turns the output of each vertex into space; empty: not at all
  Points worn_motion, worn_offset;  // of the skinned target in the frame; from it to the cloth [m]; empty: zero
};

}  // namespace selvedge
