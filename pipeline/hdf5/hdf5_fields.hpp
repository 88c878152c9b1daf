#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/SparseCore>

#include "collision/geometry/points.hpp"
#include "pipeline/hdf5/hdf5_handles.hpp"

namespace selvedge::h5 {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

// The name of one of our file formats, and the page that describes it.
struct FileForm {
  std::string format;  // text of the field `format`
  std::string noun;    // body, garment
  std::string page;    // docs/bodies.md
};

// Fields of a file in one of our formats. A field that is missing or has another shape throws Error with file, field
// and page.
class Fields {
 public:
  Fields(const std::filesystem::path&, FileForm);

  [[noreturn]] void fail(const std::string& field, const std::string& what) const;
  const File& file() const { return file_; }
  bool has(const std::string& field) const { return file_.has(field); }
  std::string text(const std::string& field) const { return file_.read_text(field); }
  std::vector<std::string> texts(const std::string& field) const;
  std::vector<int> integers(const std::string& field) const;
  std::vector<double> numbers(const std::string& field) const;
  Points points(const std::string& field) const;
  Triangles triangles(const std::string& field) const;
  SparseRows sparse(const std::string& field, Eigen::Index rows, Eigen::Index cols) const;
  // An array vertices x 3 x k as a matrix with 3 rows per vertex; no columns if the field is missing.
  Eigen::MatrixXd directions(const std::string& field, Eigen::Index vertices) const;

 private:
  std::vector<Eigen::Index> shape_of(const std::string& field, std::size_t rank) const;
  template <class T>
  std::vector<T> list(const std::string& field, hid_t type) const;
  template <class Matrix>
  Matrix rows_of_three(const std::string& field, hid_t type) const;
  FileForm form_;
  File file_;
};

void write_integers(const File&, const std::string& name, const std::vector<int>&);
void write_numbers(const File&, const std::string& name, const std::vector<double>&);
void write_points(const File&, const std::string& name, const Points&);
void write_triangles(const File&, const std::string& name, const Triangles&);
void write_sparse(const File&, const std::string& name, const SparseRows&);
void write_directions(const File&, const std::string& name, const Eigen::MatrixXd&);

// Throws Error if the name given to --out does not end in .h5, by which readers recognise our formats.
void check_out_name(const std::filesystem::path& out, const std::string& nouns);

// Writes a file of that format to a file beside it, then renames it; `fields` writes the fields after `format`. Several
// processes may write the same file, as they do in the cache; the last one wins.
void write_form(const std::filesystem::path&, const FileForm&, const std::function<void(const File&)>& fields);

}  // namespace selvedge::h5
