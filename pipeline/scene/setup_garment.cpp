#include "pipeline/scene/setup_garment.hpp"

#include <fmt/format.h>

#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/mesh_mtl.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "pipeline/garments/garment_dressed.hpp"
#include "pipeline/garments/garment_hdf5.hpp"
#include "pipeline/garments/garment_make.hpp"
#include "pipeline/garments/mesh_frame.hpp"
#include "pipeline/garments/outfit.hpp"
#include "pipeline/garments/worn_part.hpp"
#include "pipeline/host/lower_extension.hpp"
#include "pipeline/obstacles/setup_mesh.hpp"
#include "pipeline/obstacles/setup_motion.hpp"
#include "pipeline/obstacles/setup_paths.hpp"

namespace selvedge {
namespace {

constexpr double skin_width = 0.02;  // of the skin that a garment's vertex goes along with [m]

// A garment's place comes from its body, and copies could not wear it.
void check_placed_by_body(const Config& cloth) {
  const auto refuse = [&](const char* key, bool differs) {
    if (differs)
      cloth[key].fail("is given for a garment", "leave it out: a garment is where its body is; place the body instead");
  };
  refuse("scale", cloth["scale"].number() != 1);
  for (const char* key : {"rotate", "translate", "velocity"}) refuse(key, cloth[key].vector() != Vec3(0, 0, 0));
  refuse("copies", cloth["copies"].given);
  if (!cloth["seams"].items.empty())
    cloth["seams"].fail("is given for a garment", "sew the mesh first, then make the garment of it");
}

std::shared_ptr<const Performance> wearer(const Config& garment, const Performances& bodies) {
  std::vector<std::string> names;
  std::shared_ptr<const Performance> found;
  const Config& on = garment["on"];
  for (const auto& body : bodies) {
    if (!body) continue;
    names.push_back(body->name);
    if (!on.given || body->name == on.text()) found = body;
  }
  if (names.empty()) garment.fail("has no body to be worn by", "add an obstacle with a `body`");
  if (on.given && !found)
    on.fail("names `" + on.text() + "`, which is no body of the scene",
            "bodies: " + joined(names) + suggestion(on.text(), names));
  if (!on.given && names.size() > 1)
    garment.fail("does not say who wears it", "name one of the bodies " + joined(names) + " with `on`");
  return found;
}

void check_fits(const Config& file, const Garment& garment, const Performance& who) {
  const auto joints = static_cast<Eigen::Index>(who.body.joints.size());
  const std::string cure = "take the body that the garment was made for, or make it anew with `selvedge dress`";
  if (garment.skin.weights.cols() != joints)
    file.fail(fmt::format("is a garment for a body with {} joints, `{}` has {}", garment.skin.weights.cols(), who.name,
                          joints),
              cure);
  if (garment.skin.shape_directions.cols() < who.shape.size())
    file.fail(fmt::format("is a garment with {} shapes, `{}` is given {}", garment.skin.shape_directions.cols(),
                          who.name, who.shape.size()),
              cure);
}

void check_mannequin(const Config& garment, const Performance& who) {
  if (who.body.name.starts_with("mannequin")) return;
  garment.fail("is for the mannequin, and `" + who.name + "` is `" + who.body.name + "`",
               "make it for that body with `selvedge dress`, and name its file");
}

Garment read_cut(const Config& section, const Performance& who) {
  check_mannequin(section["cut"], who);
  GarmentOptions options;
  if (const Config& edge = section["edge"]; edge.given) options.edge = edge.number();
  return kept_garment(cache_folder(), section["cut"].text(), who.body, options, section["over"].words);
}

std::vector<Garment> read_outfit(const Config& section, const std::filesystem::path& folder, const Performance& who) {
  const Config& name = section["outfit"];
  check_mannequin(name, who);
  const Wardrobe wardrobe = read_wardrobe(config_near(folder, "outfits.yaml"));
  std::vector<std::string> known;
  for (const Outfit& outfit : wardrobe.outfits) {
    known.push_back(outfit.name);
    if (outfit.name != name.text()) continue;
    const double of_form = section["form"].text() == "full" ? outfit.edge : outfit.small_edge;
    const double edge = section["edge"].given ? section["edge"].number() : of_form;
    return section["layers"].text() == "alone" ? kept_layers(cache_folder(), outfit, who.body, edge)
                                               : kept_outfit(cache_folder(), outfit, who.body, edge);
  }
  name.fail("is the unknown outfit `" + name.text() + "`",
            "outfits: " + joined(known) + suggestion(name.text(), known));
}

bool is_mesh(const std::filesystem::path& name) {
  return lower_extension(name) == ".obj" || lower_extension(name) == ".ply";
}

// What to do with a mesh that is not on the body as its section says.
std::string frame_cure(const Mesh& mesh, const Points& body, const Triangles& body_triangles) {
  const std::string otherwise = "make the garment with `selvedge dress`, which takes poses";
  const std::optional<MeshFrame> frame = clear_frame(fitting_frames(mesh.x, mesh.triangles, body, body_triangles));
  if (!frame) return "give its `unit` and the axis that points `up`, or " + otherwise;
  return fmt::format("write `unit: {}, up: {}`, with which it lies on the body, or {}", frame->unit,
                     frame->up == Up::y ? "y" : "z", otherwise);
}

// A mesh that lies where the body wears it in its zero pose and the shape that its section gives. `as_read`: the
// mesh before unit and axis were applied.
Garment dressed_as_worn(const Config& section, const std::string& name, const Mesh& mesh, const Performance& who,
                        const Mesh& as_read) {
  const Points body = shaped(who.body.skin, who.given_shape);
  if (worn_part(of_triangles(mesh.x, mesh.triangles), body).places.empty())
    section["file"].fail("is not worn: hardly a vertex lies on the body in its zero pose",
                         frame_cure(as_read, body, who.body.skin.triangles));
  const Dressing how{who.given_shape, {}, section["fit"].text() == "tight" ? Fit::tight : Fit::loose, {}};
  Garment garment = dressed(mesh, who.body, how).garment;
  garment.name = name;
  return garment;
}

Garment read_dressed(const Config& section, const std::filesystem::path& file, const Performance& who,
                     std::vector<std::string>& warnings) {
  Mesh mesh = read_mesh(file);
  read_materials(mesh, MissingMtl::ignore);
  const Mesh as_read = mesh;
  mesh.x = read_unit(section["unit"]) * with_y_up(mesh.x, section["up"].text() == "z" ? Up::z : Up::y);
  refuse_far(section["file"], "mesh " + file.string(), mesh.x);
  read_weld(section, file.string(), mesh);
  warnings.insert(warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
  return dressed_as_worn(section, file.stem().string(), mesh, who, as_read);
}

// Keys that what gives the garment does not use are mistakes. Defaults are written into the configurations of runs, so
// that a key with its default is none.
void check_keys_used(const Config& section) {
  const char* kind = section["file"].given ? "file" : section["cut"].given ? "cut" : "outfit";
  const auto refuse = [&](const char* key, const char* of, bool differs) {
    if (differs && std::string_view(kind) != of)
      section[key].fail(fmt::format("is given beside `{}`, and goes with `{}` alone", kind, of), "leave it out");
  };
  if (section["edge"].given && section["file"].given)
    section["edge"].fail("is given beside `file`, and goes with `cut` or `outfit`", "leave it out");
  refuse("over", "cut", section["over"].given && !section["over"].words.empty());
  refuse("form", "outfit", section["form"].text() != "small");
  refuse("layers", "outfit", section["layers"].text() != "over");
  refuse("unit", "file", read_unit(section["unit"]) != 1);
  refuse("up", "file", section["up"].text() != "y");
  refuse("fit", "file", section["fit"].text() != "loose");
  refuse("weld", "file", section["weld"].flag());
}

Garment read_file(const Config& section, const std::filesystem::path& folder, const Performance& who,
                  std::vector<std::string>& warnings) {
  const Config& file = section["file"];
  const std::filesystem::path path = existing_path(file, folder);
  if (is_mesh(path)) return read_dressed(section, path, who, warnings);
  if (lower_extension(path) != ".h5")
    file.fail("is no .h5, .obj or .ply file", "`selvedge dress` makes a garment of a mesh that a body wears");
  if (read_unit(section["unit"]) != 1 || section["up"].text() != "y" || section["fit"].text() != "loose")
    file.fail("is a garment file, which has its own unit, axes and fit", "leave `unit`, `up` and `fit` out");
  if (section["weld"].flag())
    file.fail("is a garment file, whose seams are as they were made", "make it with `selvedge dress --weld`");
  Garment garment = read_garment(path);
  check_fits(file, garment, who);
  if (!garment.made_for.empty() && garment.made_for != who.body.name)
    warnings.push_back(fmt::format("garment `{}` was made for the body `{}`, and `{}` is `{}`", garment.name,
                                   garment.made_for, who.name, who.body.name));
  return garment;
}

std::shared_ptr<const Wearing> worn_by(const std::shared_ptr<const Performance>& who, Garment garment) {
  SkinWeights skin;
  Footing footing;
  if (who->soft_tissue) {
    skin = shares_of_body(garment.skin.rest, who->body, skin_width);
    footing = footing_of(garment.skin.rest, {who->surface, who->body.skin.rest});
  }
  return std::make_shared<Wearing>(Wearing{std::move(garment), who, std::move(skin), std::move(footing)});
}

}  // namespace

std::vector<Garment> read_garments(const Config& section, const std::filesystem::path& folder, const Performance& who,
                                   std::vector<std::string>& warnings) {
  check_keys_used(section);
  std::vector<Garment> garments;
  if (section["outfit"].given)
    garments = read_outfit(section, folder, who);
  else
    garments.push_back(section["cut"].given ? read_cut(section, who) : read_file(section, folder, who, warnings));
  for (Garment& garment : garments)
    if (!section["pins"].flag()) garment.pins.clear();
  return garments;
}

std::vector<std::shared_ptr<const Wearing>> read_wearings(const Config& cloth, const std::filesystem::path& folder,
                                                          const Performances& bodies,
                                                          std::vector<std::string>& warnings) {
  const Config& section = cloth["garment"];
  check_placed_by_body(cloth);
  const auto who = wearer(section, bodies);
  std::vector<std::shared_ptr<const Wearing>> worn;
  for (Garment& garment : read_garments(section, folder, *who, warnings))
    worn.push_back(worn_by(who, std::move(garment)));
  return worn;
}

std::shared_ptr<const Wearing> wear_mesh(const Config& cloth, const std::string& name, const Mesh& mesh,
                                         const std::optional<std::vector<int>>& pins, const Performances& bodies) {
  const Config& section = cloth["garment"];
  check_placed_by_body(cloth);
  const auto who = wearer(section, bodies);
  Garment garment = dressed_as_worn(section, name, mesh, *who, mesh);
  if (pins) garment.pins = *pins;
  if (!section["pins"].flag()) garment.pins.clear();
  return worn_by(who, std::move(garment));
}

Mesh rest_mesh(const Wearing& wearing) {
  Mesh mesh;
  mesh.x = rest_shape(wearing.garment, wearing.by->body, wearing.by->shape);
  mesh.triangles = wearing.garment.skin.triangles;
  mesh.groups = wearing.garment.groups;
  mesh.look = wearing.garment.look;
  const std::vector<RestTriangle>& flat = wearing.garment.flat;
  if (flat.empty()) return mesh;
  mesh.uv.resize(3 * std::ssize(flat), 2);
  mesh.uv_triangles.resize(std::ssize(flat), 3);
  for (Eigen::Index t = 0; t < std::ssize(flat); ++t)
    for (int k = 0; k < 3; ++k) {
      mesh.uv_triangles(t, k) = static_cast<int>(3 * t + k);
      mesh.uv.row(3 * t + k) = flat[static_cast<std::size_t>(t)].col(k).transpose();
    }
  return mesh;
}

namespace {

// The garment skinned as its body is, before it is placed.
Points skinned(const Wearing& wearing, double time) {
  const Performance& who = *wearing.by;
  const BodyPose pose = pose_at(who, time);
  return posed(wearing.garment.skin, who.shape, pose, transforms_to(who, pose));
}

// The same, moved with the soft tissue.
Points with_soft_tissue(const Wearing& wearing, double time) {
  const Performance& who = *wearing.by;
  Points x = skinned(wearing, time);
  if (!who.soft_tissue) return x;
  const PosedBody& body = posed_at(who, time);
  return x + wearing.skin * (body.given - body.skinned);
}

Points squeezed_at(const Wearing& wearing, const Footing& footing, double time, const Points& x) {
  const Performance& who = *wearing.by;
  return who.soft_tissue ? squeezed(footing, skin_at(who, time), x) : x;
}

}  // namespace

Points skinned_at(const Wearing& wearing, double time) { return in_scene(*wearing.by, skinned(wearing, time), time); }

Points held_at(const Wearing& wearing, const std::vector<int>& vertices, double time) {
  const Points x = with_soft_tissue(wearing, time)(vertices, Eigen::all);
  return in_scene(*wearing.by, squeezed_at(wearing, footing_of(wearing.footing, vertices), time, x), time);
}

Points targets_at(const Wearing& wearing, double time) {
  Points x = with_soft_tissue(wearing, time);
  if (wearing.by->garments > 1) x = squeezed_at(wearing, wearing.footing, time, x);
  return in_scene(*wearing.by, x, time);
}

Points skinned_velocity(const Wearing& wearing, double time) {
  const double fps = wearing.by->clip.fps;
  return fps * (skinned_at(wearing, time + 1 / fps) - skinned_at(wearing, time));
}

void warn_of_seams(const Config& garment, const std::string& what, const Points& rest, const Triangles& triangles,
                   std::vector<std::string>& warnings) {
  if (!garment["file"].given) return;
  const Welding seams = weldable(rest, triangles);
  if (seams.joined == 0) return;
  const bool is_mesh = lower_extension(garment["file"].text()) != ".h5";
  warnings.push_back(what + ": " +
                     unwelded_text(seams, is_mesh ? "`weld: true` under `garment`" : "`selvedge dress --weld`"));
}

}  // namespace selvedge
