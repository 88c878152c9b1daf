#include "pipeline/motions/clip_procedural_track.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/motions/clip.hpp"

namespace selvedge {
namespace {

constexpr double gravity = 9.81, frames_per_second = 30;

// From 0 up to `height` at `top` and back to 0.
double bump(double from, double top, double to, double height, double width, double t) {
  return smooth_between({from, top, to}, {0, height, 0}, width, t);
}

double hop(const Movement& m, double t) {
  double height = 0;
  for (const Flight& f : m.flights) {
    constexpr int pieces = 12;
    const double length = f.to - f.from;
    std::vector<double> times, heights;
    for (int i = 0; i <= pieces; ++i) {
      const double s = static_cast<double>(i) / pieces;
      times.push_back(f.from + s * length);
      heights.push_back(0.5 * gravity * length * length * s * (1 - s));
    }
    height += smooth_between(times, heights, 0.05, t);
  }
  return height;
}

Figure figure_at(const Movement& m, double time) {
  Figure figure = m.keys.front().figure;
  for (std::size_t k = 0; k + 1 < m.keys.size(); ++k) {
    const FigureKey &a = m.keys[k], &b = m.keys[k + 1];
    const double weight =
        (smooth_ramp(time - a.time, m.smoothing) - smooth_ramp(time - b.time, m.smoothing)) / (b.time - a.time);
    figure.values += weight * (b.figure.values - a.figure.values);
  }
  return figure;
}

std::array<FootPose, 2> feet_at(const Movement& m, double time) {
  std::array<FootPose, 2> feet = m.start;
  for (const Footstep& step : m.steps) {
    FootPose& foot = feet[step.side];
    const double length = step.to - step.from, s = std::clamp((time - step.from) / length, 0.0, 1.0);
    // First up, then along, then down: a foot near the ground does not slide.
    const double along = ease((s - 0.08) / 0.86);
    foot.at.x() += along * (step.place.x() - foot.at.x());
    foot.at.z() += along * (step.place.z() - foot.at.z());
    foot.yaw += along * (step.yaw - foot.yaw);
    foot.at.y() += step.lift * 64 * std::pow(s * (1 - s), 3);
    const double width = std::min(0.09, 0.2 * length);
    foot.heel_up +=
        bump(step.from - 0.6 * length, step.from + 0.15 * length, step.from + 0.75 * length, step.toe_off, width, time);
    foot.toe_up += bump(step.from + 0.45 * length, step.to, step.to + 0.3 * length, step.strike, width, time);
  }
  for (const Swing& swing : m.swings) {
    const double s = std::clamp((time - swing.from) / (swing.to - swing.from), 0.0, 1.0);
    FootPose& foot = feet[swing.side];
    foot.at.y() += swing.height * 64 * std::pow(s * (1 - s), 3);
    foot.toe_up += 0.6 * std::min(1.0, swing.height) * 64 * std::pow(s * (1 - s), 3);
  }
  for (FootPose& foot : feet) foot.at.y() += hop(m, time);
  return feet;
}

}  // namespace

double smooth_ramp(double t, double width) {
  if (t <= -1.5 * width) return 0;
  if (t >= 1.5 * width) return t;
  static constexpr double signs[] = {1, -3, 3, -1};
  double sum = 0;
  for (int j = 0; j < 4; ++j) sum += signs[j] * std::pow(std::max(0.0, t / width + 1.5 - j), 4);
  return width * sum / 24;
}

double smooth_between(const std::vector<double>& times, const std::vector<double>& values, double width, double t) {
  double result = values[0];
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const double weight =
        (smooth_ramp(t - times[k], width) - smooth_ramp(t - times[k + 1], width)) / (times[k + 1] - times[k]);
    result += weight * (values[k + 1] - values[k]);
  }
  return result;
}

std::vector<BodyPose> performed(const Movement& m, const Skeleton& k) {
  std::vector<Figure> figures;
  std::vector<std::array<FootPose, 2>> feet;
  const int frames = static_cast<int>(std::lround(m.seconds * frames_per_second));
  for (int f = 0; f < frames; ++f) {
    const double time = f / frames_per_second;
    figures.push_back(figure_at(m, time));
    figures.back().pelvis().y() += hop(m, time);
    feet.push_back(feet_at(m, time));
  }
  return solved(k, std::move(figures), feet);
}

}  // namespace selvedge
