#include "pipeline/scene/config_scene.hpp"

// Rows that are bound to a member have its default; a default that is written here has its only place here.
namespace selvedge {
namespace {

using namespace table;

const Section& wind_key_section() {
  static const Section table{"wind_key",
                             "Velocity of the air at one time.",
                             {needed(number("time", Unit::time, any, "", "Time of the keyframe.")),
                              needed(vector("velocity", Unit::speed, "", "Velocity of the air."))}};
  return table;
}

}  // namespace

const Options<Wind>& wind_options() {
  static const Options<Wind> table(
      "wind", "The air round the cloth, moving or still. Without this section there is no drag.",
      {vector("velocity", Unit::speed, "[0, 0, 0]", "Velocity of the air."),
       sections("keyframes", wind_key_section(), "[]", "Velocities at ascending times, in place of `velocity`."),
       interpolation_key(),
       number("drag", &Wind::drag, Unit::none, range_of(&Wind::drag),
              "Drag coefficient, of the velocity component normal to the cloth."),
       number("lift", &Wind::lift, Unit::none, range_of(&Wind::lift),
              "Lift coefficient, of the velocity component tangential to the cloth."),
       number("air_density", &Wind::air_density, Unit::density, range_of(&Wind::air_density), "Density of the air.")});
  return table;
}

const Options<ContactSettings>& contact_options() {
  using O = ContactSettings;
  static const Options<O> table(
      "contact", "Contact of cloth with itself, with other cloths and with obstacles.",
      {number("thickness", &O::thickness, Unit::length, range_of(&O::thickness),
              "Distance that resting layers keep from each other and from obstacles."),
       number("friction", &O::friction, Unit::none, range_of(&O::friction),
              "Friction coefficient of cloth on obstacles."),
       number("self_friction", &O::self_friction, Unit::none, range_of(&O::self_friction),
              "Friction coefficient of cloth on cloth."),
       flag("self", &O::self,
            "False: contact of cloth with cloth is left out, and the run is labelled \"self: not audited\"."),
       flag("rigid_zones", &O::rigid_zones,
            "True: an impact zone that no obstacle takes part in moves as a rigid body. The cloth in it settles at "
            "once, but does not slide.")});
  return table;
}

const Section& scene_section() {
  static const Section table{
      "scene",
      "The whole file.",
      {text("description", "Free text for readers."),
       text("folder",
            "Folder that relative paths refer to, itself relative to this file's folder. Default: this file's folder. "
            "In the config.yaml of a run it is the scene's folder."),
       needed(sections("cloths", cloth_section(), "", "Cloths, at least one.")),
       sections("springs", spring_options().section, "[]", "Buttons and stitches between vertices of cloths."),
       sections("obstacles", obstacle_section(), "[]", "Bodies and surfaces that cloth collides with."),
       vector("gravity", Unit::acceleration, "[0, -9.81, 0]", "Acceleration by gravity."),
       section(wind_options().section, "", "Velocity, drag and lift of the air."),
       section(contact_options().section, "{}", "Thickness and friction."),
       section(run_options().section, "{}", "Frames, time steps and the stepper."),
       section(solver_options().section, "{}", "Time integration, nonlinear and linear solver."),
       section(output_options().section, "{}", "Where results are written."),
       sections("outcome", outcome_section(), "[]", "Conditions that the run must meet, checked in each frame."),
       texts("short_form", "`key=value` overrides that shorten the run (`selvedge stress --short`).")}};
  return table;
}

std::shared_ptr<const SceneTable> scene_table(const Kinds& kinds) {
  const auto table = std::make_shared<SceneTable>(SceneTable{run_options().section, scene_section()});
  for (Key& key : table->run.keys)
    if (key.name == "stepper") key.choices = kinds.names();
  for (const StepperKind& kind : kinds.all())
    if (kind.options)
      table->run.keys.push_back(table::section(*kind.options, "{}", "Options of the stepper `" + kind.name + "`."));
  for (Key& key : table->scene.keys)
    if (key.section == &run_options().section) key.section = &table->run;
  return table;
}

const Section& material_file_section() {
  static const Section table{"material_file", "",
                             std::vector<Key>{text("description", "for people")} + keys_of(material_options())};
  return table;
}

}  // namespace selvedge
