#include "pipeline/training/objective_options.hpp"

namespace selvedge {

using namespace table;

const Options<LossRamp>& ramp_options() {
  using O = LossRamp;
  static const Options<O> table(
      "ramp", "A number over the run that changes linearly between `begin` and `end`.",
      {number("from", &O::from, Unit::none, not_negative, "Value up to `begin`."),
       number("to", &O::to, Unit::none, not_negative, "Value from `end` on."),
       number("begin", &O::begin, Unit::none, from_0_to_1, "Fraction of the run at which the change begins."),
       number("end", &O::end, Unit::none, from_0_to_1, "Fraction of the run at which the change ends.")});
  return table;
}

namespace {

const Options<CollisionLoss>& collision_options() {
  using O = CollisionLoss;
  static const Options<O> table(
      "collision", "Penetration of the body: a penalty on the depth of vertices.",
      {ramp("weight", &O::weight, "Weight [N/m2], or [N/m] for the quadratic penalty."),
       number("thickness", &O::thickness, Unit::length, positive, "Distance that cloth keeps from the body."),
       choice("matching", &O::matching,
              {{"nearest_centroid", BodyMatching::nearest_centroid}, {"nearest_face", BodyMatching::nearest_face}},
              "Face of the body that belongs to a vertex: that with the nearest centroid (HOOD), or the nearest one "
              "within `radius` (ContourCraft)."),
       number("radius", &O::radius, Unit::length, positive, "Search radius of `nearest_face`."),
       choice("penalty", &O::penalty, {{"cubic", DepthPenalty::cubic}, {"quadratic", DepthPenalty::quadratic}},
              "Power of the depth: the third, as published, or the second, which is softer."),
       choice("samples", &O::samples,
              {{"vertices", ClothSamples::vertices}, {"edges", ClothSamples::edges}, {"faces", ClothSamples::faces}},
              "What is kept out of the body: `vertices` of the cloth, as published; `edges`: the middles of its edges "
              "too; `faces`: the centroids of its triangles too.")});
  return table;
}

const Options<FrictionLoss>& friction_options() {
  using O = FrictionLoss;
  static const Options<O> table(
      "friction", "Friction on the body.",
      {ramp("weight", &O::weight, "Weight of the term."),
       number("coefficient", &O::coefficient, Unit::none, not_negative, "Friction coefficient."),
       number("squared_radius", &O::squared_radius, Unit::none, positive,
              "Squared distance from the nearest centroid of the body within which a vertex must be before and after "
              "the frame to have friction [m2]."),
       choice("slope", &O::slope, {{"x", SlopeAxis::x}, {"y", SlopeAxis::y}, {"z", SlopeAxis::z}},
              "Axis along which sliding has less friction. The released code takes `z`, although y is up.")});
  return table;
}

const Options<RepulsionLoss>& repulsion_options() {
  using O = RepulsionLoss;
  static const Options<O> table(
      "repulsion", "Repulsion between layers of cloth, for pairs that repel.",
      {ramp("weight", &O::weight, "Weight [N/m2]."),
       number("thickness", &O::thickness, Unit::length, positive,
              "Repulsion thickness: the distance below which a pair repels. The paper has 0.001, its released "
              "configurations have 0.003."),
       number("correspondence", &O::correspondence, Unit::length, positive,
              "Distance above which a pair does not take part."),
       number("pinned_factor", &O::pinned_factor, Unit::none, positive,
              "Factor on the depth of pairs with a pinned vertex, before the depth is cubed.")});
  return table;
}

const Options<ContourLoss>& contour_options() {
  using O = ContourLoss;
  static const Options<O> table(
      "contours", "Sum of the squared segment lengths of intersection contours.",
      {ramp("weight", &O::weight, "Weight [N/m]."),
       choice("gradient", &O::gradient,
              {{"translational", ContourGradient::translational}, {"full", ContourGradient::full}},
              "`translational` moves triangles and does not shorten them. `full` is the derivative of the value."),
       choice("normal", &O::normal, {{"frozen", ContourNormal::frozen}, {"turning", ContourNormal::turning}},
              "`frozen` keeps the normals of faces constant, as published. `turning` is the exact derivative."),
       number("share", &O::share, Unit::none, {.low = 0, .high = 0.99},
              "Share of the term in the gradient of each sample that has contours, whatever the weight, which must not "
              "be 0. 0: as the weight has it.")});
  return table;
}

const Options<PenetrationOptions>& region_options() {
  using O = PenetrationOptions;
  static const Options<O> table(
      "regions", "How contours bound volumes.",
      {choice("rule", &O::regions, {{"single", RegionRule::single}, {"parity", RegionRule::parity}},
              "`single` judges each contour alone, as published. `parity` judges all contours between the same two "
              "components together."),
       choice("side", &O::smaller, {{"faces", SmallerSide::faces}, {"area", SmallerSide::area}},
              "The side of a contour with fewer faces, or with less area, counts as inside.")});
  return table;
}

const Options<VolumeLoss>& volume_options() {
  using O = VolumeLoss;
  static const Options<O> table(
      "volume", "The volume that self-penetrating cloth encloses (Liao et al. 2024).",
      {ramp("weight", &O::weight,
            "Weight of 6 times the volume [J/m3], or of the area [J/m2]. As published it is 3e4 from 0.632 of the run "
            "on."),
       choice("form", &O::form, {{"enclosed", VolumeForm::enclosed}, {"winding", VolumeForm::winding}},
              "`enclosed` closes the holes of garments by fans of triangles. `winding` uses winding numbers and needs "
              "no fans."),
       section(&O::regions, region_options(), "How contours bound volumes."),
       choice("measure", &O::measure, {{"volume", PenetrationMeasure::volume}, {"area", PenetrationMeasure::area}},
              "What is penalised: the volume of a region, or the area of its faces."),
       choice("crossings", &O::crossings,
              {{"exact", CrossingMotion::exact},
               {"frozen_on_edge", CrossingMotion::frozen_on_edge},
               {"frozen_on_face", CrossingMotion::frozen_on_face}},
              "How crossings of edges and faces follow the vertices. `exact`: they slide in both. The others fix their "
              "weights on the edge or the face, as published."),
       number("saturation", &O::saturation, Unit::volume, not_negative,
              "Volume V of a region above which its pressure falls as 1 / V. 0: it never falls, as published. It does "
              "not apply to `area`, nor in the form `winding` to what a garment does to itself.")});
  return table;
}

const Options<VertexRepulsionLoss>& vertex_repulsion_options() {
  using O = VertexRepulsionLoss;
  static const Options<O> table(
      "vertex_repulsion", "Repulsion between vertices that no edge joins (Liao et al. 2024, appendix A).",
      {ramp("weight", &O::weight, "Weight [J/m], or [J/m2] for the power 2."),
       number("distance", &O::distance, Unit::length, positive, "Distance below which two vertices repel."),
       integer(
           "power", &O::power, {.low = 1, .high = 2},
           "Power of the amount by which two vertices are nearer than `distance`. That of the paper is not known.")});
  return table;
}

}  // namespace

const Options<LossOptions>& objective_options() {
  using O = LossOptions;
  static const Options<O> table(
      "objective", "Terms of the loss and their weights over the run. A term whose weight is zero is left out.",
      {ramp("stretching", &O::stretching, "Weight of the membrane energy and of stitches."),
       ramp("bending", &O::bending, "Weight of the bending energy."),
       ramp("gravity", &O::gravity, "Weight of the energy of gravity."),
       ramp("inertia", &O::inertia, "Weight of the inertia term."),
       section(&O::collision, collision_options(), "Penetration of the body."),
       section(&O::friction, friction_options(), "Friction on the body."),
       section(&O::repulsion, repulsion_options(), "Repulsion between layers of cloth."),
       section(&O::contours, contour_options(), "Length of intersection contours."),
       section(&O::volume, volume_options(), "Volume that self-penetrating cloth encloses."),
       section(&O::vertex_repulsion, vertex_repulsion_options(), "Repulsion between vertices."),
       ramp("targets", &O::targets,
            "Weight of the distance to the frame that the solver makes from the same state [J/mm]: the root of the "
            "mean square over the masses."),
       ramp("potential", &O::potential,
            "Weight of the incremental potential that the solver minimises: inertia, elasticity, contact and friction, "
            "in one substep a frame."),
       number("gravity_strength", &O::gravity_strength, Unit::none, not_negative,
              "Acceleration by gravity, against y [m/s2]."),
       number("relaxation_dt", &O::relaxation_dt, Unit::time, positive,
              "Time step of the inertia term in a frame in which cloth falls to rest.")});
  return table;
}

}  // namespace selvedge
