#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "collision/penetration/penetration_regions.hpp"

namespace selvedge {

// The volume that garments enclose where they cross themselves or each other, over the frames of a check.
struct VolumeFindings {
  std::vector<double> loss_by_frame;    // L_sc with the released weight [J]
  std::size_t first_made = 0;           // first simulated frame: 1 in a trajectory
  double of_fans = 0;                   // L_sc of the garments at rest, 0 if the cloth itself crosses there [J]
  std::vector<double> volume_by_frame;  // enclosed volume [m^3]
  long pairs = 0;                       // segments of crossing triangles, including those of fans
  long contours = 0, enclosed = 0, open = 0, not_orientable = 0, unassigned = 0;
  int closed_holes = 0;

  double mean_loss() const;                // over all frames, as published
  std::vector<double> net_losses() const;  // of the simulated frames, less that of the fans, at least 0 [J]
  double mean_net_loss() const;
  double share_above(double net_loss) const;  // fraction of the simulated frames
};

// Closes a cloth once and measures frame after frame. Frames must be finite.
class VolumeCheck {
 public:
  // `garments` is that of close_surface.
  explicit VolumeCheck(const Surface& cloth, std::span<const int> garments = {});
  void add(const Points& x, VolumeFindings&) const;
  // L_sc of the fans at rest [J]. A fan across a hole may cross its own garment, and then it encloses a volume though
  // the cloth is clean. 0 if cloth crosses cloth at rest.
  double of_fans(const Points& rest) const;

 private:
  ClosedSurface closed_;
};

// Measures all frames of a trajectory, where each cloth is a garment. The first frame is the start, which only the
// published mean counts. Throws Error for a file that is no trajectory, and for a frame that is not finite.
VolumeFindings volume_findings(const std::filesystem::path& trajectory);

// The garment of each vertex; cloths begin at the vertices in `first_vertex` (TrajectoryInfo::cloth_first_vertex).
std::vector<int> garments_of_vertices(std::span<const int> first_vertex);

std::string volume_text(const VolumeFindings&);

}  // namespace selvedge
