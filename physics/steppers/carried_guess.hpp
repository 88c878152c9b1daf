#pragma once

#include <array>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// What the carried guess is a sum of: displacements in a frame, each times a coefficient. A body's pose gives the
// skinned target; all is relative to that, so that no force and no pair is asked for.
enum class CarriedTerm {
  target,         // of the skinned target in this frame
  motion,         // last motion relative to the target
  target_before,  // of the skinned target in the last frame
  motion_before,  // relative motion in the frame before the last
  offset,         // from the skinned target to the vertex, where the frame begins
  turn,           // of that offset, if it turns as the skinned target does in this frame
  smoothing,      // of that offset toward the mean of the neighbours' offsets
  gravity         // in a frame, from rest
};
constexpr int carried_term_count = 8;
using CarriedSet = Eigen::Matrix<double, carried_term_count, 1>;  // coefficients by CarriedTerm
const std::array<const char*, carried_term_count>& carried_term_names();

// Along with the target, and on by 0.6 of the last motion relative to it.
CarriedSet default_carried_set();

struct CarriedModel {
  CarriedSet scene = default_carried_set();
  // A set for each vertex, in place of the scene's; no rows: there are none.
  Eigen::Matrix<double, Eigen::Dynamic, carried_term_count, Eigen::RowMajor> own = {};
};

// The terms of a frame. Rows of vertices that nothing wears are 0.
struct CarriedTerms {
  std::vector<char> worn;                       // of each vertex
  bool known = false;                           // memory has what the wanted terms are made of
  std::array<Points, carried_term_count> rows;  // n x 3 [m]; no rows: not wanted, or not known
};
using WantedTerms = std::array<bool, carried_term_count>;
constexpr WantedTerms all_carried_terms{true, true, true, true, true, true, true, true};
CarriedTerms carried_terms(const Scene&, const State& from, const Drive&, double dt, const WantedTerms&);

// Where cloth that a body wears goes without any forces. Where memory lacks a frame that the model's terms ask for, the
// default set takes its place. Cloth that nothing wears falls freely. Pins are where the drive has them. n x 3 [m].
Points carried_guess(const Scene&, const State& from, const Drive&, double dt, const CarriedModel& = {});

// Number of frames before `from` whose motion the model's terms are made of.
int past_frames(const CarriedModel&);

// What the next carried guess reads: the targets of this frame, the motion relative to them, and with 2 past frames the
// same of the frame before. x: the cloth at the end of the step.
std::vector<MemoryBlock> carried_memory(const State& from, const Drive&, const Points& x, int past_frames = 1);

// The targets that carried_memory left in the state; null: none.
const MemoryRows* carried_targets(const State&);

}  // namespace selvedge
