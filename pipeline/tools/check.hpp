#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "collision/geometry/surface.hpp"
#include "pipeline/tools/check_opinion.hpp"
#include "pipeline/tools/check_volume.hpp"

namespace selvedge {

struct CheckRequest {
  std::filesystem::path file;                 // mesh (OBJ, PLY) or trajectory (HDF5)
  std::optional<std::filesystem::path> rest;  // mesh of the same triangles at rest; a trajectory holds its own
  std::vector<std::filesystem::path> bodies;  // meshes that the cloth must not touch, beside a trajectory's obstacles
  std::optional<std::filesystem::path> against{};  // another trajectory of the same cloths
  std::string audit = "own";                       // or "fcl": its opinion beside the audit's
  double horizon = 0.02;                           // gaps above it are not looked for [m]
  bool volume = false;                             // the volume that crossings enclose
};

// What was found in the positions themselves; nothing that a trajectory says about itself is trusted.
struct CheckReport {
  bool trajectory = false;
  int vertices = 0, triangles = 0, bodies = 0;
  std::vector<int> pairs_by_frame;         // intersecting triangle pairs that share no vertex, and with bodies
  std::vector<int> vertex_pairs_by_frame;  // pairs that share one vertex and cross along a segment
  int worst_pairs = 0, worst_frame = 0, worst_vertex_pairs = 0;
  double min_gap = std::numeric_limits<double>::infinity();  // infinity: above the horizon everywhere [m]
  std::optional<double> max_stretch, min_stretch;            // absent without a rest shape
  long nonfinite = 0;                                        // vertices, over all frames
  int degenerate_triangles = 0;                              // worst frame's
  int inside_vertices = 0;                                   // worst frame's
  bool closed = true;  // false: the trajectory's writer did not end, or is still at work
  std::vector<std::string> warnings;
  std::optional<Opinion> fcl;
  std::optional<VolumeFindings> volume;    // frames that are not finite have none
  std::map<std::string, double> measures;  // of measures_against
  int frames() const { return static_cast<int>(pairs_by_frame.size()); }
};

CheckReport check(const CheckRequest&);

// Triangles whose height is lost in the rounding of their coordinates.
int count_degenerate(const Surface&, const Points& x);

// All finite, no intersecting pairs, nothing inside a body, and no other opinion of FCL where rounding cannot excuse
// it.
bool is_clean(const CheckReport&);

std::string check_json(const CheckReport&);
std::string check_text(const CheckReport&);

}  // namespace selvedge
