#include "pipeline/measures/run_measures.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/measures/published_measures.hpp"

namespace selvedge {
namespace {

constexpr int settling_frames = 2;  // first frames, left out of hood_losses: garments fall into place

struct MeasureMeaning {
  const char *name, *text;
};
constexpr MeasureMeaning meanings[]{
    {"strain", "principal strain |s - 1|, mean over triangles"},
    {"strain_99", "its 99th percentile"},
    {"strain_most", "the largest of all frames"},
    {"kinetic", "kinetic energy [J]"},
    {"pairs_mean", "intersecting pairs of cloth triangles that share no vertex, a frame"},
    {"body_pairs_mean", "intersecting pairs of a cloth's and an obstacle's triangle, a frame"},
    {"pairs_end", "in the last frame"},
    {"pairs_start", "where the run starts"},
    {"depth", "of the deepest cloth vertex in a closed body, largest of all frames [m]"},
    {"depth_uncrossed", "the same over frames in which no obstacle passes through itself [m]"},
    {"crossed_frames", "frames in which one does and a vertex lies inside [%]"},
    {"pushed_out", "vertices pushed out of obstacles, a frame"},
    {"jitter", "RMS change of acceleration [m/frame2]"},
    {"high_share", "part of the velocities' power above a quarter of the frame rate"},
    {"collision_percent", "vertices behind the body's nearest vertex [%]"},
    {"collision_free_frames", "frames in which the audit finds no pair with the body and no vertex in it [%]"},
    {"static_share", "vertices that moved by 0.3 mm at most in the frame [%]"},
    {"hood_stretching", "hood_losses, from the third frame on [J]"},
    {"hood_bending", "[J]"},
    {"hood_inertia", "[J]"},
    {"hood_gravity", "[J]"},
    {"hood_friction", "[J]"},
    {"hood_collision", "[J]"},
    {"hood_total", "their sum [J]"},
    {"grad_norm", "mean over free vertices of |d hood_total / d x| [N]"},
    {"l2_mm", "mean distance of the vertices to the reference [mm]"},
    {"e3d", "|X - X*| / |X*| to the reference"},
    {"excess", "hood_total above the least that is found from the frame, of some frames [J]"},
    {"residual", "mass-scaled gradient norm of hood_total in these frames [N/sqrt(kg)]"}};

}  // namespace

std::string meaning_of(const std::string& measure) {
  const auto* found = std::ranges::find_if(meanings, [&](const MeasureMeaning& m) { return measure == m.name; });
  return found == std::end(meanings) ? std::string() : found->text;
}

RunMeasures::RunMeasures(const Scene& scene, int frames, int judged)
    : scene_(scene), wanted_(frames), judged_(judged), judge_(make_hood_judge(scene)) {}

void RunMeasures::begin(const Points& x, const Points& body, int pairs) {
  last_.before = last_.now = x;
  last_.body_before = last_.body_now = body;
  pairs_ = {pairs};
  trace_.add(x);
  spectrum_.add(x);
}

void RunMeasures::judge(const MeasuredFrame& frame) {
  last_.next = frame.x;
  last_.body_next = frame.body;
  last_.acceleration = frame.acceleration;
  if (frames_ <= settling_frames) return;
  const HoodLosses losses = hood_losses_of(judge_, last_);
  ++hood_frames_;
  for (const auto& [name, value] : losses.terms) sums_["hood_" + name] += value;
  sums_["hood_total"] += losses.total;
  sums_["grad_norm"] += losses.grad_norm;
  if (judged_so_far_ >= judged_ || frames_ < (judged_so_far_ + 1) * wanted_ / judged_) return;
  const Suboptimality found = suboptimality_of(judge_, last_);
  sums_["excess"] += found.excess;
  sums_["residual"] += found.residual;
  ++judged_so_far_;
}

void RunMeasures::add(MeasuredFrame frame) {
  ++frames_;
  const StrainMeasure strain = strain_of(scene_, frame.x);
  sums_["strain"] += strain.mean;
  sums_["strain_99"] += strain.p99;
  sums_["kinetic"] += frame.kinetic;
  sums_["pairs_mean"] += frame.pairs;
  sums_["body_pairs_mean"] += frame.body_pairs;
  sums_["collision_percent"] += collision_percent(judge_.body, frame.body, frame.x);
  sums_["static_share"] += static_share(last_.now, frame.x);
  mosts_["strain_most"] = std::max(mosts_["strain_most"], strain.most);
  mosts_["depth"] = std::max(mosts_["depth"], frame.depth);
  mosts_["depth_uncrossed"] = std::max(mosts_["depth_uncrossed"], frame.crossed ? 0 : frame.depth);
  sums_["crossed_frames"] += frame.crossed ? 100 : 0;
  sums_["pushed_out"] += frame.pushed_out;
  free_frames_ += frame.meets_body ? 0 : 1;
  pairs_.push_back(frame.pairs);
  jitter_squares_ += trace_.add(frame.x);
  spectrum_.add(frame.x);
  judge(frame);
  last_.before = std::move(last_.now);
  last_.now = std::move(frame.x);
  last_.body_before = std::move(last_.body_now);
  last_.body_now = std::move(frame.body);
}

std::map<std::string, double> RunMeasures::values() const {
  if (frames_ == 0) return {};
  std::map<std::string, double> values = mosts_;
  for (const auto& [name, sum] : sums_) {
    const bool of_some = name == "excess" || name == "residual";
    const bool of_hood = name.starts_with("hood_") || name == "grad_norm";
    values[name] = sum / (of_some ? judged_so_far_ : of_hood ? hood_frames_ : frames_);
  }
  values["pairs_start"] = pairs_.front();
  values["pairs_end"] = pairs_.back();
  values["collision_free_frames"] = 100.0 * free_frames_ / frames_;
  if (frames_ >= 3) values["jitter"] = std::sqrt(jitter_squares_ / (frames_ - 2));
  values["high_share"] = spectrum_.high_share();
  return values;
}

}  // namespace selvedge
