#include "collision/penetration/open_contours.hpp"

namespace selvedge {
namespace {

// The sum of twice the vector areas at both ends of a path.
Vec3 normal_of(const ClosedSurface& closed, const Points& x, const ContourClosing::Path& path) {
  return turned_normal(closed, x, path.end_faces[0]) + turned_normal(closed, x, path.end_faces[1]);
}

// The sign of a side's normal in the sum: -1 for side 1 if the normals are more than a right angle apart, since the
// orientation of a garment means nothing here.
double sense_of(const ClosedSurface& closed, const Points& x, const ContourClosing& closing, int side) {
  const bool against = normal_of(closed, x, closing.paths[0]).dot(normal_of(closed, x, closing.paths[1])) < 0;
  return side == 1 && against ? -1 : 1;
}

class MovingClosing {
 public:
  MovingClosing(const ClosedSurface& closed, const Points& x, const std::vector<Crossing>& crossings,
                const ContourClosing& closing, Points& gradient)
      : closed_(closed),
        surface_(closed.surface),
        x_(x),
        crossings_(crossings),
        closing_(closing),
        gradient_(gradient),
        up_(up_of_plane(closed, x, closing)) {
    from_ = closing.paths[0].points.front();
    to_ = closing.paths[0].points.back();
    middle_ = (at(from_) + at(to_)) / 2;
  }

  void pull(const ContourClosing::Path& path, double scale) {
    for (std::size_t k = 0; k + 1 < path.points.size(); ++k) {
      const CurvePoint a = path.points[k], b = path.points[k + 1];
      const Vec3 share = (scale * path.times / 6) * (at(a) - middle_).cross(at(b) - middle_);
      pull_end(from_, share / 2);
      pull_end(to_, share / 2);
      pull_point(path.kind, a, share);
      pull_point(path.kind, b, share);
    }
  }

 private:
  Vec3 at(CurvePoint point) const { return position_of(surface_, x_, crossings_, point); }

  // Adds the derivative through a crossing, which slides along its edge as its face moves.
  void pull_end(CurvePoint point, const Vec3& by) {
    const Crossing& c = crossings_[point];
    const Vec3 normal = turned_normal(closed_, x_, c.face);
    const int low = surface_.edges(c.edge, 0), high = surface_.edges(c.edge, 1);
    const Vec3 along = row(x_, high) - row(x_, low);
    const double rise = normal.dot(along);
    const Vec3 by_face = rise == 0 ? Vec3(Vec3::Zero()) : Vec3((by.dot(along) / rise) * normal);
    gradient_.row(low) += (1 - c.s) * (by - by_face).transpose();
    gradient_.row(high) += c.s * (by - by_face).transpose();
    for (int k = 0; k < 3; ++k) gradient_.row(surface_.triangles(c.face, k)) += c.weight[k] * by_face.transpose();
  }

  void pull_point(ClosingKind kind, CurvePoint point, const Vec3& by) {
    if (point == from_ || point == to_) {
      pull_end(point, by);
    } else if (point < 0) {
      gradient_.row(~point) += by.transpose();
    } else if (kind == ClosingKind::plane) {
      pull_cut(point, by);
    } else {
      const Crossing& c = crossings_[point];
      gradient_.row(surface_.edges(c.edge, 0)) += (1 - c.s) * by.transpose();
      gradient_.row(surface_.edges(c.edge, 1)) += c.s * by.transpose();
    }
  }

  // Adds the derivative through a point where the plane cuts an edge: the plane moves with both ends of the contour and
  // `up_`.
  void pull_cut(CurvePoint point, const Vec3& by) {
    const Vec3 along = at(to_) - at(from_), place = at(point) - at(from_), normal = along.cross(up_);
    const double square = normal.squaredNorm();
    if (square == 0) return;
    const double ahead = place.cross(up_).dot(normal) / square, above = along.cross(place).dot(normal) / square;
    pull_end(from_, (1 - ahead) * by);
    pull_end(to_, ahead * by);
    for (int side = 0; side < 2; ++side)
      if (closing_.paths[side].kind == ClosingKind::plane)
        pull_up(closing_.paths[side], above * sense_of(closed_, x_, closing_, side) * by);
  }

  void pull_up(const ContourClosing::Path& path, const Vec3& by) {
    const Vec3 normal = normal_of(closed_, x_, path);
    const double length = normal.norm();
    if (length == 0) return;  // faces have no area, or normals cancel: `up` is not defined
    const Vec3 unit = normal / length, across = (by - unit * unit.dot(by)) / length;
    for (const int face : path.end_faces) {
      const int a = surface_.triangles(face, 0), b = surface_.triangles(face, 1), c = surface_.triangles(face, 2);
      const Vec3 first = row(x_, b) - row(x_, a), second = row(x_, c) - row(x_, a),
                 turned = closed_.turn[face] * across;
      const Vec3 by_b = second.cross(turned), by_c = turned.cross(first);
      gradient_.row(b) += by_b.transpose();
      gradient_.row(c) += by_c.transpose();
      gradient_.row(a) -= (by_b + by_c).transpose();
    }
  }

  const ClosedSurface& closed_;
  const Surface& surface_;
  const Points& x_;
  const std::vector<Crossing>& crossings_;
  const ContourClosing& closing_;
  Points& gradient_;
  Vec3 up_;
  CurvePoint from_ = 0, to_ = 0;
  Vec3 middle_;
};

}  // namespace

Vec3 up_of_plane(const ClosedSurface& closed, const Points& x, const ContourClosing& closing) {
  Vec3 up = Vec3::Zero();
  for (int side = 0; side < 2; ++side)
    if (closing.paths[side].kind == ClosingKind::plane)
      up += sense_of(closed, x, closing, side) * normal_of(closed, x, closing.paths[side]).normalized();
  return up;
}

double closing_volume(const ClosedSurface& closed, const Points& x, const std::vector<Crossing>& crossings,
                      const ContourClosing& closing, const Vec3& centre) {
  const auto at = [&](CurvePoint point) { return Vec3(position_of(closed.surface, x, crossings, point) - centre); };
  double volume = 0;
  for (const ContourClosing::Path& path : closing.paths) {
    const Vec3 middle = (at(path.points.front()) + at(path.points.back())) / 2;
    for (std::size_t k = 0; k + 1 < path.points.size(); ++k)
      volume += path.times / 6.0 * middle.dot(at(path.points[k]).cross(at(path.points[k + 1])));
  }
  return volume;
}

void add_closing_flux(const ClosedSurface& closed, const Points& x, const std::vector<Crossing>& crossings,
                      const ContourClosing& closing, double scale, Points& gradient) {
  MovingClosing moving(closed, x, crossings, closing, gradient);
  for (const ContourClosing::Path& path : closing.paths) moving.pull(path, scale);
}

}  // namespace selvedge
