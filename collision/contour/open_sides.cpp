#include "collision/contour/open_sides.hpp"

#include <algorithm>
#include <cmath>

#include "collision/geometry/corners.hpp"
#include "collision/geometry/disjoint_sets.hpp"
#include "collision/search/nearest_face.hpp"

namespace selvedge {
namespace {

constexpr double parallel = 0.5;   // least cosine of the normals of layers that face each other
constexpr double agreeing = 0.75;  // share of crossed edges whose ends must be on different sides

bool parts_nothing(const Contour& contour) { return !contour.sides[0].cuts && !contour.sides[1].cuts; }

bool at_boundary(const Surface& surface, const NearestFace& near) {
  for (int k = 0; k < 3; ++k) {
    const int edge = surface.triangle_edges(near.face, k);
    if (surface.edge_triangles[edge][1] < 0 && near.weight[(k + 2) % 3] == 0) return true;
  }
  return false;
}

// One of two layers.
struct Layer {
  int sheet = 0, component = 0;
  const Surface* surface = nullptr;
  const Points* x = nullptr;
  Points normals;
  FaceTree faces;
  std::vector<double> votes;  // of crossed edges at each vertex
  std::vector<int> sector;    // of each vertex; -1: none
};

Layer make_layer(std::span<const SheetView> sheets, int sheet, int component) {
  const Surface& surface = *sheets[sheet].surface;
  const Points& x = *sheets[sheet].x;
  std::vector<int> faces;
  for (int t = 0; t < surface.triangles.rows(); ++t)
    if (surface.component[surface.triangles(t, 0)] == component) faces.push_back(t);
  return {sheet,
          component,
          &surface,
          &x,
          vertex_normals(surface, x),
          make_face_tree(surface, x, std::move(faces)),
          std::vector<double>(surface.vertex_count, 0.0),
          std::vector<int>(surface.vertex_count, -1)};
}

// side: 1 if the first layer is on the side to which the second layer's normals point, -1 if on the other.
struct Sector {
  int side = 0;
  int vertices = 0;
};

class Pair {
 public:
  Pair(std::span<const SheetView> sheets, const Segments& found, std::span<const Contour> contours,
       std::vector<int> numbers)
      : found_(found), contours_(contours), numbers_(std::move(numbers)) {
    const auto& sides = contours[numbers_.front()].sides;
    for (int k = 0; k < 2; ++k) layers_[k] = make_layer(sheets, sides[k].sheet, sides[k].component);
  }
  void decide(OpenSides&);

 private:
  template <class Visit>
  void for_each_edge(int number, Visit) const;
  void vote(int layer, const Crossing&);
  int facing_side(int layer, int vertex) const;
  int side_of(int layer, int vertex) const;
  void grow(int layer, int seed);
  void decide_set(std::span<const int> numbers, std::span<const char> in_set, OpenSides&) const;

