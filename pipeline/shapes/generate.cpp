#include "pipeline/shapes/generate.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

namespace selvedge {
namespace {

constexpr double jitter = 0.25;  // of the edge length: clearly irregular, yet no sliver after the flips

using TriangleList = std::vector<std::array<int, 3>>;

struct Row {
  std::vector<int> vertices;
  std::vector<double> u;
};

// Rows of equal length, cut quad by quad; if `closed` the last column is joined to the first.
TriangleList structured(int columns, int rows, bool closed, Triangulation triangulation) {
  TriangleList triangles;
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns + closed; ++i) {
      const int a = j * columns + i, b = j * columns + (i + 1) % columns;
      add_quad(triangles, a, b, b + columns, a + columns, cut_from_a(triangulation, i, j));
    }
  return triangles;
}

std::vector<bool> mask(Eigen::Index size, const std::vector<int>& vertices) {
  std::vector<bool> fixed(static_cast<std::size_t>(size), false);
  for (const int v : vertices) fixed[v] = true;
  return fixed;
}

// Rows at equal heights; every second one is shifted by half an edge and keeps its ends.
std::vector<Row> staggered_rows(const Vec2& size, int columns, int rows) {
  std::vector<Row> result;
  const double edge = size.x() / (columns - 1);
  int next = 0;
  for (int j = 0; j < rows; ++j) {
    Row row;
    const bool odd = j % 2 == 1;
    for (int i = 0; i < columns + odd; ++i) {
      const double u = odd ? std::min((columns - 1) * edge, std::max(0.0, (i - 0.5) * edge)) : i * edge;
      row.u.push_back(u - size.x() / 2);
      row.vertices.push_back(next++);
    }
    result.push_back(std::move(row));
  }
  return result;
}

std::vector<int> joined_sorted(std::initializer_list<const std::vector<int>*> lists) {
  std::vector<int> all;
  for (const std::vector<int>* list : lists) all.insert(all.end(), list->begin(), list->end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void add_rectangle_groups(Mesh& mesh, const std::vector<Row>& rows) {
  std::vector<int> left, right;
  for (const Row& row : rows) {
    left.push_back(row.vertices.front());
    right.push_back(row.vertices.back());
  }
  const std::vector<int>&bottom = rows.front().vertices, &top = rows.back().vertices;
  Eigen::Index center = 0;
  mesh.uv.rowwise().squaredNorm().minCoeff(&center);
  mesh.groups = {{"left", left},
                 {"right", right},
                 {"top", top},
                 {"bottom", bottom},
                 {"boundary", joined_sorted({&left, &right, &top, &bottom})},
                 {"center", {static_cast<int>(center)}},
                 {"top_left", {top.front()}},
                 {"top_right", {top.back()}},
                 {"bottom_left", {bottom.front()}},
                 {"bottom_right", {bottom.back()}}};
}

void lay_flat(Mesh& mesh) {
  mesh.x = Points::Zero(mesh.uv.rows(), 3);
  mesh.x.col(0) = mesh.uv.col(0);
  mesh.x.col(2) = -mesh.uv.col(1);
  mesh.uv_triangles = mesh.triangles;
}

std::vector<Row> straight_rows(const Vec2& size, int columns, int rows) {
  std::vector<Row> result(static_cast<std::size_t>(rows));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      result[j].vertices.push_back(j * columns + i);
      result[j].u.push_back(size.x() * i / (columns - 1) - size.x() / 2);
    }
  return result;
}

int ring_begin(int ring) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1); }

// Six sectors per ring; a sector of ring k has k vertices, and the strip between two rings is k quads and one triangle.
TriangleList disc_triangles(int rings, Triangulation triangulation) {
  TriangleList triangles;
  const auto vertex = [](int ring, int i) { return ring == 0 ? 0 : ring_begin(ring) + i % (6 * ring); };
  for (int k = 0; k < rings; ++k)
    for (int sector = 0; sector < 6; ++sector) {
      const int inner = sector * k, outer = sector * (k + 1);
      for (int i = 0; i < k; ++i)
        add_quad(triangles, vertex(k, inner + i), vertex(k + 1, outer + i), vertex(k + 1, outer + i + 1),
                 vertex(k, inner + i + 1), cut_from_a(triangulation, i, k));
      triangles.push_back({vertex(k, inner + k), vertex(k + 1, outer + k), vertex(k + 1, outer + k + 1)});
    }
  return triangles;
}

}  // namespace

void add_strip(std::vector<std::array<int, 3>>& triangles, std::span<const int> below, std::span<const double> u_below,
               std::span<const int> above, std::span<const double> u_above) {
  assert(below.size() == u_below.size() && above.size() == u_above.size() && !below.empty() && !above.empty());
  std::size_t i = 0, j = 0;
  while (i + 1 < below.size() || j + 1 < above.size()) {
    const bool along_below =
        j + 1 == above.size() || (i + 1 < below.size() && u_below[i] + u_below[i + 1] <= u_above[j] + u_above[j + 1]);
    if (along_below) {
      triangles.push_back({below[i], below[i + 1], above[j]});
      ++i;
    } else {
      triangles.push_back({below[i], above[j + 1], above[j]});
      ++j;
    }
  }
}

void add_quad(std::vector<std::array<int, 3>>& triangles, int a, int b, int c, int d, bool from_a) {
  if (from_a) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  } else {
    triangles.push_back({a, b, d});
    triangles.push_back({b, c, d});
  }
}

bool cut_from_a(Triangulation triangulation, int i, int j) {
  return triangulation != Triangulation::alternating || (i + j) % 2 == 0;
}

