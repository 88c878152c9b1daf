#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

enum class EdgeForm { straight, quadratic, cubic, circle };

// An edge of a panel, from one of its corners to another. All in metres.
struct PanelEdge {
  std::array<int, 2> ends{};
  EdgeForm form = EdgeForm::straight;
  std::vector<Vec2> controls;     // of a quadratic or cubic Bezier curve, in the panel's plane
  double radius = 0;              // of a circular arc
  bool large_arc = false;         // the longer of the two arcs of that radius
  bool counterclockwise = false;  // the arc turns left from start to end
  std::string label;              // empty: none
};

// A flat piece of cloth. On its right side the edges run counter-clockwise.
struct Panel {
  std::string name, label;
  Mat3 rotation = Mat3::Identity();  // a corner (x, y) is at rotation (x, y, 0) + translation round the body
  Vec3 translation = Vec3::Zero();   // [m]
  std::vector<Vec2> corners;         // [m]
  std::vector<PanelEdge> edges;      // as the file numbers them
  std::vector<int> loop;             // edges in the order round the panel
};

struct PanelSide {
  int panel = 0, edge = 0;
};

// Two edges that are sewn together. The second runs against the first, unless the right side of one panel meets the
// wrong side of the other.
struct PatternSeam {
  std::array<PanelSide, 2> sides;
  bool right_to_wrong = false;
};

struct Pattern {
  std::string name;
  std::vector<Panel> panels;
  std::vector<PatternSeam> seams;
};

// Reads a pattern of GarmentCode (Korosteleva and Sorkine-Hornung 2023), `*_specification.json`. Throws Error, naming
// panel and edge, for numbers that are not finite, edges without length, loops that do not close, and stitches to edges
// that do not exist.
Pattern read_pattern(const std::filesystem::path&);

// The same from a text; `file` is named in errors.
Pattern pattern_of(const std::string& json, const std::string& file);

// `panel NAME, edge K`, as errors name it.
std::string edge_name(const Panel&, int edge);

// n + 1 points that divide an edge into n parts of equal length, with both ends [m].
std::vector<Vec2> edge_points(const Panel&, int edge, int n);

double edge_length(const Panel&, int edge);  // [m]

}  // namespace selvedge
