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
  std::size_t first_made = 0;           // frame that was simulated, not put: 1 of a trajectory
  double of_fans = 0;                   // L_sc of the garments at rest, where the cloth itself does not cross [J]
  std::vector<double> volume_by_frame;  // enclosed [m^3]
  long pairs = 0;                       // segments of crossing triangles, those of the fans included
  long contours = 0, enclosed = 0, open = 0, not_orientable = 0, unassigned = 0;
  int closed_holes = 0;

  double mean_loss() const;                // of all frames, as published
  std::vector<double> net_losses() const;  // of the frames that were made, less that of the fans, not below 0 [J]
  double mean_net_loss() const;
  double share_above(double net_loss) const;  // of the frames that were made
};

// Closes a cloth once and adds frame after frame. Frames must be finite.
class VolumeCheck {
 public:
  // `garments`: as close_surface.
  explicit VolumeCheck(const Surface& cloth, std::span<const int> garments = {});
  void add(const Points& x, VolumeFindings&) const;
  // L_sc of the fans at rest: a fan across a hole may go through its own garment, and then encloses a volume where the
  // cloth is clean. 0 where cloth crosses cloth at rest [J].
  double of_fans(const Points& rest) const;

 private:
  ClosedSurface closed_;
};

// All frames of a trajectory, each of its cloths being a garment; the first is the start, and counts as published
// alone. Throws Error for what is no trajectory, and for a frame that is not finite.
VolumeFindings volume_findings(const std::filesystem::path& trajectory);

// The garment of each vertex of cloths that begin at these vertices (TrajectoryInfo::cloth_first_vertex).
std::vector<int> garments_of_vertices(std::span<const int> first_vertex);

std::string volume_text(const VolumeFindings&);

}  // namespace selvedge
