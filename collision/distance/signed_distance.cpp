#include "collision/distance/signed_distance.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "collision/distance/pseudonormals.hpp"
#include "collision/distance/wide_kernels.hpp"
#include "collision/exact/inside.hpp"
#include "collision/geometry/distance.hpp"
#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

constexpr int chunk = 64;             // queries of one task
constexpr double undecided = 1e-9;    // least cosine between a pseudonormal and the direction to the point
constexpr double on_surface = 1e-12;  // of the surface's size: nearer points count as on the surface
constexpr double just_beside = 1e-9;  // of the surface's size

void check_finite(const Points& points, const std::string& what) {
  if (points.allFinite()) return;
  int first = 0;
  while (points.row(first).allFinite()) ++first;
  throw Error(what + " " + std::to_string(first) + " has an undefined coordinate", "signed distance",
              "look for the step that made it");
}

}  // namespace

DistanceField::DistanceField(const Surface& surface, BodyShape shape)
    : surface_(surface), shape_(shape), manifold_(is_closed_manifold(surface)), closed_(selvedge::is_closed(surface)) {
  if (surface.triangles.rows() == 0)
    throw Error("the surface has no triangles", "signed distance", "leave out bodies without a surface");
}

void DistanceField::move_to(const Points& x) {
  check_finite(x, "body vertex");
  x_ = x;
  triangle_boxes(surface_, x, x, 0, boxes_);
  const bool rebuilt = update(tree_, boxes_);
  if (rebuilt) wide_ = widen(tree_.bvh);
  if (!closed_) windings_ = make_winding_tree(tree_.bvh, surface_, x);
  if (shape_ == BodyShape::united) {
    if (rebuilt) find_parts(surface_, tree_.bvh, parts_);
    mark_quiet(surface_, x, tree_.bvh, parts_);
    exposed_ = find_exposed(surface_, x, tree_.bvh, parts_, [this](const Points& at) { return winds_round(at); });
  }
  refit(wide_, tree_.bvh, surface_, x, exposed_.hidden);
}

std::vector<char> DistanceField::winds_round(const Points& points) const {
  const int count = static_cast<int>(points.rows());
  std::vector<char> result(static_cast<std::size_t>(count));
  if (count == 0) return result;
  if (closed_) {
    const std::vector<int> winding = winding_numbers(surface_, x_, points);
    std::ranges::transform(winding, result.begin(), [](int number) { return number > 0; });
    return result;
  }
  const Box& box = tree_.bvh.nodes.front().box;  // outside of the hull the winding number is at most 1/2
#pragma omp parallel for schedule(dynamic, 16)
  for (int i = 0; i < count; ++i)
    result[i] = overlap(box, moving_point_box(row(points, i), row(points, i), 0)) &&
                selvedge::winds_round(windings_, tree_.bvh, surface_, x_, row(points, i));
  return result;
}

// Compares p with a triangle, or with its exposed pieces. Of equally near triangles the lowest counts.
void DistanceField::measure(const Vec3& p, int t, Nearest& best) const {
  const auto take = [&](const Vec3& a, const Vec3& b, const Vec3& c, int piece) {
    const Closest found = point_triangle(p, a, b, c);
    const bool inside_both = (found.weights.array() != 0).all() && (best.weights.array() != 0).all();
    const double apart = std::abs(found.squared_distance - best.squared_distance);
    const bool tie = inside_both && t != best.triangle && apart <= 1e-12 * best.squared_distance;
    if (tie) best.tie = true;
    if (found.squared_distance > best.squared_distance) return;
    if (found.squared_distance == best.squared_distance && t >= best.triangle) return;
    const Vec3 closest = -found.weights[1] * a - found.weights[2] * b - found.weights[3] * c;
    best = {found.squared_distance, t, closest, found.weights, piece, tie};
  };
  if (!exposed_.all_whole() && exposed_.kind[t] == ExposedFaces::Kind::cut) {
    const int at = exposed_.cut_place[t];
    for (int i = exposed_.piece_begin[at]; i < exposed_.piece_begin[at + 1]; ++i)
      take(exposed_.pieces[i][0], exposed_.pieces[i][1], exposed_.pieces[i][2], i);
  } else {
    take(row(x_, surface_.triangles(t, 0)), row(x_, surface_.triangles(t, 1)), row(x_, surface_.triangles(t, 2)), -1);
  }
}

