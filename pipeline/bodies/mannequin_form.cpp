#include "pipeline/bodies/mannequin_form.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace selvedge {
namespace {

// Sections across Y that are symmetric in X: height, back, front, half width.
std::vector<LoftSection> upright(const std::vector<std::array<double, 4>>& table) {
  std::vector<LoftSection> sections;
  for (const auto& [y, back, front, half_width] : table) sections.push_back({y, back, front, -half_width, half_width});
  return sections;
}

Mat3 turned(double about_x, double about_y, double about_z) {  // [degrees]
  const double degree = std::acos(-1.0) / 180;
  return (Eigen::AngleAxisd(about_z * degree, Vec3::UnitZ()) * Eigen::AngleAxisd(about_y * degree, Vec3::UnitY()) *
          Eigen::AngleAxisd(about_x * degree, Vec3::UnitX()))
      .toRotationMatrix();
}

Limb torso() {
  Limb limb;
  limb.parts = {
      {make_loft(1, 0.02, 0.02, 2.2,
                 upright({{0.79, -0.040, 0.030, 0.045},
                          {0.82, -0.066, 0.056, 0.115},
                          {0.85, -0.082, 0.074, 0.155},
                          {0.89, -0.092, 0.088, 0.171},
                          {0.93, -0.092, 0.095, 0.168},
                          {0.98, -0.082, 0.100, 0.157},
                          {1.03, -0.070, 0.100, 0.143},
                          {1.08, -0.066, 0.097, 0.134},
                          {1.13, -0.072, 0.097, 0.135},
                          {1.19, -0.085, 0.100, 0.143},
                          {1.25, -0.098, 0.105, 0.152},
                          {1.31, -0.106, 0.098, 0.155},
                          {1.36, -0.106, 0.078, 0.148},
                          {1.40, -0.098, 0.050, 0.120},
                          {1.43, -0.085, 0.020, 0.085},
                          {1.455, -0.070, 0.0, 0.055}})),
       0, false, false},
      // Between the legs, buttocks, belly, breasts, the edge of the chest towards the arms, shoulder blades, flanks,
      // trapezius.
      {Ellipsoid{{0, 0.815, -0.015}, {0.050, 0.048, 0.075}, turned(0, 0, 0)}, 0.04, false, false},
      {Ellipsoid{{0.074, 0.868, -0.067}, {0.080, 0.088, 0.068}, turned(0, 0, 0)}, 0.045, true, false},
      {Ellipsoid{{0.0, 1.00, 0.055}, {0.095, 0.09, 0.050}, turned(0, 0, 0)}, 0.05, false, false},
      {Ellipsoid{{0.075, 1.262, 0.062}, {0.070, 0.064, 0.056}, turned(0, 15, 0)}, 0.04, true, false},
      {Ellipsoid{{0.105, 1.325, 0.030}, {0.085, 0.045, 0.038}, turned(0, 20, 15)}, 0.05, true, false},
      {Ellipsoid{{0.088, 1.320, -0.076}, {0.050, 0.072, 0.034}, turned(0, -12, 8)}, 0.04, true, false},
      {Ellipsoid{{0.104, 1.23, -0.042}, {0.042, 0.18, 0.050}, turned(0, 0, -4)}, 0.08, true, false},
      {Cone{{0.03, 1.455, -0.058}, {0.150, 1.405, -0.035}, 0.024, 0.042}, 0.05, true, false},
  };
  return limb;
}

Limb head() {
  Limb limb;
  limb.blend = 0.03;
  limb.parts = {
      {make_loft(1, 0.02, 0.02, 2,
                 upright({{1.40, -0.085, 0.020, 0.064},
                          {1.44, -0.080, 0.020, 0.058},
                          {1.48, -0.072, 0.028, 0.054},
                          {1.52, -0.066, 0.036, 0.053},
                          {1.56, -0.062, 0.042, 0.054}})),
       0, false, false},
      {Ellipsoid{{0, 1.632, -0.004}, {0.076, 0.090, 0.098}, turned(0, 0, 0)}, 0.03, false, false},
      {make_loft(1, 0.015, 0.03, 2.3,
                 upright({{1.515, 0.040, 0.086, 0.030},
                          {1.535, 0.010, 0.092, 0.049},
                          {1.565, -0.020, 0.094, 0.060},
                          {1.60, -0.040, 0.095, 0.063},
                          {1.64, -0.050, 0.093, 0.066},
                          {1.67, -0.040, 0.080, 0.062}})),
       0.025, false, false},
      // Chin, mouth, nose, ears; eye sockets.
      {Ellipsoid{{0, 1.522, 0.074}, {0.030, 0.020, 0.021}, turned(0, 0, 0)}, 0.015, false, false},
      {Ellipsoid{{0, 1.555, 0.083}, {0.030, 0.022, 0.013}, turned(0, 0, 0)}, 0.03, false, false},
      {Cone{{0, 1.628, 0.090}, {0, 1.591, 0.107}, 0.007, 0.0105}, 0.02, false, false},
      {Cone{{0, 1.590, 0.101}, {0, 1.562, 0.086}, 0.0105, 0.012}, 0.02, false, false},
      {Ellipsoid{{0.074, 1.607, -0.004}, {0.007, 0.028, 0.017}, turned(0, 20, 0)}, 0.008, true, false},
      {Ellipsoid{{0.033, 1.622, 0.112}, {0.024, 0.013, 0.022}, turned(0, 0, 0)}, 0.02, true, true},
  };
  return limb;
}

Limb arm() {
  Limb limb;
  limb.blend = 0.045;
  limb.parts = {
      {make_loft(0, 0.03, 0.03, 2,
                 {{0.13, 1.318, 1.430, -0.080, 0.040},
                  {0.17, 1.318, 1.436, -0.082, 0.040},
                  {0.205, 1.326, 1.438, -0.076, 0.037},
                  {0.24, 1.332, 1.434, -0.068, 0.032},
                  {0.29, 1.334, 1.427, -0.063, 0.030},
                  {0.35, 1.339, 1.423, -0.060, 0.026},
                  {0.41, 1.347, 1.420, -0.056, 0.021},
                  {0.45, 1.350, 1.420, -0.056, 0.018},
                  {0.49, 1.348, 1.424, -0.058, 0.020},
                  {0.54, 1.351, 1.422, -0.055, 0.020},
                  {0.60, 1.359, 1.416, -0.048, 0.014},
                  {0.66, 1.365, 1.410, -0.045, 0.011},
                  {0.70, 1.367, 1.406, -0.047, 0.012}}),
       0, false, false},
      {Ellipsoid{{0.188, 1.393, -0.021}, {0.064, 0.050, 0.056}, turned(0, 0, -8)}, 0.04, false, false},
      {make_loft(0, 0.02, 0.022, 2.2,
                 {{0.70, 1.369, 1.404, -0.044, 0.010},
                  {0.73, 1.366, 1.405, -0.054, 0.020},
                  {0.77, 1.367, 1.402, -0.060, 0.025},
                  {0.80, 1.368, 1.399, -0.060, 0.024},
                  {0.83, 1.366, 1.395, -0.057, 0.020},
                  {0.855, 1.364, 1.391, -0.050, 0.012},
                  {0.87, 1.362, 1.388, -0.044, 0.004}}),
       0.02, false, false},
      {Cone{{0.715, 1.384, 0.004}, {0.758, 1.374, 0.040}, 0.018, 0.0145}, 0.02, false, false},
      {Cone{{0.758, 1.374, 0.040}, {0.802, 1.366, 0.058}, 0.0145, 0.0115}, 0.008, false, false},
  };
  return limb;
}

Limb leg() {
  Limb limb;
  limb.blend = 0.05;
  limb.paired = true;
  limb.parts = {
      {make_loft(1, 0.03, 0.03, 2.1,
                 {{0.07, -0.056, 0.024, 0.105, 0.165},
                  {0.12, -0.053, 0.014, 0.106, 0.162},
                  {0.18, -0.058, 0.016, 0.100, 0.163},
                  {0.25, -0.070, 0.024, 0.088, 0.171},
                  {0.31, -0.080, 0.031, 0.077, 0.177},
                  {0.36, -0.081, 0.037, 0.072, 0.178},
                  {0.42, -0.068, 0.046, 0.071, 0.170},
                  {0.46, -0.058, 0.053, 0.071, 0.165},
                  {0.50, -0.057, 0.058, 0.069, 0.167},
                  {0.55, -0.063, 0.066, 0.061, 0.171},
                  {0.62, -0.072, 0.076, 0.050, 0.177},
                  {0.70, -0.081, 0.083, 0.036, 0.182},
                  {0.76, -0.086, 0.084, 0.026, 0.184},
                  {0.81, -0.086, 0.080, 0.023, 0.181},
                  {0.86, -0.076, 0.068, 0.030, 0.164},
                  {0.90, -0.060, 0.052, 0.045, 0.138}}),
       0, false, false},
      {Ellipsoid{{0.118, 0.485, 0.045}, {0.030, 0.042, 0.022}, turned(0, 0, 0)}, 0.03, false, false},
      {make_loft(2, 0.013, 0.014, 2.4,
                 {{-0.062, 0.110, 0.156, 0.004, 0.050},
                  {-0.045, 0.104, 0.161, -0.002, 0.075},
                  {-0.010, 0.101, 0.165, -0.004, 0.095},
                  {0.030, 0.101, 0.171, -0.004, 0.084},
                  {0.065, 0.100, 0.180, -0.004, 0.062},
                  {0.100, 0.100, 0.190, -0.004, 0.045},
                  {0.130, 0.104, 0.191, -0.004, 0.035},
                  {0.150, 0.111, 0.185, -0.003, 0.028},
                  {0.165, 0.120, 0.175, -0.001, 0.023}}),
       0.025, false, false},
      // The floor: a huge ball below it.
      {Ellipsoid{{0.13, -100, 0.05}, {100, 100, 100}, turned(0, 0, 0)}, 0.01, false, true},
  };
  return limb;
}

}  // namespace

