#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace selvedge {

enum class Unit {
  none,
  length,
  volume,
  angle,
  time,
  rate,
  speed,
  acceleration,
  areal_density,
  density,
  stiffness,
  bending,
  pressure,
};

// SI symbol, empty for Unit::none.
std::string unit_symbol(Unit);
// All symbols of a dimension, "m, dm, cm, mm".
std::string unit_symbols(Unit);

struct Quantity {
  double value = 0;     // SI
  std::string problem;  // empty: read
};

// "0.002", "2 mm", "150 g/m2": a plain number is SI; a unit of another dimension, NaN and infinity are problems.
Quantity read_quantity(std::string_view text, Unit);

// Metres in the unit of length that an option names. Throws Error for one that is not known.
double metres_per_unit(const std::string& unit);

// The whole text as a finite or infinite number, nothing otherwise. Knows no locale.
std::optional<double> read_number(std::string_view text);

}  // namespace selvedge
