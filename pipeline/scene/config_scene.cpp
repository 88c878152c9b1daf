#include "pipeline/scene/config_scene.hpp"

#include <algorithm>

// Rows that are bound to a member have its default; a default that is written here has its only place here.
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

void collect(const Section& section, std::vector<const Section*>& found) {
  if (std::find(found.begin(), found.end(), &section) != found.end()) return;
  found.push_back(&section);
  for (const Key& key : section.keys)
    if (key.section) collect(*key.section, found);
}

}  // namespace

const Options<Wind>& wind_options() {
  static const Options<Wind> table(
      "wind", "Air, moving or still. Left out: none, and no drag.",
      {vector("velocity", Unit::speed, "[0, 0, 0]", "of the air"),
       sections("keyframes", wind_key_section(), "[]", "velocities at ascending times, in place of `velocity`"),
       interpolation_key(), number("drag", &Wind::drag, Unit::none, not_negative, "coefficient along the normal"),
       number("lift", &Wind::lift, Unit::none, not_negative, "coefficient of the tangential part"),
       number("air_density", &Wind::air_density, Unit::density, not_negative, "")});
  return table;
}

const Options<ContactSettings>& contact_options() {
  using O = ContactSettings;
  static const Options<O> table(
      "contact", "",
      {number("thickness", &O::thickness, Unit::length, positive, "distance that resting layers keep"),
       number("friction", &O::friction, Unit::none, not_negative, "coefficient, cloth on obstacle"),
       number("self_friction", &O::self_friction, Unit::none, not_negative, "coefficient, cloth on cloth"),
       flag("self", &O::self, "false leaves cloth-cloth contact out; the run is then labelled \"self: not audited\""),
       flag("rigid_zones", &O::rigid_zones,
            "true: cloth in an impact zone goes on as one rigid body, which settles at once but does not slide; zones "
            "that lean on an obstacle are never rigid")});
  return table;
}

const Section& scene_section() {
  static const Section table{
      "scene",
      "The whole file.",
      "",
      {},
      {text("description", "for people"),
       text("folder",
            "where relative paths of files begin, relative to this file's folder; left out: that folder. The "
            "config.yaml of a run names the scene's"),
       needed(sections("cloths", cloth_section(), "", "at least one")),
       sections("springs", spring_options().section, "[]", "buttons and stitches"),
       sections("obstacles", obstacle_section(), "[]", ""), vector("gravity", Unit::acceleration, "[0, -9.81, 0]", ""),
       section(wind_options().section, "", ""), section(contact_options().section, "{}", ""),
       section(run_options().section, "{}", ""), section(solver_options().section, "{}", ""),
       section(output_options().section, "{}", ""),
       sections("outcome", outcome_section(), "[]", "what must come true, checked as the run goes"),
       texts("short_form", "`key=value` overrides that make a shorter run of it (`selvedge stress --short`)")}};
  return table;
}

std::shared_ptr<const SceneTable> scene_table(const Kinds& kinds) {
  const auto table = std::make_shared<SceneTable>(SceneTable{run_options().section, scene_section()});
  for (Key& key : table->run.keys)
    if (key.name == "stepper") key.choices = kinds.names();
  for (const StepperKind& kind : kinds.all())
    if (kind.options)
      table->run.keys.push_back(table::section(*kind.options, "{}", "of the stepper `" + kind.name + "`"));
  for (Key& key : table->scene.keys)
    if (key.section == &run_options().section) key.section = &table->run;
  return table;
}

const Section& material_file_section() {
  static const Section table{
      "material_file", "", "", {}, std::vector<Key>{text("description", "for people")} + keys_of(material_options())};
  return table;
}

std::vector<const Section*> scene_sections() {
  std::vector<const Section*> found;
  collect(scene_section(), found);
  return found;
}

std::string scene_reference() {
  std::string page;
  for (const Section* section : scene_sections()) page += section_chapter(*section);
  return page;
}

}  // namespace selvedge