std::vector<MannequinJoint> mannequin_joints() {
  return {{"pelvis", -1, {0, 0.94, 0}},
          {"left_hip", 0, {0.092, 0.872, 0}},
          {"right_hip", 0, {-0.092, 0.872, 0}},
          {"spine1", 0, {0, 1.04, -0.010}},
          {"left_knee", 1, {0.118, 0.475, 0}},
          {"right_knee", 2, {-0.118, 0.475, 0}},
          {"spine2", 3, {0, 1.165, -0.016}},
          {"left_ankle", 4, {0.134, 0.085, -0.020}},
          {"right_ankle", 5, {-0.134, 0.085, -0.020}},
          {"spine3", 6, {0, 1.22, -0.014}},
          {"left_foot", 7, {0.145, 0.028, 0.095}},
          {"right_foot", 8, {-0.145, 0.028, 0.095}},
          {"neck", 9, {0, 1.43, -0.034}},
          {"left_collar", 9, {0.075, 1.365, -0.025}},
          {"right_collar", 9, {-0.075, 1.365, -0.025}},
          {"head", 12, {0, 1.515, -0.004}},
          {"left_shoulder", 13, {0.180, 1.382, -0.021}},
          {"right_shoulder", 14, {-0.180, 1.382, -0.021}},
          {"left_elbow", 16, {0.450, 1.385, -0.019}},
          {"right_elbow", 17, {-0.450, 1.385, -0.019}},
          {"left_wrist", 18, {0.700, 1.386, -0.017}},
          {"right_wrist", 19, {-0.700, 1.386, -0.017}},
          {"left_hand", 20, {0.785, 1.384, -0.018}},
          {"right_hand", 21, {-0.785, 1.384, -0.018}}};
}

Form mannequin_form(const std::vector<MannequinLimb>& which, std::vector<Limb> others) {
  std::vector<Limb> limbs;
  constexpr std::array make{torso, head, arm, leg};  // in the order of MannequinLimb
  for (const MannequinLimb limb : which) limbs.push_back(make[static_cast<std::size_t>(limb)]());
  std::move(others.begin(), others.end(), std::back_inserter(limbs));
  return make_form(std::move(limbs));
}

double mannequin_edge(const Vec3& p) {
  const auto ramp = [](double value, double from, double to) {
    return std::clamp((value - from) / (to - from), 0.0, 1.0);
  };
  const double head = ramp(p.y(), 1.46, 1.52) * (1 - 0.3 * ramp(-p.z(), -0.06, 0.0));
  const double hand = ramp(std::abs(p.x()), 0.62, 0.72), foot = 1 - ramp(p.y(), 0.08, 0.20);
  return 0.0188 - std::max({0.0065 * head, 0.0085 * hand, 0.006 * foot});
}

}  // namespace selvedge
