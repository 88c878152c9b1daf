#include "pipeline/scene/config_scene.hpp"

#include "pipeline/host/bounds.hpp"

namespace selvedge {

using namespace table;

const OptionRows<Material>& material_options() {
  using O = Material;
  static const OptionRows<O> rows{
      number("density", &O::density, Unit::areal_density, range_of(&O::density), "Mass per area."),
      choice("membrane", &O::membrane,
             {{"stvk", MembraneModel::stvk},
              {"stable_neo_hookean", MembraneModel::stable_neo_hookean},
              {"baraff_witkin", MembraneModel::baraff_witkin}},
             "Model of the in-plane (membrane) elasticity."),
      number("youngs_modulus", Unit::stiffness, range_of(&Elasticity::youngs_modulus), "",
             "Young's modulus times thickness. With `poisson` it replaces the Lame coefficients, whose defaults are "
             "those of 1000 N/m and Poisson's ratio 0.3."),
      number("modulus", Unit::pressure, not_negative, "",
             "Young's modulus E of the cloth as a plate. With `thickness` and `poisson` it replaces `youngs_modulus`, "
             "and `bending` unless that is given."),
      number("thickness", Unit::length, positive, "",
             "Thickness h of the cloth as a plate: membrane stiffness E h, bending stiffness E h^3 / (12 (1 - nu^2)). "
             "It has no influence on contact."),
      number("poisson", Unit::none, range_of(&Elasticity::poisson), "", "Poisson's ratio in plane stress."),
      number("lame_mu", &O::lame_mu, Unit::stiffness, range_of(&O::lame_mu), "Membrane shear modulus times thickness."),
      number("lame_lambda", &O::lame_lambda, Unit::stiffness, range_of(&O::lame_lambda),
             "First Lame coefficient of the membrane times thickness."),
      number("warp", &O::warp, Unit::stiffness, range_of(&O::warp), "Stretch stiffness along u, for `baraff_witkin`."),
      number("weft", &O::weft, Unit::stiffness, range_of(&O::weft), "Stretch stiffness along v, for `baraff_witkin`."),
      number("shear", &O::shear, Unit::stiffness, range_of(&O::shear), "Shear stiffness, for `baraff_witkin`."),
      choice("bending_model", &O::bending_model,
             {{"curvature", BendingModel::curvature}, {"hinge", BendingModel::hinge}},
             "`curvature` is physical and independent of the mesh. `hinge` penalises dihedral angles, as HOOD and "
             "ContourCraft do."),
      number("bending", &O::bending, Unit::bending, range_of(&O::bending),
             "Bending stiffness per width, as of a plate (flexural rigidity). With `bending_model: hinge` it is the "
             "coefficient k of `hinge_bending`."),
      number("hinge_bending", Unit::bending, range_of(&O::bending), "",
             "Coefficient k of the hinge energy k l^2 / (4 (A0 + A1)) angle^2 / 2, for an edge of length l between "
             "triangles of areas A0 and A1. It selects the model `hinge` and replaces `bending`."),
      choice("hinge_length", &O::hinge_length, {{"rest", HingeLength::rest}, {"current", HingeLength::current}},
             "Length l in the hinge energy: at rest or now. `current` is the loss of HOOD and ContourCraft."),
      number("stiffness_damping", &O::stiffness_damping, Unit::time, range_of(&O::stiffness_damping),
             "Rayleigh coefficient: the damping force is this times the stiffness times the velocity."),
      number("mass_damping", &O::mass_damping, Unit::rate, range_of(&O::mass_damping),
             "Rayleigh coefficient: the damping force is this times the mass times the velocity."),
  };
  return rows;
}

namespace table {

const Section& material_section() {
  static const Section table{
      "material", "A material given by name, by values, or by a name and values that replace the named material's.",
      std::vector<Key>{text("name",
                            "Name of a material file without its extension. It is searched in `materials/` beside the "
                            "scene file, beside the scene's folder, and in the program's own folder."),
                       path("file", "Path of a material file.")} +
          keys_of(material_options()),
      "name"};
  return table;
}

namespace {

const Section& rest_section() {
  static const Section table{
      "rest",
      "The shape in which a cloth has no stress.",
      {word("from", {"initial", "uv", "mesh"}, "initial",
            "`initial` takes the shape as made or read. `uv` takes the texture coordinates as a flat pattern. `mesh` "
            "takes the shape of `file`."),
       number("uv_unit", Unit::length, positive, "1", "Length of one unit of the texture coordinates."),
       path("file", "Mesh file for `from: mesh`, with the same vertices and faces as the cloth."), unit_key(),
       flag("flat", true,
            "True: rest angles are zero. False: they are the angles of the rest shape. All cloths of a scene need the "
            "same value.")},
      "from"};
  return table;
}

const Section& box_region_section() {
  static const Section table{"box_region",
                             "A box with edges along the axes.",
                             {needed(vector("min", Unit::length, "", "Lowest corner.")),
                              needed(vector("max", Unit::length, "", "Highest corner."))}};
  return table;
}

const Section& pin_section() {
  static const Section table{
      "pin",
      "Vertices that are held in place or moved as prescribed. A vertex that two pins select obeys the first.",
      selection_keys() +
          std::vector<Key>{section(motion_section(), "", "Motion of the vertices. Default: they are held in place."),
                           with_words(text("follow",
                                           "`body`: the vertices of a garment move with the skin of the body, soft "
                                           "tissue included. It replaces `motion`."),
                                      {"body"})},
      "",
      {"vertices", "box", "group"}};
  return table;
}

const Section& copies_section() {
  static const Section table{
      "copies",
      "Copies of the cloth, named name_0, name_1, ... Each copy is the one before, rotated about the middle of its "
      "bounding box and then moved.",
      {needed(integer("count", {.low = 1, .high = most_parts}, "", "Number of cloths in total.")),
       vector("translate", Unit::length, "[0, 0, 0]", "Displacement from one copy to the next."),
       vector("rotate", Unit::angle, "[0, 0, 0]",
              "Rotation from one copy to the next: the direction is the axis, the length is the angle.")},
      "count"};
  return table;
}

}  // namespace

std::vector<Key> selection_keys() {
  return {integers("vertices", not_negative, 1 << 30, "Vertex indices in the cloth, from 0."),
          renamed(section(box_region_section(), "", "All vertices that lie in a box when the cloth has been placed."),
                  "box"),
          texts("group", "Named vertex groups of the cloth.")};
}

const Section& cloth_section() {
  static const Section table{
      "cloth",
      "Exactly one of rectangle, disc, tube, ribbon, tshirt, mesh and garment gives the shape of the cloth.",
      std::vector<Key>{text("name", "Name of the cloth. Default: cloth0, cloth1, ...")} + sheet_keys() +
          std::vector<Key>{section(mesh_section(), "", "A mesh file."),
                           section(garment_section(), "", "A garment that a body of the scene wears.")} +
          placement_keys() +
          std::vector<Key>{
              section(copies_section(), "", "Copies of the cloth."),
              section(start_options().section, "{}", "How the initial state differs from the cloth as placed."),
              vector("velocity", Unit::speed, "[0, 0, 0]", "Velocity at the start."),
              section(material_section(), "{}", "Density, stiffness and damping."),
              section(rest_section(), "{}", "Rest shape."),
              sections("seams", seam_section(), "[]",
                       "Seams that join vertices of this cloth, as between the panels of a garment."),
              sections("pins", pin_section(), "[]", "Vertices that are held or moved.")},
      "",
      {"rectangle", "disc", "tube", "ribbon", "tshirt", "mesh", "garment"}};
  return table;
}

}  // namespace table
}  // namespace selvedge
