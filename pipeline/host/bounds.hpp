#pragma once

#include <cstdint>
#include <string>

#include "physics/scene/scene_numbers.hpp"

namespace selvedge {

// What a scene and its files may ask for. It is judged before memory is taken: a few bytes of a file can ask for more
// than any machine has. A vertex of cloth takes some 8 kB in a run.
inline constexpr std::int64_t most_vertices = 4'000'000;             // of all cloths together, and of an obstacle
inline constexpr std::int64_t most_parts = 10'000;                   // cloths of a scene
inline constexpr std::int64_t most_numbers = std::int64_t{1} << 28;  // of one array in a file
inline constexpr std::int64_t most_file_bytes = std::int64_t{1} << 31;

// What numbers may be. Beyond these nothing is meant that a scene could show, and doubles lose what matters.
inline constexpr double farthest_coordinate = 1e9;          // of a mesh file, in the unit of the file
inline constexpr double largest_length = limits::farthest;  // from the origin, and the largest length [m]
inline constexpr double largest_turn = 1e6;                 // of a joint in a clip [rad]
inline constexpr double longest_lead = 3600;      // in which a body comes into its clip or a garment falls [s]
inline constexpr double most_start_stretch = 10;  // by which a start draws a cloth out

// Throws Error with the count and the bound where `count` is above `most`, or is not a number. `noun` is what is
// counted: "vertices".
void refuse_too_many(double count, std::int64_t most, const std::string& noun, const std::string& where,
                     const std::string& cure);

}  // namespace selvedge
