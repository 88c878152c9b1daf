#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <string>
#include <vector>

#include "collision/geometry/welded_surface.hpp"

namespace selvedge {

// An array that numpy has, as points, n x 3 [m]. Throws Error that says `where` for another shape, for what is no
// number, and for numbers that are not finite unless they are allowed.
enum class NotFinite { refused, allowed };
Points points_of(const nanobind::handle& array, const std::string& where, NotFinite = NotFinite::refused);

// The same of vertex indices, m x 3 whole numbers of 0 .. vertices - 1.
Triangles triangles_of(const nanobind::handle& array, Eigen::Index vertices, const std::string& where);

// A list of some of 0 .. vertices - 1, or a mask of them: a bool a vertex. As these ascending, each once. Throws Error
// for others.
std::vector<int> vertices_of(const nanobind::handle& array, Eigen::Index vertices, const std::string& where);

// A matrix of numbers, which may be anything; rows of three for each of several frames. Both throw Error for other
// shapes and for what is no number.
Eigen::MatrixXd matrix_of(const nanobind::handle& array, const std::string& where);
std::vector<Points> frames_of(const nanobind::handle& array, const std::string& where);

// What Python can go through, such as a tuple or a generator, as a list. Throws Error with the cure for other objects.
nanobind::list list_of(const nanobind::handle& items, const std::string& where, const std::string& cure);

// As Python's UserWarning, one each. Throws what Python raises where its filters make errors of warnings.
void warn(const std::vector<std::string>& warnings);

// A body or an obstacle of arrays as one of a file: its closed shells face outwards (outward_mesh.hpp), its seams are
// closed (seam_places.hpp), and their vertices are moved together. Warns as `warn` does.
WeldedSurface closed_outward(const std::string& name, Points& x, Triangles);

// A view of points that `owner` holds: numpy reads and writes them where they are, and keeps the owner alive.
nanobind::ndarray<nanobind::numpy, double, nanobind::shape<-1, 3>> view_of(Points&, const nanobind::handle& owner);

// A copy that numpy owns.
nanobind::object copy_of(const Points&);
nanobind::object copy_of(const Triangles&);
nanobind::object copy_of(const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>&);
nanobind::object copy_of(const Eigen::VectorXd&);
nanobind::object copy_of(const std::vector<int>&);

}  // namespace selvedge
