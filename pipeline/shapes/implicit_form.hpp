#pragma once

#include <functional>
#include <variant>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// A cross-section of a loft: its place on the axis, and its extents in the two other coordinates [m].
struct LoftSection {
  double at, u_low, u_high, v_low, v_high;
};

// Elliptical sections along coordinate `axis`, u and v the coordinates that follow it cyclically, joined by monotone
// cubics (Fritsch and Carlson 1980), with half ellipsoids on both ends.
struct Loft {
  int axis = 1;
  double cap_low = 0, cap_high = 0;   // lengths of the ends [m]
  double exponent = 2;                // of the sections: 2 an ellipse, more is boxier
  std::vector<LoftSection> sections;  // by ascending `at`, at least two
  std::vector<LoftSection> slopes;    // filled by make_loft
};
Loft make_loft(int axis, double cap_low, double cap_high, double exponent, std::vector<LoftSection> sections);

struct Ellipsoid {
  Vec3 centre, radii;
  Mat3 axes = Mat3::Identity();  // columns: the directions of the radii
};

// Spheres of changing radius along a segment.
struct Cone {
  Vec3 from, to;
  double from_radius, to_radius;
};

using Solid = std::variant<Loft, Ellipsoid, Cone>;

struct Part {
  Solid solid;
  double blend = 0;                 // width over which it merges with earlier parts [m]
  bool paired = false;              // with its mirror image at x = 0
  bool cut = false;                 // subtracted instead of added
  Eigen::AlignedBox3d bounds = {};  // filled by make_form
};

// Parts merged one after the other; then limbs merged one after the other.
struct Limb {
  std::vector<Part> parts;
  double blend = 0;
  bool paired = false;
};
struct Form {
  std::vector<Limb> limbs;
};
Form make_form(std::vector<Limb>);

// Approximate signed distance to the form's surface [m], negative inside; continuously differentiable near it.
double signed_value(const Form&, const Vec3& p);

// Moves p onto the zero level, along gradients of a function that is approximately a distance.
Vec3 projected(const std::function<double(const Vec3&)>& value, const Vec3& p);
Vec3 projected(const Form&, const Vec3& p);

// The smaller of two values, rounded where they differ by less than `blend`: the union of two solids.
double merged(double a, double b, double blend);

}  // namespace selvedge
