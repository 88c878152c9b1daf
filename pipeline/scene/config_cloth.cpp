#include "pipeline/scene/config_scene.hpp"

namespace selvedge {

using namespace table;

const OptionRows<Material>& material_options() {
  using O = Material;
  static const OptionRows<O> rows{
      number("density", &O::density, Unit::areal_density, positive, "mass per area"),
      choice("membrane", &O::membrane,
             {{"stvk", MembraneModel::stvk},
              {"stable_neo_hookean", MembraneModel::stable_neo_hookean},
              {"baraff_witkin", MembraneModel::baraff_witkin}},
             "in-plane model"),
      number("youngs_modulus", Unit::stiffness, not_negative, "",
             "Young's modulus times thickness; with `poisson` in place of the Lame coefficients"),
      number(
          "modulus", Unit::pressure, not_negative, "",
          "Young's modulus of a plate; with `thickness` and `poisson` in place of `youngs_modulus`, and of `bending` "
          "unless that is given"),
      number("thickness", Unit::length, positive, "",
             "h of that plate: membrane E h, bending E h^3 / (12 (1 - nu^2)); it has no part in contact"),
      number("poisson", Unit::none, {.low = 0, .high = 1, .high_in = false}, "", "Poisson's ratio, plane stress"),
      number("lame_mu", &O::lame_mu, Unit::stiffness, not_negative, "membrane shear modulus, thickness included"),
      number("lame_lambda", &O::lame_lambda, Unit::stiffness, not_negative,
             "first Lame coefficient of the membrane, thickness included"),
      number("warp", &O::warp, Unit::stiffness, not_negative, "baraff_witkin: stretch stiffness along u"),
      number("weft", &O::weft, Unit::stiffness, not_negative, "baraff_witkin: stretch stiffness along v"),
      number("shear", &O::shear, Unit::stiffness, not_negative, "baraff_witkin: shear stiffness"),
      choice("bending_model", &O::bending_model,
             {{"curvature", BendingModel::curvature}, {"hinge", BendingModel::hinge}},
             "`curvature`: physical and independent of the mesh; `hinge`: dihedral angles, as in the papers"),
      number("bending", &O::bending, Unit::bending, not_negative, "bending stiffness per width, of a plate"),
      number("hinge_bending", Unit::bending, not_negative, "",
             "the papers' coefficient k of k l^2 / (4 (A0 + A1)) angle^2 / 2; makes bending_model hinge, in place of "
             "`bending`"),
      choice("hinge_length", &O::hinge_length, {{"rest", HingeLength::rest}, {"current", HingeLength::current}},
             "which length of its edge weighs a hinge; `current` is the loss of HOOD and ContourCraft"),
      number("stiffness_damping", &O::stiffness_damping, Unit::time, not_negative,
             "Rayleigh: damping force is this times the stiffness times the velocity"),
      number("mass_damping", &O::mass_damping, Unit::rate, not_negative,
             "Rayleigh: damping force is this times the mass times the velocity"),
  };
  return rows;
}

namespace table {

const Section& material_section() {
  static const Section table{
      "material",
      "By name, by value, or by name with values that replace the named material's.",
      "name",
      {},
      std::vector<Key>{text("name",
                            "a material file without its extension, looked for in `materials/` beside the "
                            "scene file, beside its folder, and in the program's own"),
                       path("file", "a material file")} +
          keys_of(material_options())};
  return table;
}

namespace {

const Section& rest_section() {
  static const Section table{
      "rest",
      "The shape in which a cloth has no stress.",
      "from",
      {},
      {word("from", {"initial", "uv", "mesh"}, "initial",
            "`initial`: as made or read; `uv`: the texture coordinates are the flat pattern; `mesh`: another file"),
       number("uv_unit", Unit::length, positive, "1", "length of one unit of the texture coordinates"),
       path("file", "for `mesh`: same vertices and faces as the cloth"), unit_key(),
       flag("flat", true,
            "bending rests flat; false keeps the angles of the rest shape (all cloths of a scene alike)")}};
  return table;
}

const Section& box_region_section() {
  static const Section table{"box_region",
                             "",
                             "",
                             {},
                             {needed(vector("min", Unit::length, "", "lowest corner")),
                              needed(vector("max", Unit::length, "", "highest corner"))}};
  return table;
}

const Section& pin_section() {
  static const Section table{
      "pin",
      "Vertices that are held, or moved as prescribed. A vertex that two pins name obeys the first.",
      "",
      {"vertices", "box", "group"},
      selection_keys() +
          std::vector<Key>{
              section(motion_section(), "", "left out: at rest"),
              with_words(text("follow",
                              "`body`: of a garment, goes where the body takes it, skinned and giving way, in "
                              "place of `motion`"),
                         {"body"})}};
  return table;
}

const Section& copies_section() {
  static const Section table{
      "copies",
      "The cloth several times, named name_0, name_1, ... Each copy lies where the one before would lie after a turn "
      "about the middle of its bounding box and a move.",
      "count",
      {},
      {needed(integer("count", at_least_one, "", "how many in all")),
       vector("translate", Unit::length, "[0, 0, 0]", "from copy to copy"),
       vector("rotate", Unit::angle, "[0, 0, 0]", "from copy to copy: axis times angle")}};
  return table;
}

}  // namespace

std::vector<Key> selection_keys() {
  return {integers("vertices", not_negative, 1 << 30, "indices in the cloth, from 0"),
          renamed(section(box_region_section(), "", "all vertices in a box of space, as placed"), "box"),
          texts("group", "named groups of the cloth")};
}

const Section& cloth_section() {
  static const Section table{
      "cloth",
      "Exactly one of rectangle, disc, tube, ribbon, tshirt, mesh and garment says where it comes from.",
      "",
      {"rectangle", "disc", "tube", "ribbon", "tshirt", "mesh", "garment"},
      std::vector<Key>{text("name", "left out: cloth0, cloth1, ...")} + sheet_keys() +
          std::vector<Key>{section(mesh_section(), "", "a file"),
                           section(garment_options().section, "", "what a body of the scene wears")} +
          placement_keys() +
          std::vector<Key>{section(copies_section(), "", ""), section(start_options().section, "{}", ""),
                           vector("velocity", Unit::speed, "[0, 0, 0]", "at the start"),
                           section(material_section(), "{}", ""), section(rest_section(), "{}", ""),
                           sections("seams", seam_section(), "[]", "sewn in themselves: panels that become a garment"),
                           sections("pins", pin_section(), "[]", "")}};
  return table;
}

}  // namespace table
}  // namespace selvedge
