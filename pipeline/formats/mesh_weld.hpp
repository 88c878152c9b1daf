#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/SparseCore>

#include "collision/geometry/welded_surface.hpp"
#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// The number of vertices at the place of a lower one (same_places.hpp).
int coincident_vertices(const Points& x);

// The number of triangles whose corners are at the places of an earlier one's, in any order.
int coincident_triangles(const Points& x, const Triangles&);

// Before vertices are joined: numbers[v] is the number that v gets. The look keeps the vertices and faces of the file.
void renumber_look(const std::vector<int>& numbers, Mesh&);

// What becomes of vertices that lie at the place of a lower one.
struct Welding {
  int joined = 0;  // become one with a lower one
  int apart = 0;   // stay: their pieces do not meet along an edge there, or an edge would get more than two triangles
  bool layered = false;  // along most of the edges the faces of both sides lie over each other: layers, or a fold
};

// The distance within which `weld` takes vertices for one where none is given: a thousandth of the mean edge, or a
// millionth of the bounding box's diagonal where that is more.
double weld_distance(const Points& x, const Triangles&);

// What `weld` without a distance would come to.
Welding weldable(const Points& x, const Triangles&);

// "the seams are not welded: --weld joins 312 vertices", and of layers, whose borders may meet on purpose, that it
// joins them if they are sewn there. `cure`: what joins them.
std::string unwelded_text(const Welding&, const std::string& cure);

// Joins the borders of pieces along the edges where exactly two triangles meet within a distance (in the mesh's own
// unit; default: weld_distance). A vertex becomes the lowest of those that it is joined with, and vertices are numbered
// anew in their order. Triangles that lose their area are removed and counted in a warning; vertices that have to stay
// apart are counted in another. `name` is the mesh's. Sets Mesh::welded. Throws Error for a distance above half the
// mean edge, and where triangles at one place would make an edge of more than two triangles.
Welding weld(Mesh&, const std::string& name, std::optional<double> distance = {});

// Joins each vertex into the one that stands for it, the lowest of its set, as `weld` does, without looking at edges.
void join_at(const std::vector<int>& stands_for, Mesh&, const std::string& name);

// Joins the same vertices in another mesh with the same vertices and faces.
void weld_as(const Mesh& welded, Mesh&);

using SkinWeightRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;  // of each vertex, the sum of a row is 1

// Of each vertex of a skinned surface the lowest one at its place, the lowest one near it (seam_places.hpp), and the
// part of the file that it is in.
struct SeamPlaces {
  std::vector<int> same, near, parts;
};

// Joins borders along edges where exactly two triangles meet: first vertices at one place that move alike, within parts
// and then everywhere, then those near each other that move alike, and at last those that do not: a head and a trunk
// that end in one ring are one surface. `joined` has every vertex, also where nothing was joined.
WeldedSurface closed_where_open(const Surface&, const SeamPlaces&, const SkinWeightRows&);

// Joins vertices of a skinned mesh that lie at one place and move alike, where the mesh is open: pieces that are closed
// may touch. `parts`: as of SeamPlaces; borders are joined as closed_where_open does it. `weights` are those of the
// vertices as read and of `joints`, above 0, at least one a vertex; their sums need not be 1. Returns the weights of
// the joined vertices, each of the lowest that it was made of, in rows that sum to 1.
SkinWeightRows join_alike(const std::vector<Eigen::Triplet<double>>& weights, Eigen::Index joints,
                          const std::vector<int>& parts, Mesh&, const std::string& name);

}  // namespace selvedge
