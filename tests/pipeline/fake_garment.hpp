#pragma once

#include <cmath>
#include <numbers>
#include <numeric>

#include "collision/geometry/surface.hpp"
#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/garments/garment_hdf5.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "tests/pipeline/fake_run.hpp"

namespace selvedge::fake {

inline const BodyModel& mannequin() {
  static const BodyModel body = kept_mannequin(cache_folder());
  return body;
}

// A piece of a body's own surface, moved outward.
struct Piece {
  Points x;
  Triangles triangles;
  std::vector<int> from;  // the body's vertex of each vertex
};

// All triangles whose corners are in `chosen`, moved by `out` along the normals.
template <class Chosen>
Piece piece_of(const BodyModel& body, const Chosen& chosen, double out) {
  const Surface surface = make_surface(static_cast<int>(body.skin.rest.rows()), body.skin.triangles);
  const Points normals = vertex_normals(surface, body.skin.rest);
  std::vector<int> number(static_cast<std::size_t>(body.skin.rest.rows()), -1);
  std::vector<Eigen::RowVector3i> faces;
  Piece piece;
  for (Eigen::Index t = 0; t < body.skin.triangles.rows(); ++t) {
    Eigen::RowVector3i face = body.skin.triangles.row(t);
    if (!chosen(row(body.skin.rest, face[0])) || !chosen(row(body.skin.rest, face[1])) ||
        !chosen(row(body.skin.rest, face[2])))
      continue;
    for (int& corner : face) {
      int& n = number[static_cast<std::size_t>(corner)];
      if (n < 0) {
        n = static_cast<int>(piece.from.size());
        piece.from.push_back(corner);
      }
      corner = n;
    }
    faces.push_back(face);
  }
  piece.triangles.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t t = 0; t < faces.size(); ++t) piece.triangles.row(static_cast<Eigen::Index>(t)) = faces[t];
  piece.x = body.skin.rest(piece.from, Eigen::all) + out * normals(piece.from, Eigen::all);
  return piece;
}

// The trunk of the mannequin between two heights, without the arms.
inline Piece trunk(const BodyModel& body, double low, double high, double out) {
  return piece_of(
      body, [&](const Vec3& p) { return p.y() > low && p.y() < high && std::abs(p.x()) < 0.24; }, out);
}

// A skirt round the mannequin from `high` down to `low`. Its elliptic rings never get narrower and keep the distance
// `room` from the body. Vertices are in rings of `around`, the waist first.
inline Piece skirt(const BodyModel& body, double low, double high, double room, int around, int rings) {
  const Points& skin = body.skin.rest;
  Piece piece;
  piece.x.resize(around * rings, 3);
  Vec3 half = Vec3::Zero();  // of the ellipse
  const double step = (high - low) / (rings - 1);
  for (int r = 0; r < rings; ++r) {
    const double y = high - r * step;
    double wide = 0, deep = 0, most = 0;
    std::vector<int> near;
    for (int v = 0; v < skin.rows(); ++v)
      if (std::abs(skin(v, 1) - y) < step) near.push_back(v);
    for (const int v : near) wide = std::max(wide, std::abs(skin(v, 0))), deep = std::max(deep, std::abs(skin(v, 2)));
    for (const int v : near) most = std::max(most, std::hypot(skin(v, 0) / wide, skin(v, 2) / deep));
    half = half.cwiseMax(Vec3(most * wide + room, 0, most * deep + room));
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      piece.x.row(r * around + k) << half.x() * std::cos(angle), y, half.z() * std::sin(angle);
    }
  }
  piece.triangles.resize(2 * around * (rings - 1), 3);
  for (int r = 0; r + 1 < rings; ++r)
    for (int k = 0; k < around; ++k) {
      const int a = r * around + k, b = r * around + (k + 1) % around, c = a + around, d = b + around;
      piece.triangles.row(2 * (r * around + k)) << a, b, c;
      piece.triangles.row(2 * (r * around + k) + 1) << c, b, d;
    }
  return piece;
}

struct SkirtFile {
  double low = -0.3, room = 0.015;
  int around = 30, rings = 9;
  std::string file = "skirt.h5";
  BodyPose made_in = {};
};

// A skirt that hangs from its pinned waist; groups: waist, and the first vertex of the hem.
inline Garment write_skirt(const Folder& folder, const SkirtFile& s = {}) {
  const BodyModel& body = mannequin();
  const Piece piece = skirt(body, s.low, 0.1, s.room, s.around, s.rings);
  Garment made{"skirt", attached(piece.x, piece.triangles, body, Fit::loose), s.made_in, {}, {}, body.name};
  made.pins.resize(static_cast<std::size_t>(s.around));
  std::iota(made.pins.begin(), made.pins.end(), 0);
  made.groups = {{"waist", made.pins}, {"hem", {(s.rings - 1) * s.around}}};
  write_garment(folder.path / s.file, made);
  return made;
}

}  // namespace selvedge::fake
