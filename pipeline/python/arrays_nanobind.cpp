#include "pipeline/python/arrays_nanobind.hpp"

#include <nanobind/stl/string.h>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "physics/scene/scene_numbers.hpp"
#include "pipeline/formats/seam_places.hpp"
#include "pipeline/shapes/outward_mesh.hpp"

namespace selvedge {
namespace {

namespace nb = nanobind;

std::string text_of(const nb::object& value) { return nb::str(value).c_str(); }

// The array as numpy makes it of any sequence, in one piece, with so many dimensions. `kinds` are the letters of dtypes
// that it may have, `shape` says for people which shape it has to have.
nb::object as_array(const nb::handle& array, const char* type, const char* kinds, int dimensions, const char* shape,
                    const std::string& where) {
  const nb::module_ numpy = nb::module_::import_("numpy");
  nb::object given;
  try {
    given = numpy.attr("asarray")(array);
  } catch (const nb::python_error&) {
    throw Error("is no array", where, std::string("give an array of ") + shape);
  }
  if (nb::hasattr(array, "mask") && PyObject_IsTrue(nb::object(numpy.attr("any")(array.attr("mask"))).ptr()) == 1)
    throw Error("has masked values", where, "give an array without a mask");
  const std::string kind = nb::cast<std::string>(given.attr("dtype").attr("kind"));
  const bool empty = nb::cast<std::size_t>(given.attr("size")) == 0;  // which numpy takes for float64
  if (!empty && std::string(kinds).find(kind) == std::string::npos)
    throw Error("has the type " + text_of(given.attr("dtype")), where, std::string("give an array of ") + type);
  const bool threes = shape[std::char_traits<char>::length(shape) - 1] == '3';
  if (nb::cast<int>(given.attr("ndim")) != dimensions ||
      (threes && nb::cast<Eigen::Index>(given.attr("shape")[nb::int_(-1)]) != 3))
    throw Error("has the shape " + text_of(given.attr("shape")), where, std::string("give ") + shape);
  return numpy.attr("ascontiguousarray")(given, type);
}

nb::object as_rows(const nb::handle& array, const char* type, const char* kinds, const std::string& where) {
  return as_array(array, type, kinds, 2, "rows of three, n x 3", where);
}

bool is_mask(const nb::handle& array) {
  const nb::object given = nb::module_::import_("numpy").attr("asarray")(array);
  return nb::cast<std::string>(given.attr("dtype").attr("kind")) == "b";
}

// An array of numpy's that owns its numbers; Array has data().
template <class Number, class Array>
nb::object copied(const Array& array, std::initializer_list<std::size_t> shape) {
  auto* own = new Array(array);
  const nb::capsule owner(own, [](void* p) noexcept { delete static_cast<Array*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, Number>(own->data(), shape, owner));
}

std::size_t count(Eigen::Index rows) { return static_cast<std::size_t>(rows); }

}  // namespace

Points points_of(const nb::handle& array, const std::string& where, NotFinite not_finite) {
  const nb::object rows = as_rows(array, "float64", "fiu", where);
  const auto view = nb::cast<nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>>(rows);
  Points points = Eigen::Map<const Points>(view.data(), static_cast<Eigen::Index>(view.shape(0)), 3);
  if (not_finite == NotFinite::refused) check_positions(points, where);
  return points;
}

Triangles triangles_of(const nb::handle& array, Eigen::Index vertices, const std::string& where) {
  const nb::object rows = as_rows(array, "int64", "iu", where);
  const auto view = nb::cast<nb::ndarray<const std::int64_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>>(rows);
  Triangles triangles(static_cast<Eigen::Index>(view.shape(0)), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (Eigen::Index k = 0; k < 3; ++k) {
      const std::int64_t v = view(static_cast<std::size_t>(t), static_cast<std::size_t>(k));
      if (v < 0 || v >= vertices)
        throw Error("names vertex " + std::to_string(v) + " in row " + std::to_string(t) + ", there are " +
                        std::to_string(vertices),
                    where, "number vertices from 0");
      triangles(t, k) = static_cast<int>(v);
    }
  return triangles;
}

std::vector<int> vertices_of(const nb::handle& array, Eigen::Index vertices, const std::string& where) {
  nb::object list = as_array(array, "int64", "iub", 1, "a list of vertices", where);
  if (is_mask(array)) {
    if (static_cast<Eigen::Index>(nb::len(list)) != vertices)
      throw Error("is a mask of " + std::to_string(nb::len(list)) + " vertices, there are " + std::to_string(vertices),
                  where, "give a bool a vertex, or a list of vertices");
    list = nb::module_::import_("numpy").attr("flatnonzero")(list);
  }
  const auto view = nb::cast<nb::ndarray<const std::int64_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>>(list);
  std::vector<int> all;
  for (std::size_t k = 0; k < view.shape(0); ++k) {
    if (view(k) < 0 || view(k) >= vertices)
      throw Error("names vertex " + std::to_string(view(k)) + ", there are " + std::to_string(vertices), where,
                  "number vertices from 0");
    all.push_back(static_cast<int>(view(k)));
  }
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

Eigen::MatrixXd matrix_of(const nb::handle& array, const std::string& where) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const nb::object given = as_array(array, "float64", "fiu", 2, "a matrix", where);
  const auto view = nb::cast<nb::ndarray<const double, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>>(given);
  return Eigen::Map<const RowMajor>(view.data(), static_cast<Eigen::Index>(view.shape(0)),
                                    static_cast<Eigen::Index>(view.shape(1)));
}

std::vector<Points> frames_of(const nb::handle& array, const std::string& where) {
  const nb::object given = as_array(array, "float64", "fiu", 3, "frames x n x 3", where);
  const auto view = nb::cast<nb::ndarray<const double, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>>(given);
  std::vector<Points> frames;
  for (std::size_t f = 0; f < view.shape(0); ++f)
    frames.push_back(
        Eigen::Map<const Points>(view.data() + f * view.shape(1) * 3, static_cast<Eigen::Index>(view.shape(1)), 3));
  return frames;
}

nb::list list_of(const nb::handle& items, const std::string& where, const std::string& cure) {
  PyObject* list = PySequence_List(items.ptr());
  if (list) return nb::steal<nb::list>(list);
  if (!PyErr_ExceptionMatches(PyExc_TypeError)) throw nb::python_error();
  PyErr_Clear();
  throw Error("is no list", where, cure);
}

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 1) < 0) throw nb::python_error();
}

WeldedSurface closed_outward(const std::string& name, Points& x, Triangles triangles) {
  if (x.rows() == 0 || triangles.rows() == 0 || !x.allFinite())
    return {make_surface(static_cast<int>(x.rows()), triangles), {}};
  std::vector<std::string> warnings;
  turn_outward(name, {}, {&x, 1}, seam_places({&x, 1}, triangles), triangles, warnings);
  warn(warnings);
  return closed_surface({&x, 1}, triangles);
}

nb::ndarray<nb::numpy, double, nb::shape<-1, 3>> view_of(Points& points, const nb::handle& owner) {
  return {points.data(), {static_cast<std::size_t>(points.rows()), 3}, owner};
}

nb::object copy_of(const Points& points) { return copied<double>(points, {count(points.rows()), 3}); }
nb::object copy_of(const Triangles& triangles) { return copied<int>(triangles, {count(triangles.rows()), 3}); }
nb::object copy_of(const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>& values) {
  return copied<double>(values, {count(values.rows()), 2});
}
nb::object copy_of(const Eigen::VectorXd& values) { return copied<double>(values, {count(values.size())}); }
nb::object copy_of(const std::vector<int>& values) { return copied<int>(values, {values.size()}); }

}  // namespace selvedge
