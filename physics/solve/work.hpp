#pragma once

#include "collision/contact/path_pairs.hpp"
#include "physics/energies/measures.hpp"
#include "physics/scene/stepper.hpp"
#include "physics/solve/assembly.hpp"

namespace selvedge {

// Bounds of the work that the world and the response to contact did on a cloth in a step [J].
struct Work {
  double pins = 0, obstacles = 0, wind = 0, response = 0;
  double total() const { return pins + obstacles + wind + response; }
  Work& operator+=(const Work&);
};

// Bounds the work of a step from its two ends alone, whichever stepper made it. The unnamed force on a vertex is R = m
// dv/dt - elastic - gravity - wind - damping, with the larger of the elastic forces at both ends.
//   pins       |R| times the displacement of the pin
//   obstacles  |R| times the displacement of the obstacle, at vertices that may have touched it
//   wind       the force of the air times the displacement of the vertex
//   response   |R| times how far a vertex was pressed closer than the rest gap at the start, which pushing apart may
//              give back; and |R| times its displacement where it started tangled
// If the energy of a cloth grows by more, the gain has no source. Holds caches and a reference to the scene.
class WorkBound {
 public:
  explicit WorkBound(const Scene&);
  Work operator()(const State& from, const State& to, const Drive&);

 private:
  void unnamed_forces(const State& from, const State& to, const Drive&);

  const Scene& scene_;
  ContactWorld world_;
  PairSearch search_;
  Elastic elastic_;
  Eigen::VectorXd masses_;
  Eigen::VectorXd unnamed_;  // |R| of every vertex [N]
  Points wind_;              // [N]
  AssemblyScratch scratch_;
};

}  // namespace selvedge
