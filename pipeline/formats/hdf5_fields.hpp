#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/SparseCore>

#include "collision/geometry/points.hpp"
#include "pipeline/formats/hdf5_handles.hpp"

namespace selvedge::h5 {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

// What a form of ours is called in its files, and the page that describes it.
struct FileForm {
  std::string format;  // text of the field `format`
  std::string noun;    // body, garment
  std::string page;    // docs/bodies.md
};

// Fields of a file in one of our forms. What is missing, or of another shape, throws Error that names file, field and
// page.
class Fields {
 public:
  Fields(const std::filesystem::path&, FileForm);

  [[noreturn]] void fail(const std::string& field, const std::string& what) const;
  bool has(const std::string& field) const { return file_.has(field); }
  std::string text(const std::string& field) const { return file_.read_text(field); }
  std::vector<std::string> texts(const std::string& field) const;
  std::vector<int> integers(const std::string& field) const;
  std::vector<double> numbers(const std::string& field) const;
  Points points(const std::string& field) const;
  Triangles triangles(const std::string& field) const;
  SparseRows sparse(const std::string& field, Eigen::Index rows, Eigen::Index cols) const;
  // An array vertices x 3 x k as a matrix of 3 rows a vertex; of no columns where the field is missing.
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
void write_sparse(const File&, const std::string& name, const SparseRows&);
void write_directions(const File&, const std::string& name, const Eigen::MatrixXd&);

// Throws Error for a name of an option --out that does not end in .h5, by which readers know our forms.
void check_out_name(const std::filesystem::path& out, const std::string& nouns);

// A file of that form, written beside and renamed: `fields` writes what comes after `format`. Several processes may
// write the same file, as they do in the cache: it is the last one's.
void write_form(const std::filesystem::path&, const FileForm&, const std::function<void(const File&)>& fields);

}  // namespace selvedge::h5
