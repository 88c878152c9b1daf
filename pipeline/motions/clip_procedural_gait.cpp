#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/motions/clip_procedural_moves.hpp"

namespace selvedge {
namespace {

const double pi = std::numbers::pi;

// Lengths in legs, times in seconds, angles in radians.
struct Gait {
  int steps = 8;        // the last one brings the feet together
  double step = 0.68;   // from one foot's place to the other's; negative: backwards
  double time = 0.55;   // of a step
  double swing = 0.42;  // share of a cycle of two steps in which a foot is in the air; above 0.5: running
  double lift = 0.06, toe_off = 1.0, strike = 0.3;
  double arm = 0.4, elbow = 0.3, elbow_swing = 0.25, arm_out = 0.22;
  double bob = 0.012, sway = 0.022, twist = 0.12, roll = 0.05;
  double lean = 0.03, crouch = 0;
  double turn = 0;       // of the heading, per step
  double width = 0.8;    // of the feet's distance in the zero pose; negative: they cross
  double knee_lift = 0;  // knees up, as in marching
};

struct Place {
  Vec3 at;
  double heading;
};

// A circle, or a straight line, through the origin along z.
Place on_path(double way, double curvature) {
  const double angle = curvature * way;
  if (std::abs(curvature) < 1e-9) return {Vec3(0, 0, way), 0};
  return {Vec3((1 - std::cos(angle)) / curvature, 0, std::sin(angle) / curvature), angle};
}

Vec3 beside(const Place& place, double left, double ahead) {
  return place.at + turned_left({left, 0, ahead}, place.heading);
}

Movement walked(const Skeleton& k, const Gait& g, double seconds) {
  Movement m = movement(k, seconds);
  m.smoothing = std::min(0.1, 0.14 * g.time);
  const double begin = std::max(0.35, 0.75 * g.time), step = g.step * k.leg, curvature = step == 0 ? 0 : g.turn / step;
  std::vector<double> times = {0, begin}, ways = {0, 0};
  double way = 0, before = 0;
  for (int i = 0; i < g.steps; ++i) {
    const int side = i % 2;
    const double touch = begin + (i + 1) * g.time, swing = 2 * g.time * (i == 0 ? std::min(g.swing, 0.42) : g.swing);
    before = way;
    if (i + 1 < g.steps) way += i == 0 ? 0.6 * step : step;
    const bool ends = i == 0 || i + 1 >= g.steps;
    const Vec3 stand = stance(k, side);
    const Place place = on_path(way, curvature);
    m.steps.push_back({side, touch - swing, touch,
                       beside(place, (i + 1 < g.steps ? g.width : 1) * stand.x(), stand.z()), place.heading,
                       g.lift * k.leg + (ends ? 0.3 : 1) * g.knee_lift * k.leg, (ends ? 0.6 : 1) * g.toe_off,
                       (ends ? 0.4 : 1) * g.strike});
    if (g.swing > 0.5 && i > 0 && i + 1 < g.steps) {
      const double flight = (g.swing - 0.5) * 2 * g.time;
      m.flights.push_back({touch - flight, touch});
    }
    times.push_back(touch);
    ways.push_back(0.5 * (way + before));
  }
  times.push_back(times.back() + 0.5 * g.time);
  ways.push_back(way);
  // The other foot closes the stance if the last step has crossed or narrowed it.
  const int other = g.steps % 2;
  const Place stop = on_path(way, curvature);
  if (g.width != 1)
    m.steps.push_back({other, times.back() + 0.1, times.back() + 0.55,
                       beside(stop, stance(k, other).x(), stance(k, other).z()), stop.heading, 0.03 * k.leg, 0.2, 0});
  const double last = begin + g.steps * g.time;
  for (double t = 0; t < seconds; t += 0.025) {
    const double phase = pi * (t - begin) / g.time;  // odd multiples of pi: the left foot comes down
    const auto fade = [&](double s) { return s <= 0 ? 0 : s >= 1 ? 1 : s * s * (3 - 2 * s); };
    const double vigour = fade((t - begin) / (1.2 * g.time)) * fade((last + 0.3 * g.time - t) / (1.2 * g.time));
    const double left = -std::cos(phase) * vigour, mid = std::sin(phase) * vigour;
    const Place place = on_path(smooth_between(times, ways, 0.7 * g.time, t), curvature);
    Figure f = standing();
    f.pelvis() = beside(place, -g.sway * k.leg * mid, -0.04 * step * vigour);
    f.pelvis().y() = k.leg * (-g.bob * vigour * std::cos(2 * phase) - g.crouch * vigour);
    f.yaw() = place.heading - g.twist * left;
    f.lean() = g.lean * vigour;
    f.roll() = -g.roll * mid;
    f.spine() = Vec3(0.3 * g.lean * vigour, -0.8 * g.roll * mid, 2 * g.twist * left);
    f.head() = Vec3(-g.lean * vigour, 0, -g.twist * left);
    for (const int side : {0, 1}) {
      const double swing = (side ? 1 : -1) * left;
      const double out = 0.45 + (g.arm_out - 0.45) * vigour;
      set_arm(f, side, out, 0.05 + g.arm * swing + 0.1 * vigour * g.arm, 0.1,
              0.2 + (g.elbow - 0.2 + g.elbow_swing * (0.5 + 0.5 * swing)) * vigour);
    }
    m.keys.push_back({t, f});
  }
  return m;
}

NamedMovement gait(const std::string& name, double seconds, const Gait& g) {
  return {name, [g, seconds](const Skeleton& k) { return walked(k, g, seconds); }};
}

}  // namespace

std::vector<NamedMovement> gait_movements() {
  return {
      gait("walk", 6, {}),
      gait("walk_slow", 7.5,
           {.steps = 7, .step = 0.5, .time = 0.8, .lift = 0.045, .toe_off = 0.8, .strike = 0.2, .arm = 0.2}),
      gait("walk_fast", 6,
           {.steps = 10,
            .step = 0.8,
            .time = 0.45,
            .toe_off = 1.15,
            .strike = 0.3,
            .arm = 0.6,
            .elbow = 0.6,
            .twist = 0.16,
            .lean = 0.08}),
      gait("walk_arms", 6,
           {.steps = 8,
            .step = 0.7,
            .time = 0.56,
            .arm = 1.0,
            .elbow = 0.15,
            .elbow_swing = 0.1,
            .arm_out = 0.3,
            .twist = 0.2}),
      gait("walk_turning", 7, {.steps = 10, .step = 0.6, .turn = 0.35}),
      gait("walk_backward", 6.5, {.step = -0.5, .time = 0.62, .lift = 0.07, .toe_off = 0.25, .strike = 0, .arm = -0.2}),
      gait("strut", 7,
           {.steps = 8,
            .step = 0.66,
            .time = 0.6,
            .toe_off = 1.0,
            .arm = 0.5,
            .elbow = 0.25,
            .sway = 0.04,
            .twist = 0.25,
            .roll = 0.16,
            .lean = -0.04,
            .width = 0.5}),
      gait("march", 6,
           {.steps = 8,
            .step = 0.55,
            .time = 0.55,
            .lift = 0.08,
            .toe_off = 0.3,
            .strike = 0,
            .arm = 0.9,
            .elbow = 0.2,
            .elbow_swing = 0.1,
            .lean = 0,
            .knee_lift = 0.28}),
      gait("sneak", 7.5,
           {.steps = 7,
            .step = 0.6,
            .time = 0.8,
            .lift = 0.12,
            .toe_off = 0.5,
            .strike = 0.05,
            .arm = 0.25,
            .elbow = 1.2,
            .lean = 0.4,
            .crouch = 0.2}),
      gait("run", 6,
           {.steps = 12,
            .step = 0.95,
            .time = 0.37,
            .swing = 0.64,
            .lift = 0.2,
            .toe_off = 1.1,
            .strike = 0.1,
            .arm = 0.75,
            .elbow = 1.5,
            .elbow_swing = 0.2,
            .bob = 0.02,
            .sway = 0.012,
            .twist = 0.16,
            .lean = 0.14,
            .crouch = 0.05,
            .width = 0.4})};
}

}  // namespace selvedge
