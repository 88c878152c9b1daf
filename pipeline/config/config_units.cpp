#include "pipeline/config/config_units.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "physics/scene/scene_numbers.hpp"

namespace selvedge {
namespace {

struct Symbol {
  std::string_view text;
  Unit unit;
  double factor;
};

// The first symbol of a dimension is its SI unit.
constexpr std::array symbols = {
    Symbol{"m", Unit::length, 1},
    Symbol{"dm", Unit::length, 0.1},
    Symbol{"cm", Unit::length, 0.01},
    Symbol{"mm", Unit::length, 0.001},
    Symbol{"in", Unit::length, 0.0254},
    Symbol{"m3", Unit::volume, 1},
    Symbol{"l", Unit::volume, 1e-3},
    Symbol{"cm3", Unit::volume, 1e-6},
    Symbol{"rad", Unit::angle, 1},
    Symbol{"deg", Unit::angle, 3.14159265358979323846 / 180},
    Symbol{"s", Unit::time, 1},
    Symbol{"ms", Unit::time, 0.001},
    Symbol{"1/s", Unit::rate, 1},
    Symbol{"Hz", Unit::rate, 1},
    Symbol{"m/s", Unit::speed, 1},
    Symbol{"cm/s", Unit::speed, 0.01},
    Symbol{"mm/s", Unit::speed, 0.001},
    Symbol{"km/h", Unit::speed, 1 / 3.6},
    Symbol{"m/s2", Unit::acceleration, 1},
    Symbol{"cm/s2", Unit::acceleration, 0.01},
    Symbol{"kg/m2", Unit::areal_density, 1},
    Symbol{"g/m2", Unit::areal_density, 0.001},
    Symbol{"kg/m3", Unit::density, 1},
    Symbol{"g/cm3", Unit::density, 1000},
    Symbol{"N/m", Unit::stiffness, 1},
    Symbol{"kN/m", Unit::stiffness, 1000},
    Symbol{"mN/m", Unit::stiffness, 0.001},
    Symbol{"Nm", Unit::bending, 1},
    Symbol{"mNm", Unit::bending, 1e-3},
    Symbol{"uNm", Unit::bending, 1e-6},
    Symbol{"Pa", Unit::pressure, 1},
    Symbol{"kPa", Unit::pressure, 1e3},
    Symbol{"MPa", Unit::pressure, 1e6},
    Symbol{"GPa", Unit::pressure, 1e9},
};

// Beyond what any scene can mean, and far from where doubles lose what matters [SI].
double largest_sensible(Unit unit) {
  switch (unit) {
    case Unit::length:
    case Unit::speed:
    case Unit::acceleration:
      return limits::farthest;
    case Unit::angle:
      return 1e7;
    case Unit::time:
    case Unit::rate:
      return limits::longest;
    case Unit::areal_density:
      return limits::heaviest;
    case Unit::density:
    case Unit::volume:
      return 1e12;
    case Unit::stiffness:
    case Unit::bending:
    case Unit::pressure:
      return limits::stiffest;
    case Unit::none:
      break;
  }
  return HUGE_VAL;
}

// "N m", "kg/m^2", "kg/m²", "µN m" (with either letter) and "90°" are written as in the table.
std::string plain_symbol(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> spellings = {
      {{"\xC2\xB2", "2"}, {"\xC2\xB3", "3"}, {"\xC2\xB5", "u"}, {"\xCE\xBC", "u"}, {"\xC2\xB0", "deg"}}};
  std::string plain;
  while (!text.empty()) {
    const auto spelling = std::ranges::find_if(spellings, [&](const auto& one) { return text.starts_with(one.first); });
    if (spelling != spellings.end())
      plain += spelling->second;
    else if (text[0] != ' ' && text[0] != '^' && text[0] != '*')
      plain += text[0];
    text.remove_prefix(spelling != spellings.end() ? spelling->first.size() : 1);
  }
  return plain;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

// A number at the start of the text; the rest is left in `text`.
std::optional<double> leading_number(std::string_view& text) {
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (problem == std::errc::invalid_argument) return std::nullopt;
  const std::string_view number = digits.substr(0, static_cast<std::size_t>(end - digits.data()));
  if (problem == std::errc::result_out_of_range)  // too small is zero, too large is infinite
    value = number.find("e-") != std::string_view::npos || number.find("E-") != std::string_view::npos ? 0 : HUGE_VAL;
  text = digits.substr(number.size());
  return value;
}

}  // namespace

std::string unit_symbol(Unit unit) {
  for (const Symbol& s : symbols)
    if (s.unit == unit) return std::string(s.text == "Nm" ? "N m" : s.text);
  return {};
}

std::string unit_symbols(Unit unit) {
  std::string list;
  for (const Symbol& s : symbols)
    if (s.unit == unit) list += (list.empty() ? "" : ", ") + std::string(s.text);
  return list;
}

std::optional<double> read_number(std::string_view text) {
  text = trimmed(text);
  if (text == ".nan" || text == ".NaN" || text == ".NAN") return std::nan("");
  if (text == ".inf" || text == "+.inf" || text == ".Inf") return HUGE_VAL;
  if (text == "-.inf" || text == "-.Inf") return -HUGE_VAL;
  const std::optional<double> value = leading_number(text);
  return text.empty() ? value : std::nullopt;
}

Quantity read_quantity(std::string_view text, Unit unit) {
  std::string_view rest = trimmed(text);
  std::optional<double> value = read_number(rest);
  double factor = 1;
  if (!value) {
    value = leading_number(rest);
    if (!value) return {0, "is not a number"};
    const std::string symbol = plain_symbol(rest);
    const Symbol* known = nullptr;
    for (const Symbol& s : symbols)
      if (s.text == symbol) known = &s;
    if (!known) return {0, "has the unknown unit `" + std::string(trimmed(rest)) + "`"};
    if (known->unit != unit)
      return {0, unit == Unit::none ? "has a unit, but is a plain number"
                                    : "has the unit " + symbol + ", which is not one of " + unit_symbols(unit)};
    factor = known->factor;
  }
  if (!std::isfinite(*value)) return {0, "is not finite"};
  if (std::abs(*value * factor) > largest_sensible(unit))
    return {0, fmt::format("is absurd, beyond {:g} {}", largest_sensible(unit), unit_symbol(unit))};
  return {*value * factor, {}};
}

double metres_per_unit(const std::string& unit) {
  const Quantity quantity = read_quantity("1 " + unit, Unit::length);
  if (!quantity.problem.empty())
    throw Error("unknown unit `" + unit + "`", "--unit", "known: " + unit_symbols(Unit::length));
  return quantity.value;
}

}  // namespace selvedge