// Measures the leaf's triangles, the nearest first.
void DistanceField::measure_leaf(const WideKernels& kernels, const Vec3& p, const float* at, double reach,
                                 const WideTree::Leaf& leaf, float& limit, Nearest& best) const {
  float squared[WideTree::width];
  for (unsigned left = kernels.triangles(leaf, at, limit, squared); left != 0;) {
    int i = std::countr_zero(left);
    for (unsigned rest = left & (left - 1); rest != 0; rest &= rest - 1)
      if (squared[std::countr_zero(rest)] < squared[i]) i = std::countr_zero(rest);
    left &= ~(1u << i);
    if (leaf.triangle[i] < 0) continue;
    if (squared[i] >= limit) return;
    const double before = best.squared_distance;
    measure(p, leaf.triangle[i], best);
    if (best.squared_distance < before) limit = search_limit(std::sqrt(best.squared_distance), reach);
  }
}

DistanceField::Nearest DistanceField::search(const Vec3& p, int start, std::vector<Waiting>& stack) const {
  Nearest best{std::numeric_limits<double>::infinity(), -1, Vec3::Zero(), Eigen::Vector4d::Zero(), -1, false};
  const Vec3 seen = p - wide_.origin;
  const float at[3] = {static_cast<float>(seen[0]), static_cast<float>(seen[1]), static_cast<float>(seen[2])};
  const double reach = wide_.extent + seen.norm();
  if (start >= 0 && (exposed_.all_whole() || exposed_.kind[start] != ExposedFaces::Kind::hidden))
    measure(p, start, best);
  float limit = search_limit(std::sqrt(best.squared_distance), reach), squared[WideTree::width];
  const WideKernels& kernels = wide_kernels();
  stack.assign(1, {0, 0});
  while (!stack.empty()) {
    const Waiting next = stack.back();
    stack.pop_back();
    if (next.squared >= limit) continue;
    if (next.child < 0) {
      measure_leaf(kernels, p, at, reach, wide_.leaves[~next.child], limit, best);
      continue;
    }
    const WideTree::Node& node = wide_.nodes[next.child];
    const auto bottom = static_cast<std::ptrdiff_t>(stack.size());
    for (unsigned found = kernels.boxes(node, at, limit, squared); found != 0; found &= found - 1) {
      const int i = std::countr_zero(found);
      stack.push_back({squared[i], node.child[i]});
      for (auto place = stack.end() - 1; place - stack.begin() > bottom && place[-1].squared < place->squared; --place)
        std::swap(place[-1], *place);  // keeps the nearest on top
    }
  }
  return best;
}

bool DistanceField::is_cut_near(int vertex) const {
  if (exposed_.all_whole()) return false;
  return std::ranges::any_of(surface_.triangles_of(vertex),
                             [&](int t) { return exposed_.kind[t] != ExposedFaces::Kind::whole; });
}

// Sets face, edge or vertex for a whole triangle, and returns the normal there; zero if it tells no side.
Vec3 DistanceField::place(const Nearest& near, SignedDistance& result) const {
  const int t = near.triangle;
  int zeros = 0, zero = 0, last = 0;
  for (int k = 0; k < 3; ++k) {
    if (near.weights[1 + k] == 0) {
      ++zeros;
      zero = k;
    } else {
      last = k;
    }
  }
  if (zeros == 0) return face_normal(surface_, x_, t);
  if (zeros == 1) {
    const int from = surface_.triangles(t, (zero + 1) % 3), to = surface_.triangles(t, (zero + 2) % 3);
    result.place = SurfacePlace::edge;
    result.along = (row(x_, to) - row(x_, from)).normalized();
    return edge_pseudonormal(surface_, x_, surface_.triangle_edges(t, (zero + 1) % 3));
  }
  const int vertex = surface_.triangles(t, last);
  result.place = SurfacePlace::vertex;
  return is_cut_near(vertex) ? Vec3::Zero() : vertex_pseudonormal(surface_, x_, vertex);
}

