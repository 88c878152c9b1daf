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
  std::filesystem::path out;        // the garment (.h5), or its mesh alone (.obj, .ply)
  std::string body = "mannequin";   // or a file: a body (.npz, .h5), or a mesh in metres (.obj, .ply)
  double edge = 0.015;              // of the triangles [m]
  std::string material = "cotton";  // a name, or a file
  std::vector<std::string> pins;    // groups that stay with the body in scenes
  bool flat = false;                // only cut: `out` is the mesh of the panels where the pattern has them
  std::filesystem::path record;     // a trajectory of the sewing; empty: none
  std::function<void(const SewingFrame&)> progress = {};
};

struct PatternReport {
  Garment garment;
  int panels = 0, seams = 0, stitches = 0;
  double least_angle = 0;              // of a triangle, as cut [rad]
  double area = 0;                     // of the cloth [m2]
  double raised = 0;                   // by which the body stands higher than given, on the pattern's floor [m]
  SewnPattern sewn;                    // not with `flat`
  double largest_gap = 0;              // of a stitch before it was joined [m]
  int open_stitches = 0;               // whose gap was larger than 5 mm then
  double median_distance = 0;          // from vertices to the body's surface [m]
  double strain_99 = 0;                // 99th percentile of the largest strain of a triangle
  int self_pairs = 0, body_pairs = 0;  // intersecting triangles, with itself and with the body as given
  int inside_vertices = 0;             // in the body
  std::vector<std::string> warnings;
};

// Cuts a pattern, sews it on a body that stands in its zero pose and mean shape, and writes the garment. A body that is
// a mesh has one joint, named `root`. A body that reaches below the floor on which patterns have it stand is sewn on as
// if it stood there; what is written is on the body as it is given. Throws Error for what cannot be read or written,
// and for panels that do not stand round the body.
PatternReport sew_garment(const PatternRequest&);

// What is wrong with the garment, a sentence each: stitches never closed, it was never on the body, it has slid off, it
// never came to rest, a step was rejected.
std::vector<std::string> faults_of(const PatternReport&);

// Without faults, and without pairs, with nothing inside the body.
bool is_clean(const PatternReport&);

std::string pattern_json(const PatternReport&);
std::string pattern_text(const PatternReport&);

}  // namespace selvedge
