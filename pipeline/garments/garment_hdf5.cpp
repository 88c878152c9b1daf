#include "pipeline/garments/garment_hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/bodies/skin_hdf5.hpp"
#include "pipeline/hdf5/look_hdf5.hpp"

namespace selvedge {
namespace {

const h5::FileForm file_form{"selvedge garment 1", "garment", "docs/garments.md"};

// Writes names, where each group's vertices begin in one list, and that list.
void write_groups(const h5::File& file, const Garment& garment) {
  std::vector<std::string> names;
  std::vector<int> begin{0}, all;
  for (const auto& [name, vertices] : garment.groups) {
    names.push_back(name);
    all.insert(all.end(), vertices.begin(), vertices.end());
    begin.push_back(static_cast<int>(all.size()));
  }
  const h5::Handle group = file.make_group("groups");
  file.write_texts("groups/names", names);
  h5::write_integers(file, "groups/begin", begin);
  h5::write_integers(file, "groups/vertices", all);
}

void read_groups(const h5::Fields& fields, Garment& garment) {
  if (!fields.has("groups")) return;
  const std::vector<std::string> names = fields.texts("groups/names");
  const std::vector<int> begin = fields.integers("groups/begin"), all = fields.integers("groups/vertices");
  if (begin.size() != names.size() + 1)
    fields.fail("groups/begin", fmt::format("has {} entries for {} names, not one more", begin.size(), names.size()));
  if (begin.front() != 0 || static_cast<std::size_t>(begin.back()) != all.size() ||
      !std::is_sorted(begin.begin(), begin.end()))
    fields.fail("groups/begin", fmt::format("does not run upwards from 0 to {}", all.size()));
  for (std::size_t g = 0; g < names.size(); ++g)
    garment.groups.emplace_back(names[g], std::vector<int>(all.begin() + begin[g], all.begin() + begin[g + 1]));
}

void write_made_in(const h5::File& file, const BodyPose& pose) {
  if (pose.rotations.rows() == 0) return;
  const h5::Handle group = file.make_group("made_in");
  h5::write_points(file, "made_in/rotations", pose.rotations);
  h5::write_points(file, "made_in/translation", pose.translation.transpose());
}

BodyPose read_made_in(const h5::Fields& fields) {
  BodyPose pose;
  if (!fields.has("made_in")) return pose;
  pose.rotations = fields.points("made_in/rotations");
  const Points translation = fields.points("made_in/translation");
  if (translation.rows() != 1)
    fields.fail("made_in/translation", fmt::format("has {} rows, not 1", translation.rows()));
  pose.translation = translation.row(0).transpose();
  return pose;
}

void write_stitches(const h5::File& file, const std::vector<Stitch>& stitches) {
  if (stitches.empty()) return;
  std::vector<int> from, to;
  std::vector<double> lengths;
  for (const auto& [a, b, rest_length] : stitches) {
    from.push_back(a);
    to.push_back(b);
    lengths.push_back(rest_length);
  }
  const h5::Handle group = file.make_group("stitches");
  h5::write_integers(file, "stitches/from", from);
  h5::write_integers(file, "stitches/to", to);
  h5::write_numbers(file, "stitches/rest_lengths", lengths);
}

std::vector<Stitch> read_stitches(const h5::Fields& fields) {
  if (!fields.has("stitches")) return {};
  const std::vector<int> from = fields.integers("stitches/from"), to = fields.integers("stitches/to");
  const std::vector<double> lengths = fields.numbers("stitches/rest_lengths");
  if (to.size() != from.size())
    fields.fail("stitches/to", fmt::format("has {} entries, not {}", to.size(), from.size()));
  if (lengths.size() != from.size())
    fields.fail("stitches/rest_lengths", fmt::format("has {} entries, not {}", lengths.size(), from.size()));
  std::vector<Stitch> stitches;
  for (std::size_t k = 0; k < from.size(); ++k) stitches.push_back({from[k], to[k], lengths[k]});
  return stitches;
}

void write_flat(const h5::File& file, const std::vector<RestTriangle>& flat) {
  if (flat.empty()) return;
  std::vector<double> numbers;
  for (const RestTriangle& triangle : flat) numbers.insert(numbers.end(), triangle.data(), triangle.data() + 6);
  h5::write_numbers(file, "flat", numbers);
}

std::vector<RestTriangle> read_flat(const h5::Fields& fields) {
  if (!fields.has("flat")) return {};
  const std::vector<double> numbers = fields.numbers("flat");
  if (numbers.size() % 6 != 0) fields.fail("flat", fmt::format("has {} numbers, not six a triangle", numbers.size()));
  std::vector<RestTriangle> flat(numbers.size() / 6);
  for (std::size_t t = 0; t < flat.size(); ++t)
    std::copy_n(numbers.begin() + 6 * static_cast<std::ptrdiff_t>(t), 6, flat[t].data());
  return flat;
}

constexpr int most_joints = 100000;  // a damaged file may claim more than fits in memory

Eigen::Index read_joint_count(const h5::Fields& fields) {
  const std::vector<int> count = fields.integers("joint_count");
  if (count.size() != 1 || count[0] < 1 || count[0] > most_joints)
    fields.fail("joint_count", fmt::format("is not one number from 1 to {}", most_joints));
  return count[0];
}

}  // namespace

void write_garment(const std::filesystem::path& path, const Garment& garment) {
  check_garment(garment, path.string());
  h5::write_form(path, file_form, [&](const h5::File& file) {
    file.write_text("name", garment.name);
    file.write_text("made_for", garment.made_for);
    h5::write_integers(file, "joint_count", {static_cast<int>(garment.skin.weights.cols())});
    h5::write_skin(file, garment.skin);
    write_made_in(file, garment.made_in);
    write_groups(file, garment);
    h5::write_integers(file, "pins", garment.pins);
    write_stitches(file, garment.stitches);
    write_flat(file, garment.flat);
    h5::write_look(file, "look", garment.look);
  });
}

Garment read_garment(const std::filesystem::path& path) {
  const h5::Fields fields(path, file_form);
  Garment garment;
  garment.name = fields.has("name") ? fields.text("name") : path.stem().string();
  if (fields.has("made_for")) garment.made_for = fields.text("made_for");
  garment.skin = h5::read_skin(fields, read_joint_count(fields));
  garment.made_in = read_made_in(fields);
  read_groups(fields, garment);
  if (fields.has("pins")) garment.pins = fields.integers("pins");
  garment.stitches = read_stitches(fields);
  garment.flat = read_flat(fields);
  garment.look = h5::read_look(fields.file(), "look", garment.skin.rest.rows());
  check_garment(garment, path.string());
  return garment;
}

}  // namespace selvedge
