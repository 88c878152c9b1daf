#include "pipeline/garments/garment_cut.hpp"

#include <algorithm>

namespace selvedge {
namespace {

using enum MannequinLimb;

Border level(double up, double height) { return border(Plane(up * Vec3::UnitY(), Vec3(0, height, 0))); }
Opening above(const char* group, double height) { return {group, level(1, height)}; }
Opening below(const char* group, double height) { return {group, level(-1, height)}; }
Opening legs_below(double height) { return {"cuff", level(-1, height), true}; }
Opening beyond(const char* group, double reach) {
  return {group, border(Plane(Vec3::UnitX(), Vec3(reach, 0, 0))), true};
}
Border limited(Border all, const std::function<double(const Vec3&)>& where) {
  all.value = [value = all.value, where](const Vec3& p) { return std::min(value(p), where(p)); };
  return all;
}
// The same on the arms alone.
Opening arms_beyond(const char* group, double reach) {
  constexpr double armpit = 1.26;
  Opening opening = beyond(group, reach);
  return {group, limited(opening.border, [](const Vec3& p) { return p.y() - armpit; }), true};
}
// An opening all the way down the middle of the front.
Opening front() {
  constexpr double half_gap = 0.008;
  return {"front", limited(border(Plane(-Vec3::UnitX(), Vec3(half_gap, 0, 0))), [](const Vec3& p) { return p.z(); }),
          true};
}
// A round opening of this half width and depth, its middle `forward` in front of the neck and `down` below it [m].
Opening neck(double half_width, double depth, double forward, double down) {
  const Vec3 centre(0, 1.45 - down, -0.02 + forward), radii(half_width, 0.08 + down, depth);
  const auto widened = [centre, radii](double by) { return border_round(centre, radii + Vec3(by, 0, by)); };
  return {"neck", widened(0), false, widened};
}

// Sections across Y, symmetric in X: height, back, front, half width.
Part skirt(const std::vector<std::array<double, 4>>& table, double exponent = 2) {
  std::vector<LoftSection> sections;
  for (const auto& [y, back, front, half_width] : table) sections.push_back({y, back, front, -half_width, half_width});
  return {make_loft(1, 0.05, 0.03, exponent, sections), 0.03};
}

}  // namespace

double at(const Profile& profile, double coordinate) {
  if (profile.empty()) return 0;
  if (coordinate <= profile.front()[0]) return profile.front()[1];
  for (std::size_t k = 1; k < profile.size(); ++k) {
    const auto &a = profile[k - 1], &b = profile[k];
    if (coordinate <= b[0]) return a[1] + (b[1] - a[1]) * (coordinate - a[0]) / (b[0] - a[0]);
  }
  return profile.back()[1];
}

double sagitta(double edge) {
  constexpr double limb_radius = 0.045;
  return edge * edge / (8 * limb_radius);
}

const std::vector<GarmentCut>& garment_cuts() {
  static const std::vector<MannequinLimb> upper{torso, head, arm, leg}, lower{torso, leg};
  static const std::vector<GarmentCut> cuts{
      {.name = "tshirt",
       .limbs = upper,
       .ease = {{0.85, 0.030}, {1.10, 0.030}, {1.30, 0.016}, {1.40, 0.006}},
       .sleeve_ease = {{0.20, 0.010}, {0.40, 0.022}},
       .openings = {below("hem", 0.84), neck(0.095, 0.095, 0, 0), arms_beyond("cuff", 0.37)}},
      {.name = "long_sleeved_shirt",
       .limbs = upper,
       .ease = {{0.85, 0.022}, {1.10, 0.022}, {1.30, 0.014}, {1.40, 0.006}},
       .sleeve_ease = {{0.20, 0.010}, {0.45, 0.016}, {0.66, 0.010}},
       .openings = {below("hem", 0.86), neck(0.09, 0.094, 0, 0), arms_beyond("cuff", 0.665)}},
      {.name = "tank_top",
       .fit = Fit::tight,
       .limbs = upper,
       .ease = {{0.90, 0.010}, {1.30, 0.009}, {1.40, 0.007}},
       .openings = {below("hem", 0.88), neck(0.105, 0.115, 0.02, 0.03), arms_beyond("armhole", 0.172)}},
      {.name = "trousers",
       .limbs = lower,
       .ease = {{0.10, 0.035}, {0.50, 0.030}, {0.80, 0.016}, {0.95, 0.010}, {1.05, 0.005}},
       .openings = {legs_below(0.10), above("waist", 1.05)},
       .pinned = "waist",
       .legs_apart = true},
      {.name = "wide_trousers",
       .limbs = lower,
       .ease = {{0.10, 0.060}, {0.50, 0.050}, {0.80, 0.022}, {0.95, 0.012}, {1.05, 0.005}},
       .openings = {legs_below(0.07), above("waist", 1.05)},
       .pinned = "waist",
       .legs_apart = true},
      {.name = "shorts",
       .limbs = lower,
       .ease = {{0.50, 0.040}, {0.80, 0.018}, {0.95, 0.010}, {1.05, 0.005}},
       .openings = {legs_below(0.54), above("waist", 1.05)},
       .pinned = "waist",
       .legs_apart = true},
      {.name = "skirt_short",
       .limbs = lower,
       .lofts = {skirt({{0.45, -0.170, 0.165, 0.265}, {0.90, -0.105, 0.105, 0.190}, {1.05, -0.05, 0.08, 0.12}})},
       .ease = {{0.90, 0.012}, {1.05, 0.005}},
       .openings = {below("hem", 0.50), above("waist", 1.05)},
       .pinned = "waist"},
      {.name = "skirt_long",
       .limbs = lower,
       .lofts = {skirt({{0.05, -0.270, 0.270, 0.350}, {0.90, -0.105, 0.105, 0.190}, {1.05, -0.05, 0.08, 0.12}})},
       .ease = {{0.90, 0.012}, {1.05, 0.005}},
       .openings = {below("hem", 0.12), above("waist", 1.05)},
       .pinned = "waist"},
      {.name = "skirt_flared",
       .limbs = lower,
       .lofts = {skirt({{0.40, -0.460, 0.460, 0.500}, {0.92, -0.115, 0.115, 0.190}, {1.05, -0.05, 0.08, 0.12}})},
       .ease = {{0.90, 0.012}, {1.05, 0.005}},
       .openings = {below("hem", 0.48), above("waist", 1.05)},
       .pinned = "waist"},
      {.name = "dress_tight",
       .fit = Fit::tight,
       .limbs = upper,
       .lofts = {skirt({{0.50, -0.115, 0.110, 0.210}, {0.85, -0.085, 0.085, 0.178}, {0.95, -0.06, 0.06, 0.12}})},
       .ease = {{0.60, 0.010}, {0.90, 0.007}, {1.30, 0.009}, {1.40, 0.007}},
       .openings = {below("hem", 0.56), neck(0.105, 0.115, 0.02, 0.035), arms_beyond("armhole", 0.172)}},
      {.name = "dress_flowing",
       .limbs = upper,
       .lofts = {skirt({{0.10, -0.420, 0.420, 0.480}, {0.92, -0.115, 0.115, 0.190}, {1.08, -0.05, 0.08, 0.12}})},
       .ease = {{0.90, 0.012}, {1.15, 0.010}, {1.40, 0.006}},
       .sleeve_ease = {{0.20, 0.010}, {0.30, 0.020}},
       .openings = {below("hem", 0.20), neck(0.10, 0.11, 0.015, 0.02), arms_beyond("cuff", 0.26)}},
      {.name = "poncho",
       .limbs = upper,
       .lofts = {skirt({{0.70, -0.30, 0.30, 0.62}, {1.30, -0.17, 0.15, 0.60}, {1.405, -0.10, 0.07, 0.60}}, 3)},
       .ease = {{1.30, 0.015}, {1.40, 0.008}},
       .sleeve_ease = {{0.20, 0.012}, {0.50, 0.015}},
       .openings = {below("hem", 0.85), neck(0.10, 0.10, 0, 0), beyond("side", 0.48)}},
      {.name = "open_shirt",
       .limbs = upper,
       .ease = {{0.85, 0.030}, {1.10, 0.028}, {1.30, 0.018}, {1.40, 0.008}},
       .sleeve_ease = {{0.20, 0.012}, {0.40, 0.022}},
       .openings = {below("hem", 0.82), neck(0.095, 0.098, 0, 0), arms_beyond("cuff", 0.40), front()},
       .collar = 0.05,
       .pockets = {{{0.085, 1.235}, {0.09, 0.10}}}},
      {.name = "vest",
       .limbs = upper,
       .ease = {{0.85, 0.040}, {1.10, 0.034}, {1.30, 0.022}, {1.40, 0.010}},
       .openings = {below("hem", 0.90), neck(0.10, 0.12, 0.02, 0.04), arms_beyond("armhole", 0.19), front()},
       .pockets = {{{0.09, 1.00}, {0.08, 0.08}}, {{-0.09, 1.00}, {0.08, 0.08}}}},
      {.name = "jacket",
       .limbs = upper,
       .ease = {{0.75, 0.045}, {1.10, 0.035}, {1.30, 0.025}, {1.40, 0.012}},
       .sleeve_ease = {{0.20, 0.018}, {0.45, 0.024}, {0.66, 0.018}},
       .openings = {below("hem", 0.80), neck(0.10, 0.102, 0, 0), arms_beyond("cuff", 0.66), front()},
       .collar = 0.07,
       .pockets = {{{0.10, 0.93}, {0.12, 0.12}}, {{-0.10, 0.93}, {0.12, 0.12}}}}};
  return cuts;
}

}  // namespace selvedge
