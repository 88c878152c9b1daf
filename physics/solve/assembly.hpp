#pragma once

#include <vector>

#include "physics/energies/bending.hpp"
#include "physics/energies/joints.hpp"
#include "physics/energies/membrane.hpp"
#include "physics/linear/linear_system.hpp"

namespace selvedge {

// All elastic elements of a scene and where their parts go. Elements are numbered membrane triangles first, then
// hinges, curved vertices and joints; kinds that the scene does not have are empty and cost nothing. Each element
// writes into slots of its own and each vertex and pair sums its slots in a fixed order: the same bits for any number
// of threads.
struct Elastic {
  std::vector<Material> materials;  // of the cloths
  std::vector<MembraneElement> membrane;
  std::vector<Hinge> hinges;
  std::vector<CurvedVertex> curved;
  Scene joints;       // the scene's lists of joints alone
  SparseMatrix flat;  // Q [N/m], acts on each coordinate alone; 0 x 0 where no flat cloth bends by curvature

  std::vector<int> element_begin, element_nodes;  // a position in element_nodes is a force slot
  std::vector<int> pair_begin;                    // first pair slot of each element: (0, 1), (0, 2) .. (1, 2) ..
  std::vector<double> element_damping;  // stiffness damping of the element's cloth, of a joint's several the mean [s]
  std::vector<double> vertex_damping;   // the same of each vertex
  PairPattern pattern;
  std::vector<int> force_gather_begin, force_gather;  // the force slots of each vertex
  std::vector<int> pair_gather_begin, pair_gather;    // the pair slots of each pair
};
Elastic make_elastic(const Scene&);

// What elements write before it is summed. Kept between calls for its memory alone.
struct AssemblyScratch {
  Points forces;
  PairBlocks pairs;
};

// filtered: each element made PSD; exact: as it is (curved vertices stay Gauss-Newton); damping: filtered, each element
// times its stiffness damping.
enum class HessianForm { filtered, exact, damping };

// Appends one sum a chunk of elements [J]: their total is the elastic energy, and the total of their differences is a
// change of energy with little rounding.
void append_elastic_energies(const Elastic&, const Points& x, std::vector<double>& energies);

// Gradient (n x 3, written, Q included) and Hessian of the elements (written, Q not included); either may be null.
void elastic_derivatives(const Elastic&, const Points& x, AssemblyScratch&, Points* gradient, PairBlocks* hessian,
                         HessianForm = HessianForm::filtered);

}  // namespace selvedge
