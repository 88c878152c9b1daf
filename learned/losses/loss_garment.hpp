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

// A garment or outfit at rest, as losses need it. Vertices without a triangle have no mass and take part in no loss.
struct LossGarment {
  Surface surface;
  ClosedSurface closed;                    // the same with its holes closed, for the volume loss
  std::vector<char> pinned;                // one flag per vertex
  std::vector<MembraneElement> membranes;  // `material` is an index into `materials`
  std::vector<Hinge> hinges;               // rest angle 0
  std::vector<Material> materials;         // St. Venant-Kirchhoff
  std::vector<double> mass;                // one per vertex [kg]
  std::vector<double> hinge_shape;         // one per hinge: its weight for a coefficient of 1
  std::vector<Spring> springs;             // stitches and buttons (set_springs)
};

// A garment of the surface at `rest` [m], with one material. `pinned` is empty or has a flag per vertex. `length` is
// the edge length in the hinge energy; `current` is the published one. Throws Error where sizes do not fit or a number
// is not finite.
LossGarment make_loss_garment(const Surface&, const Points& rest, const std::vector<char>& pinned,
                              const VertexMaterial&, HingeLength length = HingeLength::current);

// Replaces the garment's materials by one for all, or by one per vertex. Of several, a triangle has the mean of its
// corners, its density too, and a hinge the mean of its edge's ends. Throws Error for another number of materials, and
// for negative or undefined ones.
void set_material(LossGarment&, const VertexMaterial&);
void set_materials(LossGarment&, std::span<const VertexMaterial>);

// sqrt(sum |g_i|^2 / m_i) over the vertices that have a mass and are not pinned. The fast recipe divides a sample's
// gradient by it.
double inverse_mass_norm(const LossGarment&, const Points& gradient);

}  // namespace selvedge
