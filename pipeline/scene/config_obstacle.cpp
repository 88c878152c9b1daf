#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/host/bounds.hpp"
#include "pipeline/scene/config_scene.hpp"

namespace selvedge::table {
namespace {

const Section& plane_section() {
  static const Section table{"plane",
                             "A horizontal sheet with its normal up.",
                             {pair("size", Unit::length, "[4, 4]", "Lengths along x and z."), edge_key("0.25")}};
  return table;
}

const Section& sphere_section() {
  static const Section table{
      "sphere", "", {number("radius", Unit::length, positive, "0.3", "Radius of the sphere."), edge_key("0.03")}};
  return table;
}

const Section& capsule_section() {
  static const Section table{
      "capsule",
      "A cylinder along y with hemispherical ends.",
      {number("radius", Unit::length, positive, "0.1", "Radius of the cylinder and of its ends."),
       number("length", Unit::length, not_negative, "0.5", "Length of the cylinder without its ends."),
       edge_key("0.03")}};
  return table;
}

const Section& box_section() {
  static const Section table{
      "box", "", {vector("size", Unit::length, "[1, 1, 1]", "Lengths along x, y and z."), edge_key("0.1")}};
  return table;
}

const Section& profile_point_section() {
  static const Section table{
      "profile_point", "", {needed(pair("at", Unit::length, "", "Distance from the axis and height.", any))}, "at"};
  return table;
}

const Section& revolution_section() {
  static const Section table{
      "revolution",
      "A surface of revolution about the y axis: a funnel, a bowl, a spike.",
      {needed(sections("profile", profile_point_section(), "",
                       "Points of the profile, each [distance from the axis, height].")),
       flag("closed", false,
            "True: the profile returns to its first point, which makes a ring with a solid cross-section."),
       edge_key("0.03")}};
  return table;
}

Key start_key() {
  return number("start", Unit::time, any, "",
                "Time at which its first frame is shown. Default: what the file says (the start frame of a .pc2 or "
                ".pc16, the first time of a .mdd or of a run), else 0.");
}

const Section& sequence_section() {
  static const Section table{
      "sequence",
      "One mesh for each frame, all with the same faces. Positions between frames are "
      "interpolated linearly, and the first and the last frame are held.",
      {path("pattern", "Path of the mesh files, with one %d or %0Nd for the frame number."),
       integer("first", not_negative, "0", "First frame number of `pattern`."),
       integer("count", at_least_one, "", "Number of frames, missing ones included. Default: as many as there are."),
       texts("files", "Paths of the mesh files."),
       path("cache", "Point cache: .pc2, .pc16 (half floats, as CLOTH3D has them) or .mdd."),
       path("mesh", "Mesh file whose faces the cache moves."),
       number("fps", Unit::rate, positive, "30",
              "Frames a second of the sequence. Default: those of a .mdd file, else 30, with a "
              "warning."),
       start_key(), unit_key()},
      "",
      {"pattern", "files", "cache"}};
  return table;
}

const Section& trajectory_section() {
  static const Section table{"trajectory",
                             "A cloth or an obstacle of an earlier run.",
                             {needed(path("file", "HDF5 file of that run.")),
                              text("part",
                                   "Name of the cloth or obstacle in that run. Default: the only obstacle or, without "
                                   "obstacles, the only cloth."),
                              start_key(), unit_key()},
                             "file"};
  return table;
}

const Section& bvh_joints_section() {
  static const Section table = [] {
    Section joints{
        "joints", "The clip's names of SMPL's joints. Joints that are left out are found by the names of common rigs."};
    for (const std::string& name : smpl_joint_names(smpl::joints)) joints.keys.push_back(text(name, ""));
    return joints;
  }();
  return table;
}

}  // namespace

const Section& body_section() {
  static const Section table{
      "body",
      "A skinned body, animated by its skeleton.",
      {named("model", "mannequin",
             "`mannequin`, which the program makes, or a file: SMPL, SMPL-H or SMPL-X as .npz, any rigged body as .h5, "
             ".glb or .gltf."),
       numbers("shape", any, "Shape coefficients. Default: those of an AMASS clip for an SMPL body, else zero."),
       text("clip",
            "Name of a procedural clip, or a file: .bvh, AMASS .npz, or .glb or .gltf with an animation of the body's "
            "own skeleton. Default: the body stands in the zero pose."),
       text("animation", "Name of the animation in a glTF clip. Default: the first one of the file."),
       section(bvh_joints_section(), "",
               "Joint names of a .bvh clip, for files whose names are not recognised, or wrongly."),
       integer("rest_frame", not_negative, "",
               "Frame of a .bvh clip in which the figure stands upright with its feet flat. Default: the file's zero "
               "pose, or its first frame if that is no standing pose."),
       integer("first_frame", not_negative, "0",
               "Frame of the clip, at its own rate, at which the motion begins. In a glTF animation: sixtieths of a "
               "second."),
       integer("turns", {.low = 0, .high = 100}, "0",
               "How often the motion reverses at an end of the clip. 1: forward and backward. 0: the body keeps the "
               "last pose."),
       number("blend_in", Unit::time, {.low = 0, .high = longest_lead}, "0",
              "Time in which the body moves from `start_pose` into the clip. 0: it begins with the clip."),
       word("start_pose", {"zero", "arms_down"}, "zero", "Pose from which `blend_in` starts."),
       with_words(
           number("room", Unit::length, not_negative, "auto",
                  "Gap that soft tissue keeps open for cloth between parts of a moving body, before `scale`. `auto`: 1 "
                  "cm, and 5 mm more for each garment beyond the first. 0: the body may pass through itself."),
           {"auto"})},
      "model"};
  return table;
}

const Section& obstacle_section() {
  static const Section table{
      "obstacle",
      "Exactly one of plane, sphere, capsule, box, revolution, mesh, sequence, trajectory and body defines the "
      "obstacle. Shapes are centred at the origin before they are placed.",
      std::vector<Key>{
          text("name", "Name of the obstacle. Default: obstacle0, obstacle1, ..."),
          section(plane_section(), "", "A horizontal sheet."), section(sphere_section(), "", "A sphere."),
          section(capsule_section(), "", "A cylinder with round ends."), section(box_section(), "", "A box."),
          section(revolution_section(), "", "A surface of revolution."), section(mesh_section(), "", "A mesh file."),
          section(sequence_section(), "", "A mesh for each frame."),
          section(trajectory_section(), "", "A cloth or an obstacle of an earlier run."),
          section(body_section(), "", "A skinned body.")} +
          placement_keys() +
          std::vector<Key>{section(motion_section(), "", "Rigid motion. Default: the obstacle does not move.")},
      "",
      {"plane", "sphere", "capsule", "box", "revolution", "mesh", "sequence", "trajectory", "body"}};
  return table;
}

}  // namespace selvedge::table
