#include "pipeline/motions/clip_procedural_moves.hpp"

// What people do without thinking.
namespace selvedge {
namespace {

Movement idle(const Skeleton& k) {
  Movement m = from_rest(k, 8, 0.5, 0.8);
  for (int i = 0; i < 4; ++i) {
    Figure f = standing();
    const double to = i % 2 == 0 ? 1 : -1;
    f.pelvis() = Vec3(0.035 * to * k.leg, -0.004 * k.leg, 0.01 * to * k.leg);
    f.roll() = 0.05 * to;
    f.spine() = Vec3(0.03, 0.07 * to, 0.08 * to);
    f.head() = Vec3(0.05 * to, 0, 0.35 * to);
    set_arm(f, 0, 0.4, 0.08 * to, 0.2, 0.25);
    set_arm(f, 1, 0.4, -0.06 * to, 0.2, 0.3);
    hold(m, 1.6 + 1.4 * i, 2.2 + 1.4 * i, f);
  }
  return to_rest(m, 7.2);
}

Movement sit_down(const Skeleton& k) {
  Movement m = from_rest(k, 7, 0.25, 0.5);
  Figure over = standing(), sat = standing();
  over.pelvis() = Vec3(0, -0.22 * k.leg, -0.2 * k.leg);
  over.lean() = 0.75;
  over.spine() = Vec3(0.3, 0, 0);
  over.head() = Vec3(-0.6, 0, 0);
  set_arms(over, 0.25, 0.9, 0, 0.3);
  sat.pelvis() = Vec3(0, -0.5 * k.leg, -0.48 * k.leg);
  sat.lean() = 0.05;
  sat.spine() = Vec3(0.1, 0, 0);
  set_arms(sat, 0.2, 0.5, 0.1, 0.9);
  m.keys.push_back({1.3, over});
  hold(m, 2.2, 4.2, sat);
  m.keys.push_back({5.1, over});
  return to_rest(m, 6.2);
}

// Each hand in turn across the chest to the other side, the trunk turning with it.
Movement reach_across(const Skeleton& k) {
  Movement m = from_rest(k, 6, 0.2, 0.4);
  for (const int side : {0, 1}) {
    const double t = 0.6 + 2.7 * side, s = k.mirror[side];
    Figure front = standing(), across = standing();
    reach(front, k, side, Vec3(0.25, -0.25, 0.75), Vec3(0.6, -1, 0));
    reach(across, k, side, Vec3(-0.35, -0.12, 0.75), Vec3(0.6, -1, 0.2));
    across.spine() = Vec3(0.1, 0, -0.45 * s);
    across.head() = Vec3(0, 0, -0.3 * s);
    across.yaw() = -0.12 * s;
    m.keys.push_back({t + 0.6, front});
    hold(m, t + 1.2, t + 1.6, across);
    m.keys.push_back({t + 2.1, front});
  }
  return to_rest(m, 5.6);
}

Movement bow(const Skeleton& k) {
  Movement m = from_rest(k, 5, 0.25, 0.5);
  Figure f = standing();
  f.lean() = 0.95;
  f.spine() = Vec3(0.5, 0, 0);
  f.head() = Vec3(0.25, 0, 0);
  f.pelvis() = Vec3(0, 0, -0.14 * k.leg);
  set_arms(f, 0.3, 1.0, 0.1, 0.2);
  hold(m, 1.8, 2.7, f);
  return to_rest(m, 4.2);
}

// Up with both arms on the balls of the feet, then down toward the toes.
Movement stretch(const Skeleton& k) {
  Movement m = from_rest(k, 8, 0.28, 0.5);
  Figure up = standing(), down = standing();
  set_arms(up, 2.3, 0.2, 0.3, 0.3);
  up.spine() = Vec3(-0.25, 0, 0);
  up.head() = Vec3(-0.25, 0, 0);
  for (const int side : {0, 1}) {
    up.heel_up(side) = 0.5;
    up.shrug(side) = 0.1;
  }
  up.pelvis() = Vec3(0, 0.08 * k.leg, 0.08 * k.leg);
  down.lean() = 1.35;
  down.spine() = Vec3(0.85, 0, 0);
  down.head() = Vec3(0.3, 0, 0);
  down.pelvis() = Vec3(0, -0.01 * k.leg, -0.16 * k.leg);
  set_arms(down, 0.2, 1.6, 0, 0.15);
  hold(m, 1.9, 2.6, up);
  hold(m, 4.5, 5.2, down);
  return to_rest(m, 7.1);
}

Movement wave(const Skeleton& k) {
  Movement m = from_rest(k, 5, 0.1, 0.5);
  for (int i = 0; i < 7; ++i) {
    Figure f = standing();
    set_arm(f, 1, 1.75, 0.15, -1.35, i % 2 == 0 ? 1.2 : 0.65);
    f.spine() = Vec3(0, 0.06, 0.1);
    f.pelvis().x() = 0.02 * k.leg;
    m.keys.push_back({1.3 + 0.32 * i, f});
  }
  return to_rest(m, 4.3);
}

// Down on a deep knee bend with the hands to the floor beside the foot, as to lift something.
Movement pick_up(const Skeleton& k) {
  Movement m = from_rest(k, 6, 0.25, 0.5);
  Figure down = standing();
  down.pelvis() = Vec3(0, -0.45 * k.leg, -0.16 * k.leg);
  down.lean() = 0.75;
  down.spine() = Vec3(0.7, 0, -0.2);
  down.head() = Vec3(-0.35, 0, 0);
  set_arms(down, 0.1, 1.4, 0.1, 0.2);
  for (const int side : {0, 1}) down.knee_out(side) = 0.3;
  Figure held = standing();
  reach_both(held, k, Vec3(0.32, -0.45, 0.6), Vec3(0.7, -1, -0.3));
  hold(m, 1.9, 2.4, down);
  hold(m, 3.7, 4.3, held);
  return to_rest(m, 5.4);
}

}  // namespace

std::vector<NamedMovement> everyday_movements() {
  return {{"idle", idle}, {"sit_down", sit_down}, {"reach_across", reach_across}, {"bow", bow}, {"stretch", stretch},
          {"wave", wave}, {"pick_up", pick_up}};
}

}  // namespace selvedge
