#pragma once

#include <string>
#include <vector>

#include "physics/energies/measures.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"
#include "pipeline/formats/look.hpp"
#include "pipeline/reports/bound_field.hpp"

namespace selvedge {

using PointsF = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

// The constant data of a trajectory.
struct TrajectoryInfo {
  std::string program_version, config, stepper;
  double fps = 30;
  bool self_audited = true;     // false: the file is labelled "self: not audited"
  bool contact_forces = false;  // has those of each frame (StepReport::contact_forces)
  std::vector<std::string> cloth_names;
  std::vector<int> cloth_first_vertex, cloth_first_triangle;  // size cloths + 1
  Triangles triangles;                                        // of all cloths, one after the other
  Points rest;
  std::vector<RestTriangle> rest_triangle;
  std::vector<int> pins;
  std::vector<Look> looks;  // to be written, of each cloth, or none; read by TrajectoryReader::looks
  struct Body {
    std::string name;
    Triangles triangles;
    int vertex_count = 0;
    bool moving = false;  // still ones are stored once; when read, also true for still ones that cloth moved
  };
  std::vector<Body> obstacles;
};

struct Frame {
  double time = 0;
  PointsF x;
  std::vector<PointsF> obstacles;
  StepReport report;
  int self_pairs = 0, vertex_pairs = 0, obstacle_pairs = 0, inside_vertices = 0,
      nonfinite = 0;  // audit of x as written
  double max_stretch = 1, min_stretch = 1;
  Energies energy;
  double seconds = 0;              // whole frame
  std::vector<int> bad_triangles;  // triangles that intersect something (drawn marked)
};

// A frame without its positions: its report, its audit, its energies.
const BoundFields<Frame>& frame_fields();

}  // namespace selvedge
