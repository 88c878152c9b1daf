#include <cmath>

#include "pipeline/motions/clip_procedural_moves.hpp"

namespace selvedge {
namespace {

// Side steps to and fro, arms swinging across.
Movement dance_sway(const Skeleton& k) {
  Movement m = from_rest(k, 8, 0.15, 0.4);
  const double beat = 0.55, wide = 0.35 * k.leg;
  for (int i = 0; i < 12; ++i) {
    // Left foot out, right foot to it, right foot out, left foot to it.
    const double t = 0.6 + beat * i;
    const int side = (i % 4 == 0 || i % 4 == 3) ? 0 : 1;
    const double x = i % 4 == 0 || i % 4 == 1 ? wide : 0, to = i % 4 < 2 ? 1 : -1;
    const Vec3 stand = stance(k, side);
    m.steps.push_back({side, t, t + 0.8 * beat, stand + Vec3(x, 0, 0), 0, 0.06 * k.leg, 0.25, 0});
    Figure f = standing();
    const bool open = i % 2 == 0;
    f.pelvis() = Vec3(open ? 0.5 * wide : x, -(open ? 0.07 : 0.03) * k.leg, 0);
    f.roll() = 0.1 * to;
    f.spine() = Vec3(0.05, 0.16 * to, 0.25 * to);
    f.head() = Vec3(0.05, -0.05 * to, 0.1 * to);
    set_arm(f, 0, open ? 1.1 : 0.5, 0.4 + 0.3 * to, 0.4, 0.9);
    set_arm(f, 1, open ? 1.1 : 0.5, 0.4 - 0.3 * to, 0.4, 0.9);
    m.keys.push_back({t + 0.85 * beat, f});
  }
  return to_rest(m, 7.6);
}

// A box of six steps, turning a little, arms held as if round a partner.
Movement dance_waltz(const Skeleton& k) {
  Movement m = from_rest(k, 9, 0.2, 0.4);
  const double beat = 0.6, side_way = 0.35 * k.leg, way = 0.4 * k.leg;
  Vec3 at[2] = {Vec3::Zero(), Vec3::Zero()};
  for (int i = 0; i < 12; ++i) {
    const int step = i % 6, side = i % 2 == 0 ? 0 : 1;  // left forward, right aside, left to it, and back
    const double t = 0.7 + beat * i;
    const Vec3 steps[6] = {{0, 0, way},       {-side_way, 0, way}, {-side_way, 0, way},
                           {-side_way, 0, 0}, {0, 0, 0},           {0, 0, 0}};
    at[side] = steps[step];
    m.steps.push_back({side, t, t + 0.85 * beat, stance(k, side) + at[side], 0, 0.05 * k.leg, 0.35, 0.1});
    Figure f = standing();
    const Vec3 middle = 0.5 * (at[0] + at[1]);
    const int third = i % 3;
    f.pelvis() = middle + Vec3(0, (third == 0 ? -0.1 : third == 1 ? -0.02 : 0.0) * k.leg, 0);
    f.yaw() = (step < 3 ? -0.12 : 0.12);
    f.roll() = (third == 1 ? 0.06 : 0) * (step < 3 ? 1 : -1);
    f.spine() = Vec3(-0.08, third == 1 ? 0.12 : 0.0, 0.1 * (step < 3 ? 1 : -1));
    f.head() = Vec3(-0.05, 0, 0.25);
    set_arm(f, 0, 1.35, 0.35, -0.3, 0.6);
    set_arm(f, 1, 1.15, 0.75, 0.3, 1.1);
    m.keys.push_back({t + 0.8 * beat, f});
  }
  return to_rest(m, 8.6);
}

// Knees bent, hips and shoulders turning against each other, on the balls of the feet.
Movement dance_twist(const Skeleton& k) {
  Movement m = from_rest(k, 7, 0.11, 0.4);
  for (int i = 0; i < 12; ++i) {
    const double to = i % 2 == 0 ? 1 : -1, depth = 0.1 + 0.08 * std::sin(0.52 * i);
    Figure f = standing();
    f.pelvis() = Vec3(0.02 * to * k.leg, -depth * k.leg, -0.02 * k.leg);
    f.yaw() = 0.35 * to;
    f.lean() = 0.12;
    f.spine() = Vec3(0.1, 0.06 * to, -0.6 * to);
    f.head() = Vec3(-0.1, 0, 0.2 * to);
    set_arm(f, 0, 0.45, 0.35 - 0.45 * to, 0.2, 1.5);
    set_arm(f, 1, 0.45, 0.35 + 0.45 * to, 0.2, 1.5);
    f.heel_up(0) = f.heel_up(1) = 0.2;
    m.keys.push_back({0.9 + 0.45 * i, f});
  }
  return to_rest(m, 6.6);
}

// One arm up to the side and down across, hips going along.
Movement dance_disco(const Skeleton& k) {
  Movement m = from_rest(k, 7, 0.13, 0.4);
  m.steps.push_back({0, 0.4, 0.85, stance(k, 0) + Vec3(0.22 * k.leg, 0, 0), 0.2, 0.05 * k.leg, 0.2, 0});
  for (int i = 0; i < 10; ++i) {
    const bool up = i % 2 == 0;
    const int side = i < 5 ? 1 : 0;
    const double s = k.mirror[side];
    Figure f = standing();
    f.pelvis() = Vec3((0.11 + (up ? 0.06 : -0.06) * s) * k.leg, -0.07 * k.leg, 0);
    f.roll() = (up ? 0.1 : -0.1) * s;
    f.yaw() = (up ? 0.12 : -0.15) * s * -1;
    f.spine() = Vec3(up ? -0.1 : 0.15, (up ? 0.15 : -0.1) * s, (up ? -0.25 : 0.3) * -s);
    f.head() = Vec3(up ? -0.2 : 0.15, 0, (up ? -0.3 : 0.2) * -s);
    if (up) {
      set_arm(f, side, 2.3, 0.3, 0, 0.1);
    } else {
      reach(f, k, side, Vec3(-0.2, -0.55, 0.66), Vec3(1, -0.5, 0.4));
    }
    reach(f, k, 1 - side, Vec3(0.48, -0.8, 0.2), Vec3(1, 0, -0.2));  // hand on the hip
    m.keys.push_back({1.1 + 0.5 * i, f});
  }
  m.steps.push_back({0, 5.95, 6.4, stance(k, 0), 0, 0.05 * k.leg, 0.2, 0});
  return to_rest(m, 6.6);
}

// Round in a circle on quick small steps with the arms flowing up and down; a skirt flies.
Movement dance_pirouette(const Skeleton& k) {
  Movement m = from_rest(k, 7, 0.22, 0.4);
  Figure f = standing();
  double yaw = 0;
  for (int i = 0; i < 12; ++i) {
    const double t = 0.7 + 0.42 * i, turn = i < 2 || i > 9 ? 0.7 : 1.2;
    yaw += turn;
    const int side = i % 2;
    const double at = yaw + (side == 0 ? 0.1 : -0.1);
    m.steps.push_back({side, t, t + 0.36, turned_left(0.8 * stance(k, side), at), at, 0.06 * k.leg, 0.3, 0});
    f.yaw() = yaw - 0.2;
    f.pelvis() = Vec3(0, 0.02 * k.leg, 0);
    f.spine() = Vec3(-0.06, 0, 0.15);
    f.heel_up(0) = f.heel_up(1) = 0.3;
    const double rise = 0.5 - 0.5 * std::cos(0.55 * i);
    set_arms(f, 0.9 + 1.3 * rise, 0.35, 0.1, 0.45);
    m.keys.push_back({t + 0.35, f});
  }
  for (int side = 0; side < 2; ++side)
    m.steps.push_back({side, 5.9 + 0.02 + 0.3 * side, 6.2 + 0.3 * side, turned_left(stance(k, side), yaw), yaw,
                       0.03 * k.leg, 0.1, 0});
  Figure end = standing();
  end.yaw() = yaw;
  return to_rest(m, 6.4, end);
}

}  // namespace

std::vector<NamedMovement> dance_movements() {
  return {{"dance_sway", dance_sway},
          {"dance_waltz", dance_waltz},
          {"dance_twist", dance_twist},
          {"dance_disco", dance_disco},
          {"dance_pirouette", dance_pirouette}};
}

}  // namespace selvedge
