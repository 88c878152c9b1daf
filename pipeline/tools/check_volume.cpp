#include "pipeline/tools/check_volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "collision/geometry/error.hpp"
#include "collision/penetration/penetration_loss.hpp"
#include "pipeline/formats/trajectory_hdf5.hpp"

namespace selvedge {

double VolumeFindings::mean_loss() const {
  if (loss_by_frame.empty()) return 0;
  return std::accumulate(loss_by_frame.begin(), loss_by_frame.end(), 0.0) / static_cast<double>(loss_by_frame.size());
}

double VolumeFindings::share_above(double loss) const {
  if (loss_by_frame.empty()) return 0;
  const auto above = std::ranges::count_if(loss_by_frame, [loss](double one) { return one > loss; });
  return static_cast<double>(above) / static_cast<double>(loss_by_frame.size());
}

VolumeCheck::VolumeCheck(const Surface& cloth, std::span<const int> garments)
    : closed_(close_surface(cloth, garments)) {}

void VolumeCheck::add(const Points& x, VolumeFindings& findings) const {
  const Points at = closed_positions(closed_, x);
  Segments segments;
  const Penetration found = find_penetration(closed_, at, {}, &segments);
  findings.loss_by_frame.push_back(penetration_loss(closed_, at, found));
  double volume = 0;
  for (const PenetrationRegion& region : found.regions) volume += std::abs(region.volume);
  findings.volume_by_frame.push_back(volume);
  findings.pairs += static_cast<long>(segments.segments.size());
  findings.closed_holes = static_cast<int>(closed_.loops.size());
  findings.contours += static_cast<long>(found.contours.size());
  const auto count = [&](ContourVolume what) { return static_cast<long>(std::ranges::count(found.contours, what)); };
  findings.enclosed += count(ContourVolume::enclosed);
  findings.open += count(ContourVolume::open);
  findings.not_orientable += count(ContourVolume::not_orientable);
  findings.unassigned += count(ContourVolume::unassigned);
}

std::vector<int> garments_of_vertices(std::span<const int> first_vertex) {
  std::vector<int> garments;
  for (std::size_t cloth = 0; cloth + 1 < first_vertex.size(); ++cloth)
    garments.resize(static_cast<std::size_t>(first_vertex[cloth + 1]), static_cast<int>(cloth));
  return garments;
}

VolumeFindings volume_findings(const std::filesystem::path& trajectory) {
  const TrajectoryReader reader(trajectory);
  const TrajectoryInfo& info = reader.info();
  const VolumeCheck check(make_surface(static_cast<int>(info.rest.rows()), info.triangles),
                          garments_of_vertices(info.cloth_first_vertex));
  VolumeFindings findings;
  for (int i = 0; i < reader.frame_count(); ++i) {
    const Points x = reader.frame(i).x.cast<double>();
    if (!x.allFinite()) throw Error(fmt::format("frame {} is not finite", i), trajectory.string(), "");
    check.add(x, findings);
  }
  return findings;
}

std::string volume_text(const VolumeFindings& f) {
  const auto worst = std::ranges::max_element(f.volume_by_frame);
  const double most = worst == f.volume_by_frame.end() ? 0 : *worst;
  return fmt::format(
      "mean L_sc {:.4g} J, above 0.1 in {:.2f} %, above 0.01 in {:.2f} % of the frames; at most {:.4g} cm3, in frame "
      "{}; "
      "{} contours: {} enclose a volume, {} open, {} not orientable, {} unassigned; {} holes closed",
      f.mean_loss(), 100 * f.share_above(0.1), 100 * f.share_above(0.01), 1e6 * most, worst - f.volume_by_frame.begin(),
      f.contours, f.enclosed, f.open, f.not_orientable, f.unassigned, f.closed_holes);
}

}  // namespace selvedge
