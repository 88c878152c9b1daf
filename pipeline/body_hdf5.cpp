#include "pipeline/body_hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "collision/error.hpp"
#include "pipeline/hdf5_handles.hpp"

namespace selvedge {
namespace {

const std::string format_name = "selvedge body 1";

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::vector<hsize_t> extents(const std::vector<Eigen::Index>& shape) { return {shape.begin(), shape.end()}; }

void write_sparse(const h5::File& file, const std::string& name, const SkinWeights& matrix) {
  SkinWeights rows = matrix;
  rows.makeCompressed();
  const h5::Handle group = file.make_group(name);
  file.write_constant(name + "/indptr", H5T_NATIVE_INT32, extents({rows.rows() + 1}), rows.outerIndexPtr());
  file.write_constant(name + "/indices", H5T_NATIVE_INT32, extents({rows.nonZeros()}), rows.innerIndexPtr());
  file.write_constant(name + "/data", H5T_NATIVE_DOUBLE, extents({rows.nonZeros()}), rows.valuePtr());
}

void write_directions(const h5::File& file, const std::string& name, const Eigen::MatrixXd& directions) {
  const RowMajor rows = directions;
  file.write_constant(name, H5T_NATIVE_DOUBLE, extents({rows.rows() / 3, 3, rows.cols()}), rows.data());
}

void write_fields(const h5::File& file, const BodyModel& body) {
  const SkinnedSurface& skin = body.skin;
  file.write_text("format", format_name);
  file.write_text("name", body.name);
  file.write_constant("rest", H5T_NATIVE_DOUBLE, extents({skin.rest.rows(), 3}), skin.rest.data());
  file.write_constant("triangles", H5T_NATIVE_INT32, extents({skin.triangles.rows(), 3}), skin.triangles.data());
  write_sparse(file, "weights", skin.weights);
  write_directions(file, "shape_directions", skin.shape_directions);
  write_directions(file, "pose_directions", skin.pose_directions);
  file.write_texts("joints", body.joints);
  file.write_constant("parents", H5T_NATIVE_INT32, {body.parents.size()}, body.parents.data());
  write_sparse(file, "regressor", body.regressor);
}

[[noreturn]] void fail(const h5::File& file, const std::string& field, const std::string& what) {
  throw Error(what, file.path().string() + ": " + field, "write it as docs/bodies.md says");
}

// The shape of a field with `rank` extents, small enough to be a body's.
std::vector<Eigen::Index> shape_of(const h5::File& file, const std::string& field, std::size_t rank) {
  if (!file.has(field)) fail(file, field, "is missing");
  const h5::Handle dataset = file.open_dataset(field);
  const std::vector<hsize_t> shape = file.shape(dataset.id());
  if (shape.size() != rank) fail(file, field, fmt::format("has {} dimensions, not {}", shape.size(), rank));
  hsize_t count = 1;
  for (const hsize_t extent : shape)
    if (__builtin_mul_overflow(count, extent, &count) || count > std::numeric_limits<std::int32_t>::max())
      fail(file, field, "is larger than a body can be");
  return {shape.begin(), shape.end()};
}

template <class T>
std::vector<T> read_list(const h5::File& file, const std::string& field, hid_t type) {
  std::vector<T> values(static_cast<std::size_t>(shape_of(file, field, 1)[0]));
  if (!values.empty()) file.read_all(field, type, values.data());
  return values;
}

template <class Matrix>
Matrix read_rows_of_three(const h5::File& file, const std::string& field, hid_t type) {
  const std::vector<Eigen::Index> shape = shape_of(file, field, 2);
  if (shape[1] != 3) fail(file, field, fmt::format("has {} columns, not 3", shape[1]));
  Matrix matrix(shape[0], 3);
  if (matrix.size() > 0) file.read_all(field, type, matrix.data());
  return matrix;
}

Eigen::MatrixXd read_directions(const h5::File& file, const std::string& field, Eigen::Index vertices) {
  if (!file.has(field)) return Eigen::MatrixXd(3 * vertices, 0);
  const std::vector<Eigen::Index> shape = shape_of(file, field, 3);
  if (shape[1] != 3) fail(file, field, fmt::format("has {} coordinates by vertex, not 3", shape[1]));
  RowMajor rows(3 * shape[0], shape[2]);
  if (rows.size() > 0) file.read_all(field, H5T_NATIVE_DOUBLE, rows.data());
  return rows;
}

SkinWeights read_sparse(const h5::File& file, const std::string& field, Eigen::Index rows, Eigen::Index cols) {
  const auto begins = read_list<std::int32_t>(file, field + "/indptr", H5T_NATIVE_INT32);
  const auto indices = read_list<std::int32_t>(file, field + "/indices", H5T_NATIVE_INT32);
  const auto data = read_list<double>(file, field + "/data", H5T_NATIVE_DOUBLE);
  if (static_cast<Eigen::Index>(begins.size()) != rows + 1)
    fail(file, field + "/indptr", fmt::format("has {} entries, not {}", begins.size(), rows + 1));
  if (indices.size() != data.size())
    fail(file, field + "/indices", fmt::format("has {} entries, the data {}", indices.size(), data.size()));
  if (begins.front() != 0 || static_cast<std::size_t>(begins.back()) != data.size() ||
      !std::is_sorted(begins.begin(), begins.end()))
    fail(file, field + "/indptr", fmt::format("does not run upwards from 0 to {}", data.size()));
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t r = 0; r + 1 < begins.size(); ++r)
    for (std::int32_t k = begins[r]; k < begins[r + 1]; ++k) {
      const std::int32_t column = indices[static_cast<std::size_t>(k)];
      if (column < 0 || column >= cols)
        fail(file, field + "/indices", fmt::format("has the index {}, out of range for {}", column, cols));
      entries.emplace_back(static_cast<int>(r), column, data[static_cast<std::size_t>(k)]);
    }
  SkinWeights matrix(rows, cols);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

void write_body(const std::filesystem::path& path, const BodyModel& body) {
  check_body(body, path.string());
  std::filesystem::path beside = path;
  beside += ".part";
  try {
    h5::File file = h5::File::create(beside);
    write_fields(file, body);
    file.close();
    file.move_to(path);
  } catch (const Error&) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw;
  }
}

BodyModel read_body(const std::filesystem::path& path) {
  const h5::File file = h5::File::open(path);
  if (!file.has("format") || file.read_text("format") != format_name)
    throw Error("is no body of this program", path.string(), "its field `format` must be `" + format_name + "`");
  BodyModel body;
  body.name = file.has("name") ? file.read_text("name") : path.stem().string();
  body.skin.rest = read_rows_of_three<Points>(file, "rest", H5T_NATIVE_DOUBLE);
  body.skin.triangles = read_rows_of_three<Triangles>(file, "triangles", H5T_NATIVE_INT32);
  shape_of(file, "joints", 1);
  body.joints = file.read_texts("joints");
  body.parents = read_list<int>(file, "parents", H5T_NATIVE_INT32);
  const Eigen::Index vertices = body.skin.rest.rows(), joints = static_cast<Eigen::Index>(body.parents.size());
  body.skin.weights = read_sparse(file, "weights", vertices, joints);
  body.skin.shape_directions = read_directions(file, "shape_directions", vertices);
  body.skin.pose_directions = read_directions(file, "pose_directions", vertices);
  body.regressor = read_sparse(file, "regressor", joints, vertices);
  check_body(body, path.string());
  return body;
}

}  // namespace selvedge
