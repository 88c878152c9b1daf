#include "learned/losses/loss_terms.hpp"

#include "collision/contour/contour_energy.hpp"
#include "learned/losses/body_losses.hpp"
#include "learned/losses/cloth_losses.hpp"
#include "learned/losses/volume_loss.hpp"
#include "physics/steppers/frame_potential.hpp"

namespace selvedge {
namespace {

// The weight of a term: a member of the options, or the `weight` of that member.
template <auto member>
const LossRamp& weight_in(const LossOptions& options) {
  if constexpr (requires { (options.*member).weight; })
    return (options.*member).weight;
  else
    return options.*member;
}

bool has_forces(const LossInputs& in) { return in.acceleration; }
bool has_gravity_alone(const LossInputs& in) { return !in.acceleration; }
bool has_contours(const LossInputs& in) { return in.contours; }
bool has_target(const LossInputs& in) { return in.target; }
bool has_potential(const LossInputs& in) { return in.potential; }

double contour_loss(const LossFrame& f, Points* g) {
  const SheetView sheet{&f.garment.surface, &f.x};
  std::vector<Points> by_sheet;
  const ContourLoss& options = f.options.contours;
  const double value = contour_energy({&sheet, 1}, f.matches.crossings, ContourMeasure::squared_length,
                                      g ? &by_sheet : nullptr, options.gradient, options.normal);
  if (g) *g += by_sheet[0];
  return value;
}

constexpr LossRow loss_table[]{
    {"stretching", "stretching", "the membrane energy, and that of stitches", weight_in<&LossOptions::stretching>,
     nullptr,
     [](const LossFrame& f, Points* g) { return stretching_loss(f.garment, f.x, g) + spring_loss(f.garment, f.x, g); }},
    {"bending", "bending", "the bending energy", weight_in<&LossOptions::bending>, nullptr,
     [](const LossFrame& f, Points* g) { return bending_loss(f.garment, f.x, g); }},
    {"gravity", "gravity", "the energy of gravity", weight_in<&LossOptions::gravity>, has_gravity_alone,
     [](const LossFrame& f, Points* g) { return gravity_loss(f.garment, f.options.gravity_strength, f.x, g); }},
    {"forces", "gravity", "the energy of all forces but contact, in place of gravity's where others are drawn",
     weight_in<&LossOptions::gravity>, has_forces,
     [](const LossFrame& f, Points* g) { return force_loss(f.garment.mass, *f.in.acceleration, f.x, g); }},
    {"inertia", "inertia", "what differs from free motion", weight_in<&LossOptions::inertia>, nullptr,
     [](const LossFrame& f, Points* g) {
       const double dt = f.in.is_initial ? f.options.relaxation_dt : f.in.timestep;
       return inertia_loss(f.garment, *f.in.x, *f.in.velocity, dt, f.x, g);
     }},
    {"collision", "collision.weight", "depth in the body", weight_in<&LossOptions::collision>, has_body,
     [](const LossFrame& f, Points* g) {
       return collision_loss(f.garment, f.options.collision, f.matches.collision_face, *f.in.body, *f.in.body_next, f.x,
                             g);
     }},
    {"friction", "friction.weight", "friction on the body", weight_in<&LossOptions::friction>, has_body,
     [](const LossFrame& f, Points* g) {
       return friction_loss(f.garment, f.options.friction, f.options.gravity_strength, f.matches.friction_before,
                            f.matches.friction_after, *f.in.body, *f.in.body_previous, *f.in.body_now, *f.in.x, f.x, g);
     }},
    {"repulsion", "repulsion.weight", "repulsion between layers of cloth", weight_in<&LossOptions::repulsion>, nullptr,
     [](const LossFrame& f, Points* g) {
       return repulsion_loss(f.garment, f.options.repulsion, f.in.repulsion, *f.in.x, f.x, g);
     }},
    {"volume", "volume.weight", "the volume that self-penetrating cloth encloses", weight_in<&LossOptions::volume>,
     nullptr, [](const LossFrame& f, Points* g) { return volume_loss(f.garment.closed, f.options.volume, f.x, g); }},
    {"vertex_repulsion", "vertex_repulsion.weight", "repulsion between vertices",
     weight_in<&LossOptions::vertex_repulsion>, nullptr,
     [](const LossFrame& f, Points* g) {
       const VertexRepulsionLoss& options = f.options.vertex_repulsion;
       return vertex_repulsion_loss(f.garment.surface, options.distance, options.power, f.x, g);
     }},
    {"contours", "contours.weight", "squared lengths along intersection contours", weight_in<&LossOptions::contours>,
     has_contours, contour_loss},
    {"targets", "targets", "distance to the frame that the solver makes", weight_in<&LossOptions::targets>, has_target,
     [](const LossFrame& f, Points* g) { return target_loss(f.garment, *f.in.target, f.x, g); }},
    {"potential", "potential", "what the solver minimises in one substep a frame, with its contact and friction",
     weight_in<&LossOptions::potential>, has_potential, [](const LossFrame& f, Points* g) {
       f.in.potential->lag(f.x);
       return f.in.potential->at(f.x, g);
     }}};

}  // namespace

bool has_body(const LossInputs& in) { return in.body && in.body->triangles.rows() > 0; }

std::span<const LossRow> loss_rows() { return loss_table; }

}  // namespace selvedge
