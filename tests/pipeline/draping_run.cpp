#include "tests/pipeline/draping_run.hpp"

#include <cmath>
#include <memory>

#include "physics/scene/make_scene.hpp"

namespace selvedge::fake {
namespace {

constexpr double radius = 0.3;
const Vec3 centre(0, 0.3, 0);

Triangles sheet_triangles(int n) {
  Triangles t(2 * (n - 1) * (n - 1), 3);
  for (int i = 0, k = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      const int a = i * n + j, b = a + 1, c = a + n, d = c + 1;
      t.row(k++) << a, c, b;
      t.row(k++) << b, c, d;
    }
  return t;
}

void ball(Points& x, Triangles& t) {
  const int rings = 24, around = 48;
  x.resize((rings + 1) * around, 3);
  t.resize(2 * rings * around, 3);
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double polar = M_PI * i / rings, turn = 2 * M_PI * j / around;
      x.row(i * around + j) =
          centre + radius * Vec3(std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn));
    }
  for (int i = 0, k = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const int a = i * around + j, b = i * around + (j + 1) % around;
      t.row(k++) << a, b, a + around;
      t.row(k++) << b, b + around, a + around;
    }
}

void hold_length(Points& x, const Points& rest, int a, int b) {
  if (b >= x.rows()) return;
  const Vec3 d = row(x, b) - row(x, a);
  const double wanted = (row(rest, b) - row(rest, a)).norm(), length = d.norm();
  const Vec3 correction = 0.5 * (1 - wanted / length) * d;
  x.row(a) += correction;
  x.row(b) -= correction;
}

std::vector<PointsF> fall(const Points& rest, int n, int frames) {
  std::vector<PointsF> out{rest.cast<float>()};
  Points x = rest, before = rest;
  const int substeps = 4;
  const double h = 1.0 / 30 / substeps;
  for (int f = 1; f < frames; ++f) {
    for (int s = 0; s < substeps; ++s) {
      Points next = x + 0.992 * (x - before);
      next.col(1).array() -= 9.81 * h * h;
      before = x;
      x = next;
      for (int pass = 0; pass < 12; ++pass) {
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < n; ++j) {
            if (j + 1 < n) hold_length(x, rest, i * n + j, i * n + j + 1);
            if (i + 1 < n) hold_length(x, rest, i * n + j, (i + 1) * n + j);
            if (i + 1 < n && j + 1 < n) hold_length(x, rest, i * n + j, (i + 1) * n + j + 1);
            if (i + 1 < n && j > 0) hold_length(x, rest, i * n + j, (i + 1) * n + j - 1);
          }
        for (int v = 0; v < x.rows(); ++v) {
          const Vec3 d = row(x, v) - centre;
          if (d.norm() >= radius + 0.004) continue;
          x.row(v) = centre + (radius + 0.004) * d.normalized();
          before.row(v) += 0.5 * (x.row(v) - before.row(v));
        }
      }
    }
    out.push_back(x.cast<float>());
  }
  return out;
}

}  // namespace

ViewRun draping_run(const std::string& name, int n, int frames) {
  Points rest(n * n, 3), ball_points;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      rest.row(i * n + j) << j / (n - 1.0) - 0.45, 0.75 + 1e-3 * std::sin(7 * i + 3 * j), i / (n - 1.0) - 0.52;
  ViewRun run{name, {}, frames, {}};
  TrajectoryInfo& info = run.info;
  info.program_version = "0.1.0";
  info.stepper = "conventional";
  info.cloth_names = {"cloth"};
  info.triangles = sheet_triangles(n);
  info.cloth_first_vertex = {0, n * n};
  info.cloth_first_triangle = {0, static_cast<int>(info.triangles.rows())};
  info.rest = rest;
  info.rest_triangle = flattened(rest, info.triangles);
  TrajectoryInfo::Body body{"ball", {}, 0, false};
  ball(ball_points, body.triangles);
  body.vertex_count = static_cast<int>(ball_points.rows());
  info.obstacles.push_back(body);

  const auto positions = std::make_shared<std::vector<PointsF>>(fall(rest, n, frames));
  run.frame = [positions, ball_points](int index) {
    Frame f;
    f.time = index / 30.0;
    f.x = (*positions)[index];
    f.obstacles = {ball_points.cast<float>()};
    f.report.by = "conventional";
    f.report.collision.contacts = 13 * index;
    const double fallen = 1 - std::exp(-index / 12.0);
    f.energy = {1.4 * std::exp(-std::pow((index - 9) / 6.0, 2)), 2.2 - 1.1 * fallen, 0.22 * fallen, 0.015 * fallen};
    f.seconds = 0.02 + 0.03 * fallen + 0.004 * std::sin(1.7 * index);
    f.max_stretch = 1 + 0.05 * fallen;
    f.min_stretch = 1 - 0.2 * fallen;
    return f;
  };
  return run;
}

}  // namespace selvedge::fake
