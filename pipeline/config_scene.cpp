#include "pipeline/config_scene.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "pipeline/setup.hpp"

// Defaults are read from the structs that hold them; a default that is written here has its only place here.
namespace selvedge {
namespace {

const Range any{};
const Range positive{.low = 0, .low_in = false};
const Range not_negative{.low = 0};
const Range at_least_one{.low = 1};

template <class T>
std::string show(const T& value) {
  return fmt::format("{}", value);
}

Key number(std::string name, Unit unit, Range range, std::string otherwise, std::string about) {
  return {.name = std::move(name),
          .kind = Kind::number,
          .about = std::move(about),
          .unit = unit,
          .range = range,
          .otherwise = std::move(otherwise)};
}
Key integer(std::string name, Range range, std::string otherwise, std::string about) {
  return {.name = std::move(name),
          .kind = Kind::integer,
          .about = std::move(about),
          .range = range,
          .otherwise = std::move(otherwise)};
}
Key flag(std::string name, bool otherwise, std::string about) {
  return {.name = std::move(name), .kind = Kind::boolean, .about = std::move(about), .otherwise = show(otherwise)};
}
Key word(std::string name, std::vector<std::string> choices, std::string otherwise, std::string about) {
  return {.name = std::move(name),
          .kind = Kind::text,
          .about = std::move(about),
          .otherwise = std::move(otherwise),
          .choices = std::move(choices)};
}
Key text(std::string name, std::string about) {
  return {.name = std::move(name), .kind = Kind::text, .about = std::move(about)};
}
Key path(std::string name, std::string about) {
  return {.name = std::move(name), .kind = Kind::path, .about = std::move(about)};
}
Key vector(std::string name, Unit unit, std::string otherwise, std::string about) {
  return {.name = std::move(name),
          .kind = Kind::vector,
          .about = std::move(about),
          .unit = unit,
          .otherwise = std::move(otherwise)};
}
Key pair(std::string name, Unit unit, std::string otherwise, std::string about) {
  return {.name = std::move(name),
          .kind = Kind::pair,
          .about = std::move(about),
          .unit = unit,
          .range = positive,
          .otherwise = std::move(otherwise)};
}
Key integers(std::string name, Range range, int most, std::string about) {
  return {.name = std::move(name), .kind = Kind::integers, .about = std::move(about), .range = range, .most = most};
}
Key texts(std::string name, std::string about) {
  return {.name = std::move(name), .kind = Kind::texts, .about = std::move(about)};
}
Key section(const Section& table, std::string otherwise, std::string about) {
  return {.name = table.name,
          .kind = Kind::section,
          .about = std::move(about),
          .otherwise = std::move(otherwise),
          .section = &table};
}
Key sections(std::string name, const Section& table, std::string otherwise, std::string about) {
  return {.name = std::move(name),
          .kind = Kind::sections,
          .about = std::move(about),
          .otherwise = std::move(otherwise),
          .section = &table};
}
Key needed(Key key) {
  key.required = true;
  return key;
}
Key with_words(Key key, std::vector<std::string> choices) {
  key.choices = std::move(choices);
  return key;
}

std::vector<Key> operator+(std::vector<Key> a, const std::vector<Key>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Key unit_key() {
  return with_words(number("unit", Unit::length, positive, "m", "length of one unit of the file"),
                    {"m", "dm", "cm", "mm"});
}

std::vector<Key> placement_keys() {
  return {number("scale", Unit::none, positive, "1", "factor on all lengths, applied first; the rest shape scales too"),
          vector("rotate", Unit::angle, "[0, 0, 0]", "then turned about the origin: axis times angle"),
          vector("translate", Unit::length, "[0, 0, 0]", "then moved")};
}

Key edge_key(const std::string& otherwise) {
  return number("edge", Unit::length, positive, otherwise, "longest edge of the triangles, about");
}

const Section& keyframe_section() {
  static const Section table{"keyframe",
                             "A pose at a time. The turn may exceed 360 degrees.",
                             "",
                             {},
                             {needed(number("time", Unit::time, any, "", "when")),
                              vector("translate", Unit::length, "[0, 0, 0]", "displacement from where it was placed"),
                              vector("rotate", Unit::angle, "[0, 0, 0]", "turn about `center`: axis times angle")}};
  return table;
}

Key interpolation_key() {
  return word("interpolation", {"linear", "smooth"}, "linear",
              "from key to key; `smooth` is C1, does not overshoot and rests at the first and last key");
}

const Section& motion_section() {
  static const Section table{
      "motion",
      "Rigid motion by keyframes; held before the first and after the last.",
      "",
      {},
      {needed(sections("keyframes", keyframe_section(), "", "at ascending times")), interpolation_key(),
       vector("center", Unit::length, "", "of rotation; left out: the middle of the bounding box of what moves")}};
  return table;
}

std::vector<Key> material_values() {
  const Material m;
  return {
      number("density", Unit::areal_density, positive, show(m.density), "mass per area"),
      word("membrane", {"stvk", "stable_neo_hookean", "baraff_witkin"}, "stvk", "in-plane model"),
      number("youngs_modulus", Unit::stiffness, not_negative, "",
             "Young's modulus times thickness; with `poisson` in place of the Lame coefficients"),
      number("poisson", Unit::none, {.low = 0, .high = 1, .high_in = false}, "", "Poisson's ratio, plane stress"),
      number("lame_mu", Unit::stiffness, not_negative, show(m.lame_mu), "membrane shear modulus, thickness included"),
      number("lame_lambda", Unit::stiffness, not_negative, show(m.lame_lambda),
             "first Lame coefficient of the membrane, thickness included"),
      number("warp", Unit::stiffness, not_negative, show(m.warp), "baraff_witkin: stretch stiffness along u"),
      number("weft", Unit::stiffness, not_negative, show(m.weft), "baraff_witkin: stretch stiffness along v"),
      number("shear", Unit::stiffness, not_negative, show(m.shear), "baraff_witkin: shear stiffness"),
      word("bending_model", {"curvature", "hinge"}, "curvature",
           "`curvature`: physical and independent of the mesh; `hinge`: dihedral angles, as in the papers"),
      number("bending", Unit::bending, not_negative, show(m.bending), "bending stiffness per width"),
      number("stiffness_damping", Unit::time, not_negative, show(m.stiffness_damping),
             "Rayleigh: damping force is this times the stiffness times the velocity"),
      number("mass_damping", Unit::rate, not_negative, show(m.mass_damping),
             "Rayleigh: damping force is this times the mass times the velocity"),
  };
}

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
          material_values()};
  return table;
}

std::vector<Key> triangulation_keys() {
  return {word("triangulation", {"one_diagonal", "alternating", "unstructured"}, "alternating", "how it is cut"),
          integer("seed", not_negative, "1", "of the unstructured triangulation")};
}

const Section& rectangle_section() {
  static const Section table{
      "rectangle",
      "Horizontal, normal up, centred at the origin. Groups: left, right, top (-z), bottom, boundary, center, "
      "top_left, top_right, bottom_left, bottom_right.",
      "",
      {},
      std::vector<Key>{pair("size", Unit::length, "[1, 1]", "along x and z"),
                       integers("resolution", {.low = 2}, 2, "vertices along x and z; in place of `edge`"),
                       edge_key("0.02")} +
          triangulation_keys()};
  return table;
}

const Section& disc_section() {
  static const Section table{
      "disc",
      "Horizontal, normal up, centred at the origin. Groups: boundary, center.",
      "",
      {},
      std::vector<Key>{number("radius", Unit::length, positive, "0.5", ""),
                       integers("resolution", {.low = 1}, 1, "rings of vertices round the centre; in place of `edge`"),
                       edge_key("0.02")} +
          triangulation_keys()};
  return table;
}

const Section& tube_section() {
  static const Section table{
      "tube",
      "Round the y axis, centred at the origin, normals outward. Groups: top, bottom, boundary.",
      "",
      {},
      std::vector<Key>{
          number("radius", Unit::length, positive, "0.2", ""), number("height", Unit::length, positive, "1", "along y"),
          integers("resolution", {.low = 2}, 2, "vertices round (at least 6) and along; in place of `edge`"),
          edge_key("0.02")} +
          triangulation_keys()};
  return table;
}

const Section& mesh_section() {
  static const Section table{"mesh",
                             "An OBJ or PLY file. The names of its `o` and `g` lines are groups.",
                             "file",
                             {},
                             {needed(path("file", "")), unit_key()}};
  return table;
}

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

Key renamed(Key key, std::string name) {
  key.name = std::move(name);
  return key;
}

const Section& pin_section() {
  static const Section table{
      "pin",
      "Vertices that are held, or moved as prescribed. A vertex that two pins name obeys the first.",
      "",
      {"vertices", "box", "group"},
      {integers("vertices", not_negative, 1 << 30, "indices in the cloth, from 0"),
       renamed(section(box_region_section(), "", "all vertices in a box of space, as placed"), "box"),
       texts("group", "named groups of the cloth"), section(motion_section(), "", "left out: at rest")}};
  return table;
}

const Section& cloth_section() {
  static const Section table{
      "cloth",
      "Exactly one of rectangle, disc, tube and mesh says where it comes from.",
      "",
      {"rectangle", "disc", "tube", "mesh"},
      std::vector<Key>{text("name", "left out: cloth0, cloth1, ..."), section(rectangle_section(), "", "a sheet"),
                       section(disc_section(), "", "a round sheet"), section(tube_section(), "", "a sleeve"),
                       section(mesh_section(), "", "a file")} +
          placement_keys() +
          std::vector<Key>{vector("velocity", Unit::speed, "[0, 0, 0]", "at the start"),
                           section(material_section(), "{}", ""), section(rest_section(), "{}", ""),
                           sections("pins", pin_section(), "[]", "")}};
  return table;
}

const Section& plane_section() {
  static const Section table{"plane",
                             "A horizontal sheet, normal up.",
                             "",
                             {},
                             {pair("size", Unit::length, "[4, 4]", "along x and z"), edge_key("0.25")}};
  return table;
}

const Section& sphere_section() {
  static const Section table{
      "sphere", "", "", {}, {number("radius", Unit::length, positive, "0.3", ""), edge_key("0.03")}};
  return table;
}

const Section& capsule_section() {
  static const Section table{
      "capsule",
      "A cylinder along y with round ends.",
      "",
      {},
      {number("radius", Unit::length, positive, "0.1", ""),
       number("length", Unit::length, not_negative, "0.5", "without the ends"), edge_key("0.03")}};
  return table;
}

const Section& box_section() {
  static const Section table{
      "box", "", "", {}, {vector("size", Unit::length, "[1, 1, 1]", "along x, y and z"), edge_key("0.1")}};
  return table;
}

const Section& sequence_section() {
  static const Section table{
      "sequence",
      "One mesh a frame, all with the same faces; positions between frames are linear in time, the last is held.",
      "",
      {"pattern", "files"},
      {path("pattern", "path with one %d or %0Nd for the number"),
       integer("first", not_negative, "0", "first number of the pattern"),
       integer("count", at_least_one, "", "how many; left out: as many as there are"), texts("files", "the paths"),
       number("fps", Unit::rate, positive, "30", "frames a second of the sequence"), unit_key()}};
  return table;
}

const Section& trajectory_section() {
  static const Section table{
      "trajectory",
      "A cloth or an obstacle of an earlier run.",
      "file",
      {},
      {needed(path("file", "the HDF5 file")),
       text("part", "its name in that run; left out: the only obstacle, or all cloths"), unit_key()}};
  return table;
}

const Section& obstacle_section() {
  static const Section table{
      "obstacle",
      "Exactly one of plane, sphere, capsule, box, mesh, sequence and trajectory says what it is; shapes are centred "
      "at the origin before they are placed.",
      "",
      {"plane", "sphere", "capsule", "box", "mesh", "sequence", "trajectory"},
      std::vector<Key>{text("name", "left out: obstacle0, obstacle1, ..."), section(plane_section(), "", ""),
                       section(sphere_section(), "", ""), section(capsule_section(), "", ""),
                       section(box_section(), "", ""), section(mesh_section(), "", "a file"),
                       section(sequence_section(), "", "moving meshes"),
                       section(trajectory_section(), "", "an earlier run")} +
          placement_keys() + std::vector<Key>{section(motion_section(), "", "left out: at rest")}};
  return table;
}

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
       flag("self", c.self, "false leaves cloth-cloth contact out; the run is then labelled \"self: not audited\"")}};
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
       with_words(integer("substeps", at_least_one, "auto", "time steps a frame; `auto`: from the speed"), {"auto"}),
       integer("max_substeps", at_least_one, show(r.conventional.max_substeps), "most that `auto` takes"),
       word("stepper", {"conventional"}, r.stepper, "who makes the frames")}};
  return table;
}

const Section& solver_section() {
  const ImplicitEulerOptions o;
  static const Section table{
      "solver",
      "Implicit Euler.",
      "",
      {},
      {number("velocity_tolerance", Unit::speed, positive, show(o.velocity_tolerance),
              "Newton ends when its largest displacement is below this times the time step"),
       integer("max_newton", at_least_one, show(o.max_newton), "iterations a step"),
       word("linear_solver", {"automatic", "cholmod", "pcg"}, "automatic", "`automatic`: by size"),
       number("linear_tolerance", Unit::none, {.low = 0, .high = 1, .low_in = false, .high_in = false},
              show(o.linear_tolerance), "relative residual of PCG in a Newton iteration"),
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
       sections("obstacles", obstacle_section(), "[]", ""), vector("gravity", Unit::acceleration, "[0, -9.81, 0]", ""),
       section(wind_section(), "", ""), section(contact_section(), "{}", ""), section(run_section(), "{}", ""),
       section(solver_section(), "{}", ""), section(output_section(), "{}", "")}};
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

}  // namespace selvedge
