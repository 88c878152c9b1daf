#include "collision/untangle/give_way.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/scene/config_scene.hpp"

namespace selvedge::table {
namespace {

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

const Section& profile_point_section() {
  static const Section table{
      "profile_point", "", "at", {}, {needed(pair("at", Unit::length, "", "distance from the axis and height", any))}};
  return table;
}

const Section& revolution_section() {
  static const Section table{
      "revolution",
      "A line turned round the y axis: a funnel, a bowl, a spike.",
      "",
      {},
      {needed(sections("profile", profile_point_section(), "",
                       "points of the line, [distance from the axis, height] each")),
       flag("closed", false, "whether the line returns to its first point, which makes a ring of solid section"),
       edge_key("0.03")}};
  return table;
}

const Section& sequence_section() {
  static const Section table{
      "sequence",
      "One mesh a frame, all with the same faces; positions between frames are linear in time, the last is held.",
      "",
      {"pattern", "files", "cache"},
      {path("pattern", "path with one %d or %0Nd for the number"),
       integer("first", not_negative, "0", "first number of the pattern"),
       integer("count", at_least_one, "", "how many; left out: as many as there are"), texts("files", "the paths"),
       path("cache", "a point cache: .pc2, .pc16 (half floats, as CLOTH3D has them) or .mdd"),
       path("mesh", "whose faces the cache moves"),
       number("fps", Unit::rate, positive, "30", "frames a second of the sequence; left out: what a .mdd says, or 30"),
       unit_key()}};
  return table;
}

const Section& trajectory_section() {
  static const Section table{
      "trajectory",
      "A cloth or an obstacle of an earlier run.",
      "file",
      {},
      {needed(path("file", "the HDF5 file")),
       text("part", "its name in that run; left out: the only obstacle or, without obstacles, the only cloth"),
       unit_key()}};
  return table;
}

const Section& bvh_joints_section() {
  static const Section table = [] {
    Section joints{
        "joints", "The file's names of SMPL's joints. What is left out goes by the names of common rigs.", "", {}, {}};
    for (const std::string& name : smpl_joint_names(smpl::joints)) joints.keys.push_back(text(name, ""));
    return joints;
  }();
  return table;
}

}  // namespace

const Section& body_section() {
  static const Section table{
      "body",
      "A skinned body, posed anew at every time.",
      "model",
      {},
      {named("model", "mannequin",
             "`mannequin`, made by code, or a file: SMPL, SMPL-H or SMPL-X as .npz, any rigged body as .h5, .glb or "
             ".gltf"),
       numbers("shape", any, "coefficients of its shapes; left out: what an AMASS clip gives an SMPL body, else zero"),
       text("clip",
            "a procedural clip, or a file: .bvh, AMASS .npz, or .glb or .gltf with an animation of the body's own "
            "skeleton; left out: it stands in the zero pose"),
       text("animation", "of a glTF clip: its name; left out: the file's first"),
       section(bvh_joints_section(), "", "of a .bvh clip whose names are not known, or known wrongly"),
       integer("rest_frame", not_negative, "",
               "of a .bvh clip: a frame in which the figure stands upright with its feet flat; left out: the file's "
               "zero pose, or where nobody stands in that, its first frame"),
       integer("first_frame", not_negative, "0", "of the clip, with which it begins"),
       integer("turns", {.low = 0, .high = 100}, "0",
               "how often it turns round where the clip ends: 1: forward and backward; 0: it stands still there"),
       number("blend_in", Unit::time, not_negative, "0", "from the start pose into the clip; 0: starts at frame 0"),
       word("start_pose", {"zero", "arms_down"}, "zero", "what is blended in from"),
       with_words(
           number("room", Unit::length, not_negative, "auto",
                  "between parts of a moving body that come together, in the body's own metres, before `scale`: it "
                  "gives way like soft tissue; `auto`: 1 cm, and 5 mm more for each garment that it wears beyond the "
                  "first; "
                  "0: it passes through itself"),
           {"auto"})}};
  return table;
}

const Section& obstacle_section() {
  static const Section table{
      "obstacle",
      "Exactly one of plane, sphere, capsule, box, revolution, mesh, sequence, trajectory and body says what it is; "
      "shapes are centred at the origin before they are placed.",
      "",
      {"plane", "sphere", "capsule", "box", "revolution", "mesh", "sequence", "trajectory", "body"},
      std::vector<Key>{text("name", "left out: obstacle0, obstacle1, ..."), section(plane_section(), "", ""),
                       section(sphere_section(), "", ""), section(capsule_section(), "", ""),
                       section(box_section(), "", ""), section(revolution_section(), "", ""),
                       section(mesh_section(), "", "a file"), section(sequence_section(), "", "moving meshes"),
                       section(trajectory_section(), "", "an earlier run"), section(body_section(), "", "a person")} +
          placement_keys() + std::vector<Key>{section(motion_section(), "", "left out: at rest")}};
  return table;
}

}  // namespace selvedge::table
