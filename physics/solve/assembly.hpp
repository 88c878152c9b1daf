#pragma once

#include <vector>

#include "collision/geometry/lists.hpp"
#include "physics/energies/bending.hpp"
#include "physics/energies/joints.hpp"
#include "physics/energies/measures.hpp"
#include "physics/linear/linear_system.hpp"

namespace selvedge {

// All elastic elements of a scene and the slots of their results. Elements are numbered: membrane triangles first, then
// hinges, curved vertices and joints; kinds that the scene does not have are empty. Each element writes into slots of
// its own, and each vertex and pair sums its slots in a fixed order, so that bits do not depend on the number of
// threads.
struct Elastic {
  std::vector<Material> materials;  // of the cloths
  std::vector<MembraneElement> membrane;
  std::vector<Hinge> hinges;
  std::vector<CurvedVertex> curved;
  Scene joints;       // the scene's lists of joints alone
  SparseMatrix flat;  // Q [N/m], for each coordinate; 0 x 0 if no flat cloth bends by curvature

  std::vector<int> element_begin, element_nodes;  // indices of element_nodes are force slots
  std::vector<int> pair_begin;                    // first pair slot of each element: (0, 1), (0, 2) .. (1, 2) ..
  std::vector<double> element_damping;  // stiffness damping of the element's cloth; for a joint the mean of its own [s]
  std::vector<double> vertex_damping;   // the same of each vertex
  PairPattern pattern;
  IndexLists force_slots;  // of each vertex
  // Where the block of each pair slot is written: at ~pair in the Hessian itself for the first slot of each pair, else
  // in the scratch. `further`: the places in the scratch that are added to each pair.
  std::vector<int> pair_place;
  IndexLists further;
};
Elastic make_elastic(const Scene&);

// The slots that elements write, but for those in the Hessian. Kept between calls only to save allocations.
struct AssemblyScratch {
  Points forces;
  PairBlocks pairs;
};

// filtered: each element is projected to positive semidefinite. exact: not projected (curved vertices stay
// Gauss-Newton). damping: filtered, and each element times its stiffness damping.
enum class HessianForm { filtered, exact, damping };

// Appends one sum for each chunk of elements [J]. Their total is the elastic energy; summing differences of two such
// lists gives a change of energy with little rounding.
void append_elastic_energies(const Elastic&, const Points& x, std::vector<double>& energies);

// The elements and the masses [kg] that `energies` sums over. Refers to both.
EnergyElements energy_elements(const Elastic&, const Eigen::VectorXd& masses);

// Overwrites the gradient (n x 3 [N], with Q) and the Hessian of the elements ([N/m], without Q); either may be null.
void elastic_derivatives(const Elastic&, const Points& x, AssemblyScratch&, Points* gradient, PairBlocks* hessian,
                         HessianForm = HessianForm::filtered);

}  // namespace selvedge
