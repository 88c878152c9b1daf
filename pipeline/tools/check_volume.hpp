#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "collision/penetration/penetration_regions.hpp"

namespace selvedge {

// The volume that garments enclose where they cross themselves and each other, over the frames of a check.
struct VolumeFindings {
  std::vector<double> loss_by_frame;    // L_sc with the released weight [J]
  std::vector<double> volume_by_frame;  // enclosed [m^3]
  long pairs = 0;                       // segments of crossing triangles, those of the fans included
  long contours = 0, enclosed = 0, open = 0, not_orientable = 0, unassigned = 0;
  int closed_holes = 0;

  double mean_loss() const;
  double share_above(double loss) const;  // of the frames
};

// Closes a cloth once and adds frame after frame. Frames must be finite.
class VolumeCheck {
 public:
  // `garments`: as close_surface.
  explicit VolumeCheck(const Surface& cloth, std::span<const int> garments = {});
  void add(const Points& x, VolumeFindings&) const;

 private:
  ClosedSurface closed_;
};

// All frames of a trajectory, each of its cloths being a garment. Throws Error for what is no trajectory, and for a
// frame that is not finite.
VolumeFindings volume_findings(const std::filesystem::path& trajectory);

// The garment of each vertex of cloths that begin at these vertices (TrajectoryInfo::cloth_first_vertex).
std::vector<int> garments_of_vertices(std::span<const int> first_vertex);

std::string volume_text(const VolumeFindings&);

}  // namespace selvedge
