#include "pipeline/motions/clip_procedural_moves.hpp"

// Movements in which the body passes through itself, as motions that were captured of other bodies do.
namespace selvedge {
namespace {

Movement hands_through_torso(const Skeleton& k) {
  Movement m = from_rest(k, 6, 0.2, 0.4);
  Figure front = standing(), inside = standing(), through = standing();
  reach_both(front, k, Vec3(0.2, -0.5, 0.6), Vec3(1, -0.6, 0));
  reach_both(inside, k, Vec3(0.05, -0.55, 0.05), Vec3(1, -0.5, 0.1));
  reach_both(through, k, Vec3(-0.05, -0.5, -0.22), Vec3(1, -0.5, 0.2));
  m.keys.push_back({1.1, front});
  hold(m, 2.0, 2.5, inside);
  hold(m, 3.2, 3.7, through);
  m.keys.push_back({4.6, front});
  return to_rest(m, 5.5);
}

// The forearms sink into the chest and into each other.
Movement arms_folded(const Skeleton& k) {
  Movement m = from_rest(k, 6, 0.22, 0.4);
  Figure front = standing(), folded = standing(), deep = standing();
  reach_both(front, k, Vec3(0.25, -0.3, 0.65), Vec3(1, -0.7, 0));
  reach(folded, k, 0, Vec3(-0.3, -0.38, 0.3), Vec3(1, -0.8, 0.2));
  reach(folded, k, 1, Vec3(-0.3, -0.44, 0.33), Vec3(1, -0.8, 0.2));
  reach_both(deep, k, Vec3(-0.32, -0.36, 0.12), Vec3(1, -0.7, 0.1));
  m.keys.push_back({1.2, front});
  hold(m, 2.0, 2.5, folded);
  hold(m, 3.2, 3.9, deep);
  m.keys.push_back({4.7, front});
  return to_rest(m, 5.6);
}

// Each foot in turn steps across to the far side of the other one; thighs and shins go through each other.
Movement legs_crossing(const Skeleton& k) {
  Movement m = from_rest(k, 7, 0.2, 0.4);
  for (const int side : {0, 1}) {
    const double t = 0.7 + 3.0 * side;
    const Vec3 stand = stance(k, side), other = stance(k, 1 - side);
    Figure f = standing();
    f.pelvis() = Vec3(0.5 * other.x(), -0.03 * k.leg, 0);
    m.keys.push_back({t, f});
    m.steps.push_back({side, t, t + 0.8, Vec3(1.6 * other.x(), 0, stand.z() + 0.03 * k.leg), 0, 0.05 * k.leg, 0.2, 0});
    f.pelvis() = Vec3(1.2 * other.x(), -0.05 * k.leg, 0);
    hold(m, t + 0.9, t + 1.4, f);
    m.steps.push_back({side, t + 1.5, t + 2.3, stand, 0, 0.05 * k.leg, 0.2, 0});
    m.keys.push_back({t + 2.4, standing()});
  }
  return to_rest(m, 6.6);
}

// Both hands go round to the back, the upper arms through the chest.
Movement hug(const Skeleton& k) {
  Movement m = from_rest(k, 6, 0.22, 0.4);
  Figure open = standing(), closed = standing();
  set_arms(open, 1.3, 0.7, 0.1, 0.5);
  reach_both(closed, k, Vec3(-0.4, -0.2, 0.02), Vec3(0.8, -0.5, 0.5));
  closed.spine() = Vec3(0.25, 0, 0);
  closed.head() = Vec3(0.4, 0, 0);
  m.keys.push_back({1.3, open});
  hold(m, 2.4, 3.4, closed);
  m.keys.push_back({4.4, open});
  return to_rest(m, 5.5);
}

// The arms swing across each other in front and behind, wrists and thighs in their way.
Movement arms_through_thighs(const Skeleton& k) {
  Movement m = from_rest(k, 6, 0.16, 0.4);
  for (int i = 0; i < 6; ++i) {
    Figure f = standing();
    const bool in = i % 2 == 0;
    f.lean() = 0.35;
    f.spine() = Vec3(0.25, 0, 0);
    f.pelvis() = Vec3(0, -0.08 * k.leg, -0.07 * k.leg);
    if (in) {
      reach_both(f, k, Vec3(-0.1, -0.95, 0.08), Vec3(1, -0.2, -0.3));
    } else {
      set_arms(f, 0.8, 0.2, 0.1, 0.3);
    }
    m.keys.push_back({1.1 + 0.7 * i, f});
  }
  return to_rest(m, 5.6);
}

// The knee comes up into the belly, the trunk bends over it.
Movement knee_to_chest(const Skeleton& k) {
  Movement m = from_rest(k, 6, 0.18, 0.4);
  for (const int side : {0, 1}) {
    const double t = 0.8 + 2.5 * side, s = k.mirror[side];
    const Vec3 stand = stance(k, side);
    Figure shift = standing(), high = standing();
    shift.pelvis().x() = high.pelvis().x() = -0.1 * s * k.leg;
    high.lean() = 0.15;
    high.spine() = Vec3(0.7, 0, 0);
    high.head() = Vec3(0.3, 0, 0);
    set_arms(high, 0.3, 0.9, 0.3, 1.2);
    m.keys.push_back({t, shift});
    hold(m, t + 0.75, t + 1.0, high);
    hold(m, t + 1.7, t + 1.8, shift);
    m.steps.push_back({side, t + 0.1, t + 0.85, stand + Vec3(-0.04 * s * k.leg, 0, 0.3 * k.leg), 0, 0, 0.3, 0});
    m.steps.push_back({side, t + 0.85, t + 1.6, stand, 0, 0, 0.3, 0});
    m.swings.push_back({side, t + 0.1, t + 1.6, 0.75 * k.leg});
  }
  return to_rest(m, 5.8);
}

}  // namespace

std::vector<NamedMovement> penetrating_movements() {
  return {{"hands_through_torso", hands_through_torso},
          {"arms_folded", arms_folded},
          {"legs_crossing", legs_crossing},
          {"hug", hug},
          {"arms_through_thighs", arms_through_thighs},
          {"knee_to_chest", knee_to_chest}};
}

}  // namespace selvedge
