#pragma once

#include <utility>
#include <vector>

#include "physics/scene/scene.hpp"
#include "pipeline/patterns/pattern.hpp"

namespace selvedge {

// All panels as triangles, before sewing.
struct PatternMesh {
  Points placed;                         // positions round the body, as the pattern places panels [m]
  Triangles triangles;                   // counter-clockwise from the right side
  std::vector<RestTriangle> rest;        // flat, as cut, in the panel's x and y [m]
  std::vector<int> panel;                // of each vertex
  std::vector<std::array<int, 2>> sewn;  // pairs of vertices that become one
  std::vector<int> seam;                 // of each pair: its seam of the pattern
  std::vector<std::pair<std::string, std::vector<int>>> groups;  // panels, and labels of panels and edges
  double least_angle = 0;                                        // of a triangle at rest [rad]
};

// Meshes the panels with edges of about that length [m]. Both edges of a seam get the same number of vertices, chosen
// for the longer one. Throws Error, naming the panel, if its outline, cut into edges, crosses itself or has too many.
PatternMesh pattern_mesh(const Pattern&, double edge);

}  // namespace selvedge
