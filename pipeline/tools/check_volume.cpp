#include "pipeline/tools/check_volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "collision/geometry/error.hpp"
#include "collision/penetration/penetration_loss.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"

namespace selvedge {

namespace {

double mean_of(const std::vector<double>& values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

double VolumeFindings::mean_loss() const { return mean_of(loss_by_frame); }

std::vector<double> VolumeFindings::net_losses() const {
  std::vector<double> net;
  for (std::size_t k = first_made; k < loss_by_frame.size(); ++k)
    net.push_back(std::max(0.0, loss_by_frame[k] - of_fans));
  return net;
}

double VolumeFindings::mean_net_loss() const { return mean_of(net_losses()); }

double VolumeFindings::share_above(double net_loss) const {
  const std::vector<double> net = net_losses();
  if (net.empty()) return 0;
  const auto above = std::ranges::count_if(net, [net_loss](double one) { return one > net_loss; });
  return static_cast<double>(above) / static_cast<double>(net.size());
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

double VolumeCheck::of_fans(const Points& rest) const {
  const Points at = closed_positions(closed_, rest);
  Segments segments;
  const Penetration found = find_penetration(closed_, at, {}, &segments);
  const bool cloth_crosses = std::ranges::any_of(segments.segments, [&](const Segment& s) {
    return !closed_.is_fan(s.triangle[0]) && !closed_.is_fan(s.triangle[1]);
  });
  return cloth_crosses ? 0 : penetration_loss(closed_, at, found);
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
  findings.first_made = 1;
  findings.of_fans = check.of_fans(info.rest);
  for (int i = 0; i < reader.frame_count(); ++i) {
    const Points x = reader.frame(i).x.cast<double>();
    if (!x.allFinite())
      throw Error(fmt::format("frame {} is not finite", i), trajectory.string(),
                  "give a run whose positions are finite");
    check.add(x, findings);
  }
  return findings;
}

std::string volume_text(const VolumeFindings& f) {
  const auto worst = std::ranges::max_element(f.volume_by_frame);
  const double most = worst == f.volume_by_frame.end() ? 0 : *worst;
  return fmt::format(
      "mean L_sc {:.4g} J, above 0.1 in {:.2f} %, above 0.01 in {:.2f} % of the frames that were made, less {:.4g} J "
      "of the fans at rest; {:.4g} J as published, of all frames; at most {:.4g} cm3, in frame {}; "
      "{} contours: {} enclose a volume, {} open, {} not orientable, {} unassigned; {} holes closed",
      f.mean_net_loss(), 100 * f.share_above(0.1), 100 * f.share_above(0.01), f.of_fans, f.mean_loss(), 1e6 * most,
      worst - f.volume_by_frame.begin(), f.contours, f.enclosed, f.open, f.not_orientable, f.unassigned,
      f.closed_holes);
}

}  // namespace selvedge
