#include "pipeline/scene/config_scene.hpp"

#include <algorithm>

#include "pipeline/config/config_tables.hpp"
#include "pipeline/scene/run_options.hpp"

// Defaults are read from the structs that hold them; a default that is written here has its only place here.
namespace selvedge {
namespace {

using namespace table;

const Section& wind_key_section() {
  static const Section table{
      "wind_key",
      "",
      "",
      {},
      {needed(number("time", Unit::time, any, "", "when")), needed(vector("velocity", Unit::speed, "", "of the air"))}};
  return table;
}

const Section& wind_section() {
  const Wind w;
  static const Section table{
      "wind",
      "Air, moving or still. Left out: none, and no drag.",
      "",
      {},
      {vector("velocity", Unit::speed, "[0, 0, 0]", "of the air"),
       sections("keyframes", wind_key_section(), "[]", "velocities at ascending times, in place of `velocity`"),
       interpolation_key(), number("drag", Unit::none, not_negative, show(w.drag), "coefficient along the normal"),
       number("lift", Unit::none, not_negative, show(w.lift), "coefficient of the tangential part"),
       number("air_density", Unit::density, not_negative, show(w.air_density), "")}};
  return table;
}

const Section& contact_section() {
  const ContactSettings c;
  static const Section table{
      "contact",
      "",
      "",
      {},
      {number("thickness", Unit::length, positive, show(c.thickness), "distance that resting layers keep"),
       number("friction", Unit::none, not_negative, show(c.friction), "coefficient, cloth on obstacle"),
       number("self_friction", Unit::none, not_negative, show(c.self_friction), "coefficient, cloth on cloth"),
       flag("self", c.self, "false leaves cloth-cloth contact out; the run is then labelled \"self: not audited\""),
       flag("rigid_zones", c.rigid_zones,
            "true: cloth in an impact zone goes on as one rigid body, which settles at once but does not slide; zones "
            "that lean on an obstacle are never rigid")}};
  return table;
}

const Section& icm_section() {
  const IcmOptions o;
  static const Section table{
      "icm",
      "Contours minimised together with the cloth's energy, without continuous detection and without learning.",
      "",
      {},
      {integer("outer_iterations", at_least_one, show(o.outer_iterations),
               "a substep: pairs found anew, then a minimisation"),
       number("contour_weight", Unit::none, not_negative, show(o.contour_weight),
              "of the contours' squared segment lengths, in mean vertex masses over the time step squared"),
       word("contour_gradient", {"translational", "full"}, "translational",
            "`translational`: edges are moved, not shortened"),
       number("push_speed", Unit::speed, not_negative, show(o.push_speed),
              "at which what contours enclose is asked back; 0: the contour energy alone"),
       number("reach", Unit::length, not_negative, show(o.reach),
              "how far apart pairs may be that are kept from passing each other; the thickness at least")}};
  return table;
}

const Section& run_section() {
  const RunOptions r;
  static const Section table{
      "run",
      "",
      "",
      {},
      {integer("frames", at_least_one, show(r.frames), "how many"),
       number("fps", Unit::rate, positive, show(r.fps), "frames a second"),
       with_words(
           integer("substeps", at_least_one, "auto", "time steps a frame; `auto`: from the speed of what touches"),
           {"auto"}),
       integer("max_substeps", at_least_one, show(r.conventional.max_substeps), "most that `auto` takes"),
       word("stepper", known_steppers(), r.stepper, "who makes the frames"),
       flag("rest", r.rest, "cloths that rest, with nothing moving near them, are left out of the work"),
       section(icm_section(), "{}", "of the stepper `icm`")}};
  return table;
}

const Section& solver_section() {
  const ImplicitEulerOptions o;
  static const Section table{
      "solver",
      "",
      "",
      {},
      {word("integrator", {"implicit_euler", "bdf2"}, "implicit_euler",
            "`bdf2`: of second order in time where nothing touches, with less damping; implicit Euler elsewhere. "
            "Not of the stepper `icm`"),
       number("velocity_tolerance", Unit::speed, positive, show(o.velocity_tolerance),
              "Newton ends when the RMS of its displacement is below this times the time step,"),
       number("relative_tolerance", Unit::none, not_negative, show(o.relative_tolerance),
              "or below this part of the RMS motion in the step"),
       integer("max_newton", at_least_one, show(o.max_newton), "iterations a step"),
       word("linear_solver", {"automatic", "cholmod", "pcg", "multigrid"}, "automatic",
            "`automatic`: cholmod for the smallest scenes, otherwise multigrid"),
       number("linear_tolerance", Unit::none, {.low = 0, .high = 1, .low_in = false, .high_in = false},
              show(o.linear_tolerance),
              "residual of PCG in a Newton iteration, relative, in its preconditioner's norm"),
       integer("max_linear", at_least_one, show(o.max_linear), "PCG iterations"),
       number("slip_speed", Unit::speed, positive, show(o.slip_speed), "below it friction is viscous")}};
  return table;
}

const Section& output_section() {
  static const Section table{
      "output", "", "", {}, {path("folder", "for the results; left out: chosen by the command")}};
  return table;
}

void collect(const Section& section, std::vector<const Section*>& found) {
  if (std::find(found.begin(), found.end(), &section) != found.end()) return;
  found.push_back(&section);
  for (const Key& key : section.keys)
    if (key.section) collect(*key.section, found);
}

}  // namespace

const Section& scene_section() {
  static const Section table{
      "scene",
      "The whole file.",
      "",
      {},
      {text("description", "for people"), needed(sections("cloths", cloth_section(), "", "at least one")),
       sections("springs", spring_section(), "[]", "buttons and stitches"),
       sections("obstacles", obstacle_section(), "[]", ""), vector("gravity", Unit::acceleration, "[0, -9.81, 0]", ""),
       section(wind_section(), "", ""), section(contact_section(), "{}", ""), section(run_section(), "{}", ""),
       section(solver_section(), "{}", ""), section(output_section(), "{}", ""),
       sections("outcome", outcome_section(), "[]", "what must come true, checked as the run goes"),
       texts("short_form", "`key=value` overrides that make a shorter run of it (`selvedge stress --short`)")}};
  return table;
}

const Section& material_file_section() {
  static const Section table{
      "material_file", "", "", {}, std::vector<Key>{text("description", "for people")} + material_values()};
  return table;
}

std::vector<const Section*> scene_sections() {
  std::vector<const Section*> found;
  collect(scene_section(), found);
  return found;
}

std::string scene_reference() {
  std::string page;
  for (const Section* section : scene_sections()) {
    page += "### " + section->name + "\n\n";
    if (!section->about.empty()) page += section->about + "\n\n";
    if (!section->shorthand.empty()) page += "A plain value stands for `" + section->shorthand + "`.\n\n";
    page += section_markdown(*section) + "\n";
  }
  return page;
}

}  // namespace selvedge
