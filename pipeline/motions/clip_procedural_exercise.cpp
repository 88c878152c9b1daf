#include "pipeline/motions/clip_procedural_moves.hpp"

// Movements on the spot.
namespace selvedge {
namespace {

Movement arms_up_down(const Skeleton& k) {
  Movement m = from_rest(k, 5, 0.2, 0.4);
  Figure side = standing(), up = standing(), front = standing();
  set_arms(side, 1.55, 0, 0, 0.1);
  set_arms(up, 2.8, 0, 0.2, 0.15);
  set_arms(front, 0.2, 1.55, 0, 0.1);
  m.keys.push_back({1.1, side});
  hold(m, 1.7, 2.0, up);
  hold(m, 2.8, 3.1, front);
  return to_rest(m, 4.2);
}

// Both arms go round in circles: out, up, forward and down.
Movement arm_circles(const Skeleton& k) {
  Movement m = from_rest(k, 6, 0.12, 0.4);
  Figure out = standing(), up = standing(), front = standing(), low = standing();
  set_arms(out, 1.45, -0.2, 0, 0.1);
  set_arms(up, 2.7, 0.2, 0, 0.1);
  set_arms(front, 0.5, 1.6, 0, 0.1);
  set_arms(low, 0.35, 0.3, 0, 0.15);
  for (int round = 0; round < 3; ++round) {
    const double t = 0.8 + 1.6 * round;
    m.keys.insert(m.keys.end(), {{t, out}, {t + 0.4, up}, {t + 0.8, front}, {t + 1.2, low}});
  }
  return to_rest(m, 5.5);
}

// Once round and back, in steps of a quarter turn.
Movement spin(const Skeleton& k) {
  Movement m = from_rest(k, 7, 0.25, 0.5);
  Figure f = standing();
  set_arms(f, 1.2, 0.1, 0, 0.2);
  double yaw = 0;
  for (int i = 0; i < 8; ++i) {
    const double t = 0.7 + 0.68 * i, quarter = i < 4 ? 1.5707963267948966 : -1.5707963267948966;
    yaw += quarter;
    for (int step = 0; step < 2; ++step) {
      const int side = (i < 4) == (step == 0) ? 0 : 1;  // the foot on the side of the turn goes first
      m.steps.push_back({side, t + 0.34 * step, t + 0.34 * (step + 1) - 0.02, turned_left(stance(k, side), yaw), yaw,
                         0.05 * k.leg, 0.15, 0});
    }
    f.yaw() = yaw;
    m.keys.push_back({t + 0.6, f});
  }
  return to_rest(m, 6.5);
}

Figure squatting(const Skeleton& k, double depth) {
  Figure f = standing();
  f.pelvis() = Vec3(0, -depth * k.leg, -0.28 * depth * k.leg);
  f.lean() = 1.1 * depth;
  f.spine() = Vec3(0.4 * depth, 0, 0);
  f.head() = Vec3(-1.0 * depth, 0, 0);
  for (const int side : {0, 1}) f.knee_out(side) = 0.25;
  set_arms(f, 0.15, 1.45, 0, 0.15);
  return f;
}

Movement squat(const Skeleton& k) {
  Movement m = from_rest(k, 6, 0.25, 0.5);
  for (int i = 0; i < 2; ++i) {
    const double t = 1.6 + 2.5 * i;
    hold(m, t, t + 0.4, squatting(k, i == 0 ? 0.42 : 0.56));
    hold(m, t + 1.5, t + 1.6, standing());
  }
  return to_rest(m, 5.8);
}

Movement jump(const Skeleton& k) {
  Movement m = from_rest(k, 5, 0.1, 0.4);
  for (int i = 0; i < 2; ++i) {
    const double t = 0.5 + 2.2 * i, leave = t + 0.85, land = leave + 0.42;
    Figure low = squatting(k, 0.36), high = standing(), soft = squatting(k, 0.3);
    set_arms(low, 0.3, -0.7, 0, 0.2);
    set_arms(high, 1.2, 1.9, 0, 0.3);
    set_arms(soft, 0.5, 0.9, 0, 0.4);
    hold(m, t + 0.5, t + 0.58, low);
    hold(m, leave - 0.02, land - 0.1, high);
    m.keys.push_back({land + 0.25, soft});
    hold(m, land + 0.85, land + 0.9, standing());
    m.flights.push_back({leave, land});
    // The feet stay in place and only point down in flight.
    for (const int side : {0, 1}) m.steps.push_back({side, leave, land, stance(k, side), 0, 0, 0.6, 0});
  }
  return to_rest(m, 4.8);
}

// Legs apart with the arms up, and back, in small jumps.
Movement jumping_jacks(const Skeleton& k) {
  Movement m = from_rest(k, 6, 0.11, 0.4);
  for (int i = 0; i < 6; ++i) {
    const double t = 0.7 + 0.8 * i;
    const bool apart = i % 2 == 0;
    Figure dip = standing(), f = standing();
    dip.pelvis().y() = -0.06 * k.leg;
    if (apart) {
      set_arms(f, 2.6, 0.05, 0, 0.2);
    } else {
      set_arms(dip, 2.3, 0.05, 0, 0.2);
    }
    m.keys.push_back({t - 0.12, dip});
    m.keys.push_back({t + 0.32, f});
    m.flights.push_back({t, t + 0.3});
    for (const int side : {0, 1}) {
      const Vec3 stand = stance(k, side);
      const double x = stand.x() + (apart ? 0.28 * k.leg * k.mirror[side] : 0);
      m.steps.push_back({side, t, t + 0.3, Vec3(x, 0, stand.z()), 0, 0, 0.25, 0});
    }
  }
  return to_rest(m, 5.5);
}

Movement side_bends(const Skeleton& k) {
  Movement m = from_rest(k, 6, 0.25, 0.5);
  for (int i = 0; i < 2; ++i) {
    Figure f = standing();
    const double to = i == 0 ? 1 : -1;
    f.spine() = Vec3(0, 0.75 * to, 0);
    f.roll() = -0.12 * to;
    f.head() = Vec3(0, 0.3 * to, 0);
    f.pelvis().x() = -0.06 * to * k.leg;
    set_arm(f, i == 0 ? 1 : 0, 2.6, 0.1, 0.3, 0.5);
    set_arm(f, i == 0 ? 0 : 1, 0.9, 0.1, 0.1, 0.15);
    hold(m, 1.6 + 2.5 * i, 2.0 + 2.5 * i, f);
    if (i == 0) m.keys.push_back({2.9, standing()});
  }
  return to_rest(m, 5.6);
}

Movement twist(const Skeleton& k) {
  Movement m = from_rest(k, 5, 0.16, 0.4);
  Figure middle = standing();
  set_arms(middle, 1.4, 0.1, 0, 0.5);
  m.keys.push_back({0.9, middle});
  for (int i = 0; i < 4; ++i) {
    Figure f = middle;
    const double to = i % 2 == 0 ? 1 : -1;
    f.spine() = Vec3(0.05, 0, 0.75 * to);
    f.yaw() = 0.3 * to;
    f.head() = Vec3(0, 0, 0.3 * to);
    m.keys.push_back({1.5 + 0.75 * i, f});
  }
  return to_rest(m, 4.6);
}

Movement kick(const Skeleton& k) {
  Movement m = from_rest(k, 6, 0.13, 0.4);
  for (const int side : {0, 1}) {
    const double t = 0.7 + 2.6 * side, s = k.mirror[side];
    const Vec3 stand = stance(k, side);
    Figure shift = standing(), high = standing();
    shift.pelvis().x() = -s * 0.09 * k.leg;
    high.pelvis() = Vec3(-s * 0.1 * k.leg, 0, 0.03 * k.leg);
    high.lean() = -0.22;
    high.spine() = Vec3(0.25, 0, 0);
    high.yaw() = -s * 0.15;
    set_arm(high, side, 0.6, -0.5, 0, 0.3);
    set_arm(high, 1 - side, 0.5, 0.9, 0.2, 0.4);
    m.keys.push_back({t, shift});
    hold(m, t + 0.75, t + 0.8, high);
    hold(m, t + 1.55, t + 1.7, shift);
    m.keys.push_back({t + 2.1, standing()});
    m.steps.push_back({side, t + 0.1, t + 0.85, stand + Vec3(0, 0, 0.92 * k.leg), 0, 0, 0.4, 0});
    m.steps.push_back({side, t + 0.85, t + 1.55, stand, 0, 0, 0, 0});
    m.swings.push_back({side, t + 0.1, t + 1.55, 0.72 * k.leg});
  }
  return to_rest(m, 5.8);
}

Movement lunge(const Skeleton& k) {
  Movement m = from_rest(k, 8, 0.22, 0.4);
  for (const int side : {0, 1}) {
    const double t = 0.6 + 3.5 * side;
    const Vec3 stand = stance(k, side);
    Figure f = standing(), low = standing();
    f.pelvis() = Vec3(0, -0.08 * k.leg, 0.35 * k.leg);
    low.pelvis() = Vec3(0, -0.42 * k.leg, 0.4 * k.leg);
    low.lean() = 0.12;
    low.heel_up(1 - side) = 0.75;
    f.heel_up(1 - side) = 0.35;
    set_arms(low, 0.7, 0.25, 0.8, 1.2);
    m.steps.push_back({side, t, t + 0.7, stand + Vec3(0, 0, 0.85 * k.leg), 0, 0.1 * k.leg, 0.3, 0.15});
    m.steps.push_back({side, t + 2.2, t + 2.95, stand, 0, 0.1 * k.leg, 0.2, 0});
    m.keys.push_back({t + 0.65, f});
    hold(m, t + 1.3, t + 1.6, low);
    m.keys.push_back({t + 2.3, f});
    hold(m, t + 3.1, t + 3.3, standing());
  }
  return to_rest(m, 7.8);
}

}  // namespace

std::vector<NamedMovement> exercise_movements() {
  return {{"arms_up_down", arms_up_down},
          {"arm_circles", arm_circles},
          {"spin", spin},
          {"squat", squat},
          {"jump", jump},
          {"jumping_jacks", jumping_jacks},
          {"side_bends", side_bends},
          {"twist", twist},
          {"kick", kick},
          {"lunge", lunge}};
}

}  // namespace selvedge
