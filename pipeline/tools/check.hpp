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
  std::filesystem::path file;                 // mesh (OBJ, PLY), trajectory (HDF5), or the folder of a run
  std::optional<std::filesystem::path> rest;  // mesh of the same triangles at rest; a trajectory has its own
  std::vector<std::filesystem::path> bodies;  // meshes that the cloth must not touch, beside a trajectory's obstacles
  std::optional<std::filesystem::path> against{};  // another trajectory, or run, of the same cloths
  std::string audit = "own";                       // own or fcl; fcl adds FCL's result to the audit's
  double horizon = 0.02;                           // larger gaps are not measured [m]
  bool volume = false;                             // measures the volume that crossings enclose
};

// Findings in the positions themselves. Statements in a trajectory about itself are not used.
struct CheckReport {
  bool trajectory = false;
  int vertices = 0, triangles = 0, bodies = 0;
  std::vector<int> pairs_by_frame;         // intersecting triangle pairs that share no vertex, and pairs with bodies
  std::vector<int> vertex_pairs_by_frame;  // pairs that share one vertex and cross along a segment
  int worst_pairs = 0, worst_frame = 0, worst_vertex_pairs = 0;
  double min_gap = std::numeric_limits<double>::infinity();  // infinity: all are above the horizon [m]
  std::optional<double> max_stretch, min_stretch;            // absent without a rest shape
  long nonfinite = 0;                                        // vertices, summed over all frames
  int degenerate_triangles = 0;                              // of the worst frame
  int inside_vertices = 0;                                   // of the worst frame
  bool closed = true;  // false: the trajectory's writer was stopped or is still at work
  std::vector<std::string> warnings;
  std::optional<Opinion> fcl;
  std::optional<VolumeFindings> volume;    // without frames that are not finite
  std::map<std::string, double> measures;  // from measures_against
  int frames() const { return static_cast<int>(pairs_by_frame.size()); }
};

// Checks a mesh or all frames of a trajectory. Throws Error for files that cannot be read, for a rest mesh or reference
// with other triangles, and for `fcl` in a build without FCL.
CheckReport check(const CheckRequest&);

// The number of triangles whose height is hidden by the rounding of their coordinates.
int count_degenerate(const Surface&, const Points& x);

// Whether all positions are finite, no pairs intersect, nothing is inside a body, and FCL differs only where rounding
// can explain it.
bool is_clean(const CheckReport&);

std::string check_json(const CheckReport&);
std::string check_text(const CheckReport&);

}  // namespace selvedge