  const Segments& found_;
  std::span<const Contour> contours_;
  std::vector<int> numbers_;
  std::array<Layer, 2> layers_;
  std::vector<Sector> sectors_;
};

// Calls visit(layer, crossing) for the crossed edges of a contour; layer is that of the edge.
template <class Visit>
void Pair::for_each_edge(int number, Visit visit) const {
  const Contour& contour = contours_[number];
  for (std::size_t i = 0; i < contour.points.size(); ++i) {
    if (contour.points[i] < 0) continue;
    const ContourSide& side = contour.sides[contour.point_side[i]];
    visit(side.sheet == layers_[0].sheet && side.component == layers_[0].component ? 0 : 1,
          found_.crossings[contour.points[i]]);
  }
}

// Lets both ends of a crossed edge vote for their side. Where the dot product of normals is small the layers cross
// steeply, and the vote counts little.
void Pair::vote(int k, const Crossing& c) {
  Layer &own = layers_[k], &other = layers_[1 - k];
  const Surface& surface = *other.surface;
  const Vec3 normal = twice_area(surface.triangles, *other.x, c.face).normalized();
  const Vec3 point = weighted_corners(surface, *other.x, c.face, c.weight);
  for (int end = 0; end < 2; ++end) {
    const int v = own.surface->edges(c.edge, end);
    const double along = normal.dot(row(own.normals, v)), side = normal.dot(row(*own.x, v) - point) > 0 ? 1 : -1;
    own.votes[v] += k == 0 ? std::abs(along) * side : -along * side;
  }
}

// The side of a vertex, as Sector::side; 0 if the vertex does not face the other layer.
int Pair::facing_side(int k, int v) const {
  const Layer &own = layers_[k], &other = layers_[1 - k];
  const NearestFace near = nearest_face(other.faces, -1, row(*own.x, v));
  if (near.face < 0 || at_boundary(*other.surface, near)) return 0;
  const Vec3 normal = weighted_corners(*other.surface, other.normals, near.face, near.weight).normalized();
  const double along = normal.dot(row(own.normals, v));
  if (!(std::abs(along) >= parallel)) return 0;
  const double height = normal.dot(row(*own.x, v) - weighted_corners(*other.surface, *other.x, near.face, near.weight));
  const double side = k == 0 ? height : -along * height;
  return side > 0 ? 1 : side < 0 ? -1 : 0;
}

int Pair::side_of(int k, int v) const {
  const double votes = layers_[k].votes[v];
  return votes > 0 ? 1 : votes < 0 ? -1 : facing_side(k, v);
}

void Pair::grow(int k, int seed) {
  Layer& layer = layers_[k];
  const int side = side_of(k, seed), number = static_cast<int>(sectors_.size());
  if (layer.sector[seed] >= 0 || side == 0) return;
  std::vector<int> reached{seed};
  layer.sector[seed] = number;
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const int t : layer.surface->triangles_of(reached[i]))
      for (const int v : layer.surface->triangles.row(t)) {
        if (layer.sector[v] >= 0 || side_of(k, v) != side) continue;
        layer.sector[v] = number;
        reached.push_back(v);
      }
  sectors_.push_back({side, static_cast<int>(reached.size())});
}

// Decides contours `numbers` together, with the sectors that reach them.
void Pair::decide_set(std::span<const int> numbers, std::span<const char> in_set, OpenSides& sides) const {
  int edges = 0, parted = 0;
  for (const int number : numbers)
    for_each_edge(number, [&](int k, const Crossing& c) {
      const Layer& layer = layers_[k];
      const int a = layer.sector[layer.surface->edges(c.edge, 0)], b = layer.sector[layer.surface->edges(c.edge, 1)];
      ++edges;
      parted += a >= 0 && b >= 0 && sectors_[a].side != sectors_[b].side;
    });
  std::array<int, 2> count{};
  for (std::size_t s = 0; s < sectors_.size(); ++s)
    if (in_set[s]) count[sectors_[s].side > 0] += sectors_[s].vertices;
  if (parted < agreeing * edges || count[0] == count[1]) return;
  const int wrong = count[1] < count[0] ? 1 : -1;
  for (const int number : numbers) sides.decided[number] = 1;
  for (int k = 0; k < 2; ++k) {
    const Layer &own = layers_[k], &other = layers_[1 - k];
    std::vector<int>& vertices = sides.wrong[{own.sheet, own.component, other.sheet, other.component}];
    for (int v = 0; v < own.surface->vertex_count; ++v)
      if (const int s = own.sector[v]; s >= 0 && in_set[s] && sectors_[s].side == wrong) vertices.push_back(v);
  }
}

void Pair::decide(OpenSides& sides) {
  for (const int number : numbers_) for_each_edge(number, [&](int k, const Crossing& c) { vote(k, c); });
  for (const int number : numbers_)
    for_each_edge(number, [&](int k, const Crossing& c) {
      for (int end = 0; end < 2; ++end) grow(k, layers_[k].surface->edges(c.edge, end));
    });
  const int count = static_cast<int>(sectors_.size());
  DisjointSets sets(count + static_cast<int>(numbers_.size()));  // sectors, then contours
  for (int i = 0; i < std::ssize(numbers_); ++i)
    for_each_edge(numbers_[i], [&](int k, const Crossing& c) {
      for (int end = 0; end < 2; ++end)
        if (const int s = layers_[k].sector[layers_[k].surface->edges(c.edge, end)]; s >= 0) sets.join(s, count + i);
    });
  std::map<int, std::vector<int>> together;
  for (int i = 0; i < std::ssize(numbers_); ++i) together[sets.root(count + i)].push_back(numbers_[i]);
  for (const auto& [root, numbers] : together) {
    if (std::ranges::none_of(numbers, [&](int number) { return parts_nothing(contours_[number]); })) continue;
    std::vector<char> in_set(sectors_.size(), 0);
    for (int s = 0; s < count; ++s) in_set[s] = sets.root(s) == root;
    decide_set(numbers, in_set, sides);
  }
}

}  // namespace

LayerPair layers_of(const Contour& contour, int side) {
  const ContourSide &own = contour.sides[side], &other = contour.sides[1 - side];
  return {own.sheet, own.component, other.sheet, other.component};
}

OpenSides open_sides(std::span<const SheetView> sheets, const Segments& found, std::span<const Contour> contours) {
  OpenSides sides{std::vector<char>(contours.size(), 0), {}};
  std::map<LayerPair, std::vector<int>> pairs;
  for (int c = 0; c < std::ssize(contours); ++c) {
    const LayerPair one = layers_of(contours[c], 0), other = layers_of(contours[c], 1);
    if (one != other) pairs[std::min(one, other)].push_back(c);
  }
  for (auto& [key, numbers] : pairs)
    if (std::ranges::any_of(numbers, [&](int c) { return parts_nothing(contours[c]); }))
      Pair(sheets, found, contours, std::move(numbers)).decide(sides);
  for (auto& [key, vertices] : sides.wrong) std::ranges::sort(vertices);
  return sides;
}

}  // namespace selvedge
