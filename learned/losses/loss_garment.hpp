#pragma once

#include <span>
#include <vector>

#include "collision/penetration/closed_surface.hpp"
#include "physics/energies/bending.hpp"
#include "physics/energies/membrane_element.hpp"
#include "physics/scene/scene.hpp"

namespace selvedge {

// What the losses know of a vertex's cloth. The defaults are HOOD's. Members are described where keys are bound to
// them: pipeline/training/training_options.cpp.
struct VertexMaterial {
  double density = 0.20022;
  double lame_mu = 23600 * 4.7e-4, lame_lambda = 44400 * 4.7e-4;
  double bending = 3.9626e-5;
  bool operator==(const VertexMaterial&) const = default;
};

// A garment or outfit at rest, as losses need it. Vertices without mass, which no triangle has, take part in no loss.
struct LossGarment {
  Surface surface;
  ClosedSurface closed;                    // the same with its holes closed, for the volume loss
  std::vector<char> pinned;                // of each vertex
  std::vector<MembraneElement> membranes;  // `material` is an index into `materials`
  std::vector<Hinge> hinges;               // rest angle 0
  std::vector<Material> materials;         // St. Venant-Kirchhoff
  std::vector<double> mass;                // of each vertex [kg]
  std::vector<double> hinge_shape;         // of each hinge: its weight for a coefficient of 1
  std::vector<Spring> springs;             // stitches and buttons (set_springs)
};

// Of the surface at `rest` [m], with one material. `pinned` is empty or has a flag a vertex. `length` says which edge
// length the hinge energy takes: the current one is the published loss. Throws Error where sizes do not fit or a number
// is not finite.
LossGarment make_loss_garment(const Surface&, const Points& rest, const std::vector<char>& pinned,
                              const VertexMaterial&, HingeLength length = HingeLength::current);

// Gives the garment other materials: one for all, or one a vertex. Then triangles and hinges have the mean of their
// corners and of their edge's ends, and a triangle's density is the mean of its corners'. Throws Error for another
// number of materials, and for negative or undefined ones.
void set_material(LossGarment&, const VertexMaterial&);
void set_materials(LossGarment&, std::span<const VertexMaterial>);

// sqrt(sum |g_i|^2 / m_i) over the vertices that are neither pinned nor without mass: what the fast recipe divides a
// sample's gradient by.
double inverse_mass_norm(const LossGarment&, const Points& gradient);

}  // namespace selvedge