Points to_points(const std::vector<Vec3>& list) {
  Points x(static_cast<Eigen::Index>(list.size()), 3);
  for (std::size_t v = 0; v < list.size(); ++v) x.row(static_cast<Eigen::Index>(v)) = list[v].transpose();
  return x;
}

Triangles to_triangles(const std::vector<std::array<int, 3>>& list) {
  Triangles triangles(static_cast<Eigen::Index>(list.size()), 3);
  for (std::size_t t = 0; t < list.size(); ++t)
    triangles.row(static_cast<Eigen::Index>(t)) << list[t][0], list[t][1], list[t][2];
  return triangles;
}

Mesh make_rectangle(const Vec2& size, int columns, int rows, const SheetOptions& options) {
  assert(columns >= 2 && rows >= 2 && size.minCoeff() > 0);
  const bool unstructured = options.triangulation == Triangulation::unstructured;
  const std::vector<Row> lines =
      unstructured ? staggered_rows(size, columns, rows) : straight_rows(size, columns, rows);
  Mesh mesh;
  mesh.uv.resize(lines.back().vertices.back() + 1, 2);
  for (int j = 0; j < rows; ++j) {
    const Row& line = lines[j];
    for (std::size_t i = 0; i < line.u.size(); ++i)
      mesh.uv.row(line.vertices[i]) << line.u[i], size.y() * j / (rows - 1) - size.y() / 2;
  }
  add_rectangle_groups(mesh, lines);
  if (unstructured) {
    TriangleList triangles;
    for (std::size_t j = 0; j + 1 < lines.size(); ++j)
      add_strip(triangles, lines[j].vertices, lines[j].u, lines[j + 1].vertices, lines[j + 1].u);
    mesh.triangles = to_triangles(triangles);
    const double edge = std::min(size.x() / (columns - 1), size.y() / (rows - 1));
    make_unstructured(mesh.uv, mesh.triangles, mask(mesh.uv.rows(), mesh.groups[4].second), jitter * edge,
                      options.seed);
  } else {
    mesh.triangles = to_triangles(structured(columns, rows, false, options.triangulation));
  }
  lay_flat(mesh);
  return mesh;
}

void grade_rectangle(Mesh& mesh, const Vec2& size, int columns, int rows, const Vec2& grading) {
  // Of n spacings the k-th is q^k times the first, q^(n - 1) = grading; the same law holds between vertices.
  const auto graded = [](double u, int n, double ratio) {
    if (n < 2 || ratio == 1) return u;
    const double q = std::log(ratio) / (n - 1);
    return std::expm1(q * n * u) / std::expm1(q * n);
  };
  for (int i = 0; i < mesh.uv.rows(); ++i) {
    mesh.uv(i, 0) = size.x() * (graded(mesh.uv(i, 0) / size.x() + 0.5, columns - 1, grading.x()) - 0.5);
    mesh.uv(i, 1) = size.y() * (0.5 - graded(0.5 - mesh.uv(i, 1) / size.y(), rows - 1, grading.y()));
  }
  lay_flat(mesh);
}

Mesh make_disc(double radius, int rings, const SheetOptions& options) {
  assert(rings >= 1 && radius > 0);
  Mesh mesh;
  mesh.uv.resize(ring_begin(rings + 1), 2);
  mesh.uv.row(0).setZero();
  for (int k = 1; k <= rings; ++k)
    for (int i = 0; i < 6 * k; ++i) {
      const double angle = std::numbers::pi * i / (3 * k), r = radius * k / rings;
      mesh.uv.row(ring_begin(k) + i) << r * std::cos(angle), r * std::sin(angle);
    }
  mesh.triangles = to_triangles(disc_triangles(rings, options.triangulation));
  std::vector<int> rim(static_cast<std::size_t>(6 * rings));
  std::iota(rim.begin(), rim.end(), ring_begin(rings));
  if (options.triangulation == Triangulation::unstructured)
    make_unstructured(mesh.uv, mesh.triangles, mask(mesh.uv.rows(), rim), jitter * radius / rings, options.seed);
  mesh.groups = {{"boundary", rim}, {"center", {0}}};
  lay_flat(mesh);
  return mesh;
}

Mesh make_tube(double radius, double height, int around, int rows, const SheetOptions& options) {
  assert(around >= 6 && rows >= 2 && radius > 0 && height > 0);
  const bool unstructured = options.triangulation == Triangulation::unstructured;
  const double girth = 2 * std::numbers::pi * radius, edge = girth / around;
  Points2 uv(around * rows, 2);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < around; ++i)
      uv.row(j * around + i) << (i + (unstructured && j % 2 ? 0.5 : 0)) * edge, height * j / (rows - 1) - height / 2;
  Mesh mesh;
  mesh.triangles = to_triangles(structured(around, rows, true, options.triangulation));
  std::vector<int> bottom(static_cast<std::size_t>(around)), top(bottom.size());
  std::iota(bottom.begin(), bottom.end(), 0);
  std::iota(top.begin(), top.end(), around * (rows - 1));
  mesh.groups = {{"top", top}, {"bottom", bottom}, {"boundary", joined_sorted({&top, &bottom})}};
  if (unstructured)
    make_unstructured(uv, mesh.triangles, mask(uv.rows(), mesh.groups[2].second),
                      jitter * std::min(edge, height / (rows - 1)), options.seed, girth);
  mesh.x.resize(uv.rows(), 3);
  for (Eigen::Index v = 0; v < uv.rows(); ++v) {
    const double angle = uv(v, 0) / radius;
    mesh.x.row(v) << radius * std::sin(angle), uv(v, 1), radius * std::cos(angle);
  }
  return mesh;
}

}  // namespace selvedge
