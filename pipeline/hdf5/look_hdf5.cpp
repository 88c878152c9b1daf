#include "pipeline/hdf5/look_hdf5.hpp"

#include <limits>

#include "collision/geometry/error.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"

namespace selvedge::h5 {
namespace {

constexpr double no_colour = std::numeric_limits<double>::quiet_NaN();

void write_materials(const File& file, const std::string& group, const Look& look) {
  std::vector<std::string> names, textures;
  Points colours = Points::Constant(std::ssize(look.materials), 3, no_colour);
  for (const LookMaterial& material : look.materials) {
    if (material.colour) colours.row(std::ssize(names)) = material.colour->transpose();
    names.push_back(material.name);
    textures.push_back(material.texture);
  }
  write_integers(file, group + "/face_material", look.face_material);
  file.write_texts(group + "/material_names", names);
  file.write_texts(group + "/material_textures", textures);
  write_points(file, group + "/material_colours", colours);
}

void write_parts(const File& file, const std::string& group, const Look& look) {
  std::vector<std::string> objects, groups, smoothings;
  for (const LookPart& part : look.parts) {
    objects.push_back(part.object);
    groups.push_back(part.groups);
    smoothings.push_back(part.smoothing);
  }
  write_integers(file, group + "/face_part", look.face_part);
  file.write_texts(group + "/part_objects", objects);
  file.write_texts(group + "/part_groups", groups);
  file.write_texts(group + "/part_smoothing", smoothings);
}

// Empty where the field is missing, as fields may be.
std::vector<int> integers_in(const File& file, const std::string& name) {
  if (!file.has(name)) return {};
  std::vector<int> values(file.shape_of(name, 1)[0]);
  if (!values.empty()) file.read_all(name, H5T_NATIVE_INT32, {values.size()}, values.data());
  return values;
}

std::vector<std::string> texts_in(const File& file, const std::string& name, std::size_t count) {
  std::vector<std::string> texts = file.read_texts(name);
  if (texts.size() != count)
    throw Error("has " + std::to_string(texts.size()) + " entries, not " + std::to_string(count),
                file.path().string() + ": " + name, "the file is damaged; make it again");
  return texts;
}

void read_materials(const File& file, const std::string& group, Look& look) {
  look.face_material = integers_in(file, group + "/face_material");
  if (look.face_material.empty()) return;
  const std::size_t count = file.shape_of(group + "/material_names", 1)[0];
  const std::vector<std::string> names = texts_in(file, group + "/material_names", count),
                                 textures = texts_in(file, group + "/material_textures", count);
  Points colours(static_cast<Eigen::Index>(count), 3);
  if (count > 0) file.read_all(group + "/material_colours", H5T_NATIVE_DOUBLE, {count, 3}, colours.data());
  for (std::size_t m = 0; m < count; ++m) {
    LookMaterial& material = look.materials.emplace_back(LookMaterial{names[m], {}, textures[m]});
    const Vec3 colour = row(colours, static_cast<int>(m));
    if (colour.allFinite()) material.colour = colour;
  }
}

void read_parts(const File& file, const std::string& group, Look& look) {
  look.face_part = integers_in(file, group + "/face_part");
  if (look.face_part.empty()) return;
  const std::size_t count = file.shape_of(group + "/part_objects", 1)[0];
  const std::vector<std::string> objects = texts_in(file, group + "/part_objects", count),
                                 groups = texts_in(file, group + "/part_groups", count),
                                 smoothings = texts_in(file, group + "/part_smoothing", count);
  for (std::size_t p = 0; p < count; ++p) look.parts.push_back({objects[p], groups[p], smoothings[p]});
}

}  // namespace

void write_look(const File& file, const std::string& group, const Look& look) {
  if (look.empty()) return;
  const Handle made = file.make_group(group);
  write_integers(file, group + "/vertex", look.vertex);
  write_integers(file, group + "/corners", look.corners);
  write_integers(file, group + "/begin", look.begin);
  if (!look.corner_uv.empty()) {
    file.write_constant(group + "/uv", H5T_NATIVE_DOUBLE, {static_cast<hsize_t>(look.uv.rows()), 2}, look.uv.data());
    write_integers(file, group + "/corner_uv", look.corner_uv);
  }
  if (!look.corner_normal.empty()) write_integers(file, group + "/corner_normal", look.corner_normal);
  if (!look.face_material.empty()) write_materials(file, group, look);
  if (!look.face_part.empty()) write_parts(file, group, look);
}

Look read_look(const File& file, const std::string& group, Eigen::Index vertices) {
  Look look;
  if (!file.has(group)) return look;
  look.vertex = integers_in(file, group + "/vertex");
  look.corners = integers_in(file, group + "/corners");
  look.begin = integers_in(file, group + "/begin");
  look.corner_uv = integers_in(file, group + "/corner_uv");
  if (!look.corner_uv.empty()) {
    const hsize_t rows = file.shape_of(group + "/uv", 2)[0];
    look.uv.resize(static_cast<Eigen::Index>(rows), 2);
    if (rows > 0) file.read_all(group + "/uv", H5T_NATIVE_DOUBLE, {rows, 2}, look.uv.data());
  }
  look.corner_normal = integers_in(file, group + "/corner_normal");
  read_materials(file, group, look);
  read_parts(file, group, look);
  check_look(look, vertices, file.path().string() + ": " + group);
  return look;
}

}  // namespace selvedge::h5
