#include "pipeline/hdf5/hdf5_fields.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/error.hpp"

namespace selvedge::h5 {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::vector<hsize_t> extents(const std::vector<Eigen::Index>& shape) { return {shape.begin(), shape.end()}; }

}  // namespace

Fields::Fields(const std::filesystem::path& path, FileForm form) : form_(std::move(form)), file_(File::open(path)) {
  if (!file_.has("format") || file_.read_text("format") != form_.format)
    throw Error("holds no " + form_.noun + " of this program", path.string(),
                "give a file whose field `format` is `" + form_.format + "`");
}

void Fields::fail(const std::string& field, const std::string& what) const {
  throw Error(what, file_.path().string() + ": " + field, "write it as " + form_.page + " says");
}

// The shape of a field with `rank` extents.
std::vector<Eigen::Index> Fields::shape_of(const std::string& field, std::size_t rank) const {
  if (!file_.has(field)) fail(field, "is missing");
  const std::vector<hsize_t> shape = file_.shape_of(field, rank);
  return {shape.begin(), shape.end()};
}

template <class T>
std::vector<T> Fields::list(const std::string& field, hid_t type) const {
  std::vector<T> values(static_cast<std::size_t>(shape_of(field, 1)[0]));
  if (!values.empty()) file_.read_all(field, type, {values.size()}, values.data());
  return values;
}

template <class Matrix>
Matrix Fields::rows_of_three(const std::string& field, hid_t type) const {
  const std::vector<Eigen::Index> shape = shape_of(field, 2);
  if (shape[1] != 3) fail(field, fmt::format("has {} columns, not 3", shape[1]));
  Matrix matrix(shape[0], 3);
  if (matrix.size() > 0) file_.read_all(field, type, extents(shape), matrix.data());
  return matrix;
}

Eigen::MatrixXd Fields::directions(const std::string& field, Eigen::Index vertices) const {
  if (!file_.has(field)) return Eigen::MatrixXd(3 * vertices, 0);
  const std::vector<Eigen::Index> shape = shape_of(field, 3);
  if (shape[2] == 0) return Eigen::MatrixXd(3 * vertices, 0);
  if (shape[0] != vertices || shape[1] != 3)
    fail(field, fmt::format("has {} vertices of {} coordinates, not {} of 3", shape[0], shape[1], vertices));
  RowMajor rows(3 * shape[0], shape[2]);
  if (rows.size() > 0) file_.read_all(field, H5T_NATIVE_DOUBLE, extents(shape), rows.data());
  return rows;
}

std::vector<std::string> Fields::texts(const std::string& field) const {
  shape_of(field, 1);
  return file_.read_texts(field);
}

std::vector<int> Fields::integers(const std::string& field) const {
  return list<std::int32_t>(field, H5T_NATIVE_INT32);
}

std::vector<double> Fields::numbers(const std::string& field) const { return list<double>(field, H5T_NATIVE_DOUBLE); }

Points Fields::points(const std::string& field) const { return rows_of_three<Points>(field, H5T_NATIVE_DOUBLE); }

Triangles Fields::triangles(const std::string& field) const {
  return rows_of_three<Triangles>(field, H5T_NATIVE_INT32);
}

SparseRows Fields::sparse(const std::string& field, Eigen::Index rows, Eigen::Index cols) const {
  const auto begins = integers(field + "/indptr"), indices = integers(field + "/indices");
  const auto data = numbers(field + "/data");
  if (static_cast<Eigen::Index>(begins.size()) != rows + 1)
    fail(field + "/indptr", fmt::format("has {} entries, not {}", begins.size(), rows + 1));
  if (indices.size() != data.size())
    fail(field + "/indices", fmt::format("has {} entries, the data {}", indices.size(), data.size()));
  if (begins.front() != 0 || static_cast<std::size_t>(begins.back()) != data.size() ||
      !std::is_sorted(begins.begin(), begins.end()))
    fail(field + "/indptr", fmt::format("does not run upwards from 0 to {}", data.size()));
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t r = 0; r + 1 < begins.size(); ++r)
    for (int k = begins[r]; k < begins[r + 1]; ++k) {
      const int column = indices[k];
      if (column < 0 || column >= cols)
        fail(field + "/indices", fmt::format("has the index {}, out of range for {}", column, cols));
      entries.emplace_back(static_cast<int>(r), column, data[k]);
    }
  SparseRows matrix(rows, cols);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void write_integers(const File& file, const std::string& name, const std::vector<int>& values) {
  file.write_constant(name, H5T_NATIVE_INT32, {values.size()}, values.data());
}

void write_numbers(const File& file, const std::string& name, const std::vector<double>& values) {
  file.write_constant(name, H5T_NATIVE_DOUBLE, {values.size()}, values.data());
}

void write_points(const File& file, const std::string& name, const Points& points) {
  file.write_constant(name, H5T_NATIVE_DOUBLE, extents({points.rows(), 3}), points.data());
}

void write_triangles(const File& file, const std::string& name, const Triangles& triangles) {
  file.write_constant(name, H5T_NATIVE_INT32, extents({triangles.rows(), 3}), triangles.data());
}

void write_sparse(const File& file, const std::string& name, const SparseRows& matrix) {
  SparseRows rows = matrix;
  rows.makeCompressed();
  const Handle group = file.make_group(name);
  file.write_constant(name + "/indptr", H5T_NATIVE_INT32, extents({rows.rows() + 1}), rows.outerIndexPtr());
  file.write_constant(name + "/indices", H5T_NATIVE_INT32, extents({rows.nonZeros()}), rows.innerIndexPtr());
  file.write_constant(name + "/data", H5T_NATIVE_DOUBLE, extents({rows.nonZeros()}), rows.valuePtr());
}

void write_directions(const File& file, const std::string& name, const Eigen::MatrixXd& directions) {
  const RowMajor rows = directions;
  file.write_constant(name, H5T_NATIVE_DOUBLE, extents({rows.rows() / 3, 3, rows.cols()}), rows.data());
}

void check_out_name(const std::filesystem::path& out, const std::string& nouns) {
  if (out.extension() != ".h5") throw Error("is no .h5 file", "--out " + out.string(), nouns + " are written in HDF5");
}

void write_form(const std::filesystem::path& path, const FileForm& form,
                const std::function<void(const File&)>& fields) {
  write_whole(path, [&](const File& file) {
    file.write_text("format", form.format);
    fields(file);
  });
}

}  // namespace selvedge::h5
