#pragma once

#include <functional>
#include <vector>

#include "physics/solve/step_potential.hpp"
#include "physics/steppers/contact_stage.hpp"

namespace selvedge {

// What a proposed step may do. On training scenes no conventional step exceeds a third of the bounds of the residual,
// and noise of 3 mm exceeds others before (tests/pipeline/run/long_guard_tables.cpp prints both;
// docs/results/hybrid.md).
struct GuardOptions {
  double acceleration = 300;       // of a vertex in the step, at most [m/s2]
  double mean_acceleration = 6;    // RMS of all vertices [m/s2]; or
  double change_of_motion = 0.8;   // RMS change of the motion over the motion itself, whichever allows more
  double stretch = 1.3;            // largest of a triangle; or
  double stretch_growth = 1.1;     // over the largest at the start, whichever allows more
  double energy_growth = 10;       // of the elastic energy, in the cloth's weight times its mean edge
  double patch_acceleration = 60;  // RMS of the unexplained force on patches, over their mass [m/s2]
  double unexplained = 0.8;        // the same over the mean acceleration, where the motion changes by more than allowed
  double imbalance = 1e-3;         // RMS of how far a Jacobi sweep of the step's potential would move vertices [m]
  double decrement = 5;            // energy that it would gain, in the same unit as energy_growth
  int patch_size = 20;             // vertices, about
  double still = 1e-4;             // RMS motion in a step that counts as none [m]
  double slight = 1;               // mean acceleration that nothing has to explain [m/s2]
};

// What the guard looks at, in the order of its cost.
struct GuardMeasures {
  double acceleration = 0, mean_acceleration = 0;  // [m/s2]
  double change_of_motion = 0;
  double stretch = 1, stretch_before = 1;
  double energy_growth = 0;
  double patch_acceleration = 0;  // [m/s2]
  double imbalance = 0;           // [m]
  double decrement = 0;
  double in_contact = 0;  // share of the free vertices: those are left out of the last three
};

// Judges proposed steps. Caches, and references to the scene.
struct Guard {
  Guard(const Scene&, const GuardOptions&);
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  const Scene& scene;
  GuardOptions options;
  Eigen::VectorXd masses;
  Elastic elastic;
  std::vector<char> free;
  double unit_energy = 0;         // weight times mean edge [J]
  std::vector<double> stiffness;  // of each vertex at rest [N/m]
  std::vector<int> patch;         // of each vertex: forces inside of a patch cancel in its sum
  StepPotential step;
  StepScratch scratch;
};

// Which vertices touch something, asked only of proposals that pass all that is cheaper: one mark a vertex, or none.
using AskTouching = std::function<std::vector<char>()>;

// Whether the cloth may go from the state to x [m] in dt [s]: `admitted` or the first reason against it, the cheapest
// tests first. Looks at numbers, motion, stretch, elastic energy, and at the residual of the incremental potential of
// one implicit Euler step. Forces of contact are not known: vertices that touch something are left out of the residual.
// What was measured before the verdict is in `measures`.
Verdict judge(Guard&, const State& from, const Drive&, double dt, const Points& x, const AskTouching&,
              GuardMeasures& measures);

// The first two tests alone: for callers that process a proposal before it is judged.
Verdict judge_motion(const Guard&, const State& from, double dt, const Points& x, GuardMeasures& measures);

// All measures, whatever the bounds say. x must be finite.
GuardMeasures measure(Guard&, const State& from, const Drive&, double dt, const Points& x, const AskTouching&);

// Marks the cloth's vertices that are within twice the contact thickness of anything, in the state or at x.
std::vector<char> touching_vertices(ContactStage&, const State& from, const std::vector<Points>& obstacles,
                                    const Points& x);

// Whether a step that was made is free of what contact has to prevent: nothing passed through, crosses, or is inside a
// body.
bool is_contact_free(const State& to, const StepReport&);

}  // namespace selvedge
