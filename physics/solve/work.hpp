#pragma once

#include "collision/contact/path_pairs.hpp"
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
//   obstacles  |R| times the displacement of the obstacle, at vertices that touch it: within
//              contact_reach of the thickness at the start or at the end
//   wind       the force of the air times the displacement of the vertex
//   response   |R| times how far a vertex was pressed closer than the rest gap at the start, which pushing apart may
//              give back; and |R| times its displacement where it started tangled
// If the energy of a cloth grows by more, the gain has no source.
//
// That is a bound for steps whose end balances forces. A proposal's own stretch and speed would count as forces of the
// world, so that `of_world` takes the smaller of |R| and what the start asks for, whatever is proposed:
//   pins       |R| of a flight: the cloth goes on as it moved, and pins go where they are driven
//   obstacles  what holds the vertex at the start, and what brings it to the velocity of the obstacle in the step
//   wind       the force of the air at the start, times the largest displacement that it can cause
// `listed`: pairs near this or another motion of the cloth and its obstacles, which are brought up to date where the
// caller has such a list; null: all are searched for.
//
// Holds caches, and references to the scene and its elements.
class WorkBound {
 public:
  WorkBound(const Scene&, const Elastic&);
  Work operator()(const State& from, const State& to, const Drive&);
  Work of_world(const State& from, const State& to, const Drive&, PathPairs* listed = nullptr);

 private:
  void unnamed_forces(const State& from, const State& to, const Drive&);
  void bound_by_start(const State& from, const State& to, const Drive&);
  double carrying_force(const State& from, double dt, int vertex, const Vec3& way) const;  // of an obstacle [N]
  Eigen::VectorXd carried_work(const State& from, double dt, const Points& nodes0, const Points& nodes1,
                               PathPairs& near);  // of obstacles on every vertex, at most [J]
  Work sum(const State& from, const State& to, PathPairs& near);

  const Scene& scene_;
  ContactWorld world_;
  PairSearch search_;
  const Elastic& elastic_;
  Eigen::VectorXd masses_;
  Points elastic_before_;
  Eigen::VectorXd unnamed_;    // |R| of every vertex [N]
  Eigen::VectorXd wind_work_;  // on every vertex [J]
  Eigen::VectorXd held_;       // what holds every vertex at the start [N]; empty: nothing is bounded by the start
  AssemblyScratch scratch_;
};

}  // namespace selvedge
