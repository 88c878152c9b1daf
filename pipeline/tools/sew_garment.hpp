#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "pipeline/garments/garment.hpp"
#include "pipeline/patterns/sew_pattern.hpp"

namespace selvedge {

struct PatternRequest {
  std::filesystem::path file;       // *_specification.json
  std::filesystem::path out;        // garment (.h5), or its mesh only (.obj, .ply)
  std::string body = "mannequin";   // or a file: a body (.npz, .h5), or a mesh in metres (.obj, .ply)
  double edge = 0.015;              // edge length of the triangles [m]
  std::string material = "cotton";  // a name, or a file
  std::vector<std::string> pins;    // groups that stay with the body in scenes
  bool flat = false;                // cut only: `out` is the mesh of the panels in the pattern's positions
  std::filesystem::path record;     // a trajectory of the sewing; empty: none
  std::function<void(const SewingFrame&)> progress = {};
};

struct PatternReport {
  Garment garment;
  int panels = 0, seams = 0, stitches = 0;
  double least_angle = 0;              // smallest angle of a triangle after cutting [rad]
  double area = 0;                     // of the cloth [m2]
  double raised = 0;                   // height by which the body is raised to stand on the pattern's floor [m]
  SewnPattern sewn;                    // empty with `flat`
  double largest_gap = 0;              // largest gap of a stitch before joining [m]
  int open_stitches = 0;               // stitches with a gap larger than 5 mm
  double median_distance = 0;          // from vertices to the body's surface [m]
  double strain_99 = 0;                // 99th percentile of the largest strain of a triangle
  int self_pairs = 0, body_pairs = 0;  // intersecting triangles, with itself and with the body as given
  int inside_vertices = 0;             // vertices inside the body
  std::vector<std::string> warnings;
};

// Cuts a pattern, sews it on a body in its zero pose and mean shape, and writes the garment. A body that is a mesh has
// one joint, named `root`. If a body reaches below the floor of patterns, it is raised for the sewing, and the written
// garment fits the body as given. Throws Error for files that cannot be read or written, and for panels that do not
// stand round the body.
PatternReport sew_garment(const PatternRequest&);

// Faults of the garment, one sentence each: stitches that never closed, a garment that was never on the body, has slid
// off or never came to rest, a rejected step.
std::vector<std::string> faults_of(const PatternReport&);

// Whether there are no faults, no intersecting pairs and no vertices inside the body.
bool is_clean(const PatternReport&);

std::string pattern_json(const PatternReport&);
std::string pattern_text(const PatternReport&);

}  // namespace selvedge
