#include "pipeline/bodies/body_smpl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>

#include "collision/geometry/error.hpp"
#include "pipeline/formats/npz.hpp"

namespace selvedge {
namespace {

using Index = Eigen::Index;
constexpr Index any_extent = -1;

[[noreturn]] void fail(const NpyPlace& place, const std::string& what, const std::string& cure) {
  throw Error(what, place.text(), cure);
}

std::string shape_text(const std::vector<Index>& shape) {
  std::vector<std::string> parts;
  for (const Index extent : shape) parts.push_back(extent == any_extent ? "any" : std::to_string(extent));
  return fmt::format("({})", fmt::join(parts, ", "));
}

template <class T>
NpyArray<T> with_shape(NpyArray<T> array, const std::vector<Index>& wanted, const NpyPlace& place) {
  bool fits = array.shape.size() == wanted.size();
  for (std::size_t k = 0; fits && k < wanted.size(); ++k) fits = wanted[k] == any_extent || wanted[k] == array.shape[k];
  if (!fits)
    fail(place, fmt::format("has the shape {}, not {}", shape_text(array.shape), shape_text(wanted)),
         "is it a model of the SMPL family as published, and are all its fields of one model?");
  return array;
}

NpyArray<double> numbers(const Npz& npz, const std::string& field, const std::vector<Index>& shape) {
  return with_shape(npz.numbers(field), shape, npz.place(field));
}

NpyArray<std::int64_t> integers(const Npz& npz, const std::string& field, const std::vector<Index>& shape) {
  return with_shape(npz.integers(field), shape, npz.place(field));
}

// An index of the file, which must lie in [0, count).
int index_of(std::int64_t value, Index count, const NpyPlace& place) {
  if (value < 0 || value >= count)
    fail(place, fmt::format("has the index {}, out of range for {}", value, count), "indices count from 0");
  return static_cast<int>(value);
}

// Reads parents by column; the root's is -1, possibly stored as unsigned 32 bits. The second row has the id of each
// column.
std::vector<int> read_parents(const Npz& npz) {
  const NpyPlace place = npz.place("kintree_table");
  const NpyArray<std::int64_t> table = integers(npz, "kintree_table", {2, any_extent});
  const auto joints = static_cast<std::size_t>(table.shape[1]);
  std::map<std::int64_t, int> column_of;
  for (std::size_t j = 0; j < joints; ++j) column_of[table.values[joints + j]] = static_cast<int>(j);
  std::vector<int> parents;
  for (std::size_t j = 0; j < joints; ++j) {
    const std::int64_t id = table.values[j];
    const bool root = id == -1 || id == std::numeric_limits<std::uint32_t>::max();
    const auto column = column_of.find(id);
    if (!root && column == column_of.end())
      fail(place, fmt::format("has the parent {} for joint {}, which is no joint", id, j),
           "parents are ids of the second row; the root's is -1 or 4294967295");
    parents.push_back(root ? -1 : column->second);
  }
  return parents;
}

Triangles read_triangles(const Npz& npz, Index vertices) {
  const NpyArray<std::int64_t> f = integers(npz, "f", {any_extent, 3});
  Triangles triangles(f.shape[0], 3);
  for (std::size_t k = 0; k < f.values.size(); ++k)
    triangles.data()[k] = index_of(f.values[k], vertices, npz.place("f"));
  return triangles;
}

// Converts n x 3 x columns of the file to 3n x `kept`.
Eigen::MatrixXd directions(const NpyArray<double>& array, Index kept) {
  const Index columns = array.shape[2];
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(array.values.data(), 3 * array.shape[0], columns).leftCols(kept);
}

// The number of columns of shapedirs that are shapes: in SMPL-X 10 or 100 columns of expressions follow them.
Index shape_columns(Index columns, std::size_t joints) {
  if (joints != 55) return columns;
  return columns >= 400 ? 300 : std::min<Index>(columns, 10);
}

Eigen::MatrixXd read_shape_directions(const Npz& npz, Index vertices, std::size_t joints, int shapes) {
  const NpyArray<double> array = numbers(npz, "shapedirs", {vertices, 3, any_extent});
  const Index present = shape_columns(array.shape[2], joints);
  if (shapes < 0 || shapes > present)
    fail(npz.place("shapedirs"), fmt::format("has {} shapes, {} are asked for", present, shapes),
         fmt::format("ask for 0 to {}", present));
  return directions(array, shapes);
}

using Entries = std::vector<Eigen::Triplet<double>>;

SkinWeights without_zeros(const NpyArray<double>& dense) {
  Entries entries;
  const Index cols = dense.shape[1];
  for (std::size_t k = 0; k < dense.values.size(); ++k)
    if (dense.values[k] != 0)
      entries.emplace_back(static_cast<int>(static_cast<Index>(k) / cols),
                           static_cast<int>(static_cast<Index>(k) % cols), dense.values[k]);
  return from_entries(dense.shape[0], cols, entries);
}

// Reads scipy's data, indices and indptr of a sparse matrix by rows (csr) or columns (csc), by the length of indptr.
SkinWeights sparse_parts(const Npz& npz, const std::string& field, Index rows, Index cols) {
  const NpyArray<double> data = numbers(npz, field + "_data", {any_extent});
  const NpyArray<std::int64_t> indices = integers(npz, field + "_indices", {data.shape[0]});
  const NpyArray<std::int64_t> begins = integers(npz, field + "_indptr", {any_extent});
  const NpyPlace place = npz.place(field + "_indptr");
  const bool by_rows = begins.shape[0] == rows + 1;
  if (!by_rows && begins.shape[0] != cols + 1)
    fail(place, fmt::format("has {} entries, not {} (by rows) or {} (by columns)", begins.shape[0], rows + 1, cols + 1),
         "is it of the same model as the other fields?");
  if (begins.values.front() != 0 || begins.values.back() != data.shape[0] ||
      !std::is_sorted(begins.values.begin(), begins.values.end()))
    fail(place, fmt::format("does not run upwards from 0 to {}", data.shape[0]), "save the parts of one sparse matrix");
  Entries entries;
  for (std::size_t i = 0; i + 1 < begins.values.size(); ++i)
    for (std::int64_t k = begins.values[i]; k < begins.values[i + 1]; ++k) {
      const int other = index_of(indices.values[k], by_rows ? cols : rows, npz.place(field + "_indices"));
      const double value = data.values[k];
      const int one = static_cast<int>(i);
      by_rows ? entries.emplace_back(one, other, value) : entries.emplace_back(other, one, value);
    }
  return from_entries(rows, cols, entries);
}

SkinWeights read_regressor(const Npz& npz, Index joints, Index vertices) {
  if (!npz.has("J_regressor") && npz.has("J_regressor_data")) return sparse_parts(npz, "J_regressor", joints, vertices);
  return without_zeros(numbers(npz, "J_regressor", {joints, vertices}));
}

// Scales rows to sum 1. In float32 files sums are off in the seventh digit, so that a body far from the origin would
// shake.
void scale_to_one(SkinWeights& weights) {
  for (Index v = 0; v < weights.rows(); ++v) {
    double sum = 0;
    for (SkinWeights::InnerIterator entry(weights, v); entry; ++entry) sum += entry.value();
    for (SkinWeights::InnerIterator entry(weights, v); entry; ++entry) entry.valueRef() /= sum;
  }
}

}  // namespace

std::vector<std::string> smpl_joint_names(int joints) {
  if (joints != 24 && joints != 52 && joints != 55) return {};
  std::vector<std::string> names{"pelvis",     "left_hip",      "right_hip",      "spine1",      "left_knee",
                                 "right_knee", "spine2",        "left_ankle",     "right_ankle", "spine3",
                                 "left_foot",  "right_foot",    "neck",           "left_collar", "right_collar",
                                 "head",       "left_shoulder", "right_shoulder", "left_elbow",  "right_elbow",
                                 "left_wrist", "right_wrist"};
  if (joints == 24) names.insert(names.end(), {"left_hand", "right_hand"});
  if (joints == 55) names.insert(names.end(), {"jaw", "left_eye_smplhf", "right_eye_smplhf"});
  if (joints > 24)
    for (const std::string side : {"left_", "right_"})
      for (const std::string finger : {"index", "middle", "pinky", "ring", "thumb"})
        for (const std::string part : {"1", "2", "3"}) names.push_back(side + finger + part);
  return names;
}

BodyModel read_smpl(const std::filesystem::path& path, int shapes) {
  const Npz npz(path);
  BodyModel body;
  body.name = path.stem().string();
  body.parents = read_parents(npz);
  const std::size_t joints = body.parents.size();
  body.joints = smpl_joint_names(static_cast<int>(joints));
  if (body.joints.empty())
    fail(npz.place("kintree_table"), fmt::format("has {} joints", joints),
         "known are SMPL (24), SMPL-H (52) and SMPL-X (55)");

  const NpyArray<double> rest = numbers(npz, "v_template", {any_extent, 3});
  const Index vertices = rest.shape[0], columns = static_cast<Index>(joints);
  body.skin.rest = Eigen::Map<const Points>(rest.values.data(), vertices, 3);
  body.skin.triangles = read_triangles(npz, vertices);
  body.skin.shape_directions = read_shape_directions(npz, vertices, joints, shapes);
  body.skin.pose_directions = directions(numbers(npz, "posedirs", {vertices, 3, 9 * (columns - 1)}), 9 * (columns - 1));
  body.regressor = read_regressor(npz, columns, vertices);
  body.skin.weights = without_zeros(numbers(npz, "weights", {vertices, columns}));
  check_body(body, path.string(),
             {.rest = "v_template",
              .triangles = "f",
              .weights = "weights",
              .shape_directions = "shapedirs",
              .pose_directions = "posedirs",
              .joints = "kintree_table",
              .parents = "kintree_table",
              .regressor = "J_regressor"});
  scale_to_one(body.skin.weights);
  return body;
}

}  // namespace selvedge
