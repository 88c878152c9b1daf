#pragma once

#include <span>
#include <string>

#include "physics/scene/scene.hpp"

namespace selvedge {

struct State;

// Bounds of the numbers of a scene, from a scene file, Python or C++. Numbers beyond them make no sensible scene, and
// doubles lose precision.
namespace limits {
inline constexpr double farthest = 1e6;   // distance from the origin, and largest length [m]
inline constexpr double thickest = 100;   // contact thickness [m]: scenes may be kilometres wide
inline constexpr double longest = 1e9;    // time [s]
inline constexpr double heaviest = 1e9;   // mass per area [kg/m2]
inline constexpr double stiffest = 1e18;  // [N/m], [N m], [Pa]
}  // namespace limits

// Elastic constants that replace the Lame coefficients (plane stress).
struct Elasticity {
  double youngs_modulus = 0;  // times thickness [N/m]
  double poisson = 0;
};

// A number of a struct and its allowed range.
template <class Struct>
struct NumberField {
  const char* name;
  double Struct::*member;
  double low, high;
  bool low_in = true, high_in = true;  // whether the end itself is allowed
  bool has(double value) const {       // never NaN
    return (low_in ? value >= low : value > low) && (high_in ? value <= high : value < high);
  }
};

// Every number of Material, Elasticity, ContactSettings, Wind or Spring.
template <class Struct>
std::span<const NumberField<Struct>> number_fields();

// Both throw Error, with `where`, the field, its value and the allowed range.
[[noreturn]] void refuse_number(const std::string& field, double value, double low, double high, bool low_in,
                                bool high_in, const std::string& where);

template <class Struct>
void check_numbers(const Struct& all, const std::string& where) {
  for (const NumberField<Struct>& field : number_fields<Struct>())
    if (const double value = all.*field.member; !field.has(value))
      refuse_number(field.name, value, field.low, field.high, field.low_in, field.high_in, where);
}

// A time step [s]: above 0, up to limits::longest.
bool is_time_step(double dt);
void check_time_step(double dt, const std::string& where);

// Throws Error unless all positions [m] (or velocities [m/s]) are finite and within limits::farthest.
void check_positions(const Points&, const std::string& where, const std::string& unit = "m");

// Sets the Lame coefficients of the material. Throws Error for numbers out of range.
void set_elasticity(const Elasticity&, const std::string& where, Material&);

// Checks numbers of materials, contact, wind and springs, rest positions, and indices of pins and springs.
void check_scene(const Scene&);

// Checks that positions and velocities match the scene in number and are in range.
void check_state(const Scene&, const State&);

}  // namespace selvedge