// The same for an exposed piece of a cut triangle. Sides of a piece inside the triangle's exposed part are no edges.
Vec3 DistanceField::place_on_piece(const Vec3& p, const Nearest& near, SignedDistance& result) const {
  const Vec3 normal = face_normal(surface_, x_, near.triangle), away = p - near.closest;
  if ((away - normal.dot(away) * normal).norm() <= 1e-7 * away.norm()) return normal;
  const ExposedFaces::Piece& corner = exposed_.pieces[near.piece];
  const auto zeros = (near.weights.array() == 0).count();
  result.place = zeros > 1 ? SurfacePlace::vertex : SurfacePlace::edge;
  for (int k = 0; k < 3; ++k)
    if (zeros == 1 && near.weights[1 + k] == 0) result.along = (corner[(k + 2) % 3] - corner[(k + 1) % 3]).normalized();
  return Vec3::Zero();
}

// False if the side is not known; the result then is that of a point outside.
bool DistanceField::complete(const Vec3& p, const Nearest& near, SignedDistance& result) const {
  result = {};
  result.triangle = near.triangle;
  result.closest = near.closest;
  const Vec3 normal = near.piece < 0 ? place(near, result) : place_on_piece(p, near, result);
  const Vec3 away = p - near.closest;
  const double distance = std::sqrt(near.squared_distance);
  result.value = distance;
  if (distance <= on_surface * wide_.extent) {
    result.value = 0;
    result.gradient = normal;
    return true;
  }
  const double side = normal.dot(away) / distance;
  const bool on_face = result.place == SurfacePlace::face && !normal.isZero(0);
  result.gradient = on_face ? (side < 0 ? Vec3(-normal) : normal) : Vec3(away / distance);
  if (!manifold_ || near.tie || std::abs(side) < undecided) return false;
  if (side < 0) {
    result.value = -result.value;
    result.gradient = -result.gradient;
  }
  return true;
}

// A point may lie on a hidden part of the surface, where winding numbers are not defined. So it is moved obliquely, by
// less than its distance from the exposed surface.
Vec3 DistanceField::beside(const Vec3& p, const SignedDistance& found) const {
  const double step = std::min(just_beside * wide_.extent, 0.2 * std::abs(found.value));
  return p + step * (found.gradient + Vec3(0.31, 0.47, 0.59));
}

void DistanceField::decide_sides(const Points& at, std::span<const char> open,
                                 std::vector<SignedDistance>& found) const {
  std::vector<int> points;
  for (int i = 0; i < static_cast<int>(open.size()); ++i)
    if (open[i]) points.push_back(i);
  if (points.empty()) return;
  Points moved = at(points, Eigen::all);
  for (std::size_t k = 0; k < points.size(); ++k)
    moved.row(static_cast<Eigen::Index>(k)) = beside(row(at, points[k]), found[points[k]]).transpose();
  const std::vector<char> inside = winds_round(moved);
  for (std::size_t k = 0; k < points.size(); ++k)
    if (inside[k]) {
      found[points[k]].value *= -1;
      found[points[k]].gradient *= -1;
    }
}

void DistanceField::ask(const Points& at, std::vector<int>& faces, std::vector<SignedDistance>& found) const {
  if (x_.rows() == 0) throw Error("the surface has no positions yet", "signed distance", "call move_to first");
  check_finite(at, "point");
  const int count = static_cast<int>(at.rows()), chunks = (count + chunk - 1) / chunk;
  if (static_cast<int>(faces.size()) != count) faces.assign(static_cast<std::size_t>(count), -1);
  found.resize(static_cast<std::size_t>(count));
  std::vector<char> open(static_cast<std::size_t>(count));
#pragma omp parallel for schedule(dynamic)
  for (int c = 0; c < chunks; ++c) {
    std::vector<Waiting> stack;
    int last = -1;  // consecutive points are often near each other
    for (int i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i) {
      const Nearest near = search(row(at, i), faces[i] >= 0 ? faces[i] : last, stack);
      open[i] = !complete(row(at, i), near, found[i]);
      faces[i] = last = near.triangle;
    }
  }
  decide_sides(at, open, found);
}

std::vector<SignedDistance> DistanceField::ask(const Points& at) const {
  std::vector<int> faces;
  std::vector<SignedDistance> found;
  ask(at, faces, found);
  return found;
}

}  // namespace selvedge
