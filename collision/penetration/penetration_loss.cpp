#include "collision/penetration/penetration_loss.hpp"

#include <cmath>

#include "collision/geometry/corners.hpp"

namespace selvedge {
namespace {

// Patches whose crossings have fixed weights.
class FrozenPatches {
 public:
  FrozenPatches(const ClosedSurface& closed, const Points& x, const std::vector<Crossing>& crossings, bool on_face)
      : closed_(closed), surface_(closed.surface), x_(x), crossings_(crossings), on_face_(on_face) {}

  Vec3 at(CurvePoint point) const {
    if (point < 0 || !is_on_face(point)) return position_of(surface_, x_, crossings_, point);
    return weighted_corners(surface_, x_, crossings_[point].face, crossings_[point].weight);
  }
  void pull(CurvePoint point, const Vec3& by, Points& gradient) const {
    if (point < 0) {
      gradient.row(~point) += by.transpose();
      return;
    }
    const Crossing& c = crossings_[point];
    if (is_on_face(point)) {
      for (int k = 0; k < 3; ++k) gradient.row(surface_.triangles(c.face, k)) += c.weight[k] * by.transpose();
      return;
    }
    gradient.row(surface_.edges(c.edge, 0)) += (1 - c.s) * by.transpose();
    gradient.row(surface_.edges(c.edge, 1)) += c.s * by.transpose();
  }
  // Twice the vector area of a face, with its turn.
  Vec3 normal(int face) const { return turned_normal(closed_, x_, face); }
  int turn(int face) const { return closed_.turn[face]; }
  Vec3 corner(int face, int k) const { return row(x_, surface_.triangles(face, k)); }

  // Mean of the ends of the pieces of one face: the apex of the face's fan.
  Vec3 apex(std::span<const ClippedPiece> pieces) const {
    Vec3 sum = Vec3::Zero();
    for (const ClippedPiece& piece : pieces) sum += at(piece.from) + at(piece.to);
    return sum / (2.0 * static_cast<double>(pieces.size()));
  }
  void pull_apex(std::span<const ClippedPiece> pieces, const Vec3& by, Points& gradient) const {
    const Vec3 share = by / (2.0 * static_cast<double>(pieces.size()));
    for (const ClippedPiece& piece : pieces) {
      pull(piece.from, share, gradient);
      pull(piece.to, share, gradient);
    }
  }

 private:
  bool is_on_face(CurvePoint point) const { return on_face_ && crossings_[point].face >= 0; }

  const ClosedSurface& closed_;
  const Surface& surface_;
  const Points& x_;
  const std::vector<Crossing>& crossings_;
  bool on_face_;
};

// Calls visit(pieces) for the pieces of each face, which are contiguous.
template <class Visit>
void for_each_face(const std::vector<ClippedPiece>& pieces, const Visit& visit) {
  for (std::size_t first = 0, last = 0; first < pieces.size(); first = last) {
    while (last < pieces.size() && pieces[last].face == pieces[first].face) ++last;
    visit(std::span(pieces).subspan(first, last - first));
  }
}

// The derivative of saturated_volume.
double pressure_share(double volume, double saturation) {
  return saturation > 0 && volume > saturation ? saturation / volume : 1;
}

double exact_volume(const ClosedSurface& closed, const Points& x, const std::vector<Crossing>& crossings,
                    const FrozenPatches& patches, const PenetrationRegion& region,
                    const PenetrationLossOptions& options, Points* gradient) {
  const Triangles& corners = closed.surface.triangles;
  const double size = std::abs(region.volume), scale = 6 * options.weight;
  const double share = pressure_share(size, options.saturation);
  const double pull = (region.volume < 0 ? -scale : scale) * share;
  if (gradient)
    for (const ClippedFace& clipped : region.faces) {
      const Vec3 normal = patches.normal(clipped.face);
      for (int k = 0; k < 3; ++k)
        gradient->row(corners(clipped.face, k)) += (pull * clipped.moment[k]) * normal.transpose();
    }
  if (gradient && region.closing) add_closing_flux(closed, x, crossings, *region.closing, pull, *gradient);
  return scale * saturated_volume(size, options.saturation);
}

// The volume of the triangles that close an open contour, divided by `scale`.
double frozen_closing(const FrozenPatches& patches, const ContourClosing::Path& path, const Vec3& centre, double scale,
                      Points* gradient) {
  double volume = 0;
  const CurvePoint first = path.points.front(), last = path.points.back();
  const Vec3 middle = (patches.at(first) + patches.at(last)) / 2 - centre;
  for (std::size_t k = 0; k + 1 < path.points.size(); ++k) {
    const Vec3 p = patches.at(path.points[k]) - centre, q = patches.at(path.points[k + 1]) - centre;
    const double sixth = path.times / 6.0;
    volume += sixth * middle.dot(p.cross(q));
    if (!gradient) continue;
    patches.pull(path.points[k], scale * sixth * q.cross(middle), *gradient);
    patches.pull(path.points[k + 1], scale * sixth * middle.cross(p), *gradient);
    for (const CurvePoint end : {first, last}) patches.pull(end, scale * sixth / 2 * p.cross(q), *gradient);
  }
  return volume;
}

// `pull` times the present volume of the patches.
double pulled_volume(const FrozenPatches& patches, const Triangles& corners, const PenetrationRegion& region,
                     double pull, Points* gradient) {
  double volume = 0;
  for (const ClippedFace& clipped : region.faces) {
    if (!clipped.whole) continue;
    const int sense = patches.turn(clipped.face), second = sense > 0 ? 1 : 2, third = 3 - second;
    const double sixth = clipped.covered() / 3;
    const Vec3 p = patches.corner(clipped.face, 0) - region.centre,
               q = patches.corner(clipped.face, second) - region.centre,
               r = patches.corner(clipped.face, third) - region.centre;
    volume += sixth * p.dot(q.cross(r));
    if (!gradient) continue;
    gradient->row(corners(clipped.face, 0)) += (pull * sixth) * q.cross(r).transpose();
    gradient->row(corners(clipped.face, second)) += (pull * sixth) * r.cross(p).transpose();
    gradient->row(corners(clipped.face, third)) += (pull * sixth) * p.cross(q).transpose();
  }
  for_each_face(region.pieces, [&](std::span<const ClippedPiece> pieces) {
    const Vec3 apex = patches.apex(pieces), a = apex - region.centre;
    Vec3 by_apex = Vec3::Zero();
    for (const ClippedPiece& piece : pieces) {
      const Vec3 p = patches.at(piece.from) - region.centre, q = patches.at(piece.to) - region.centre;
      const double sixth = piece.times / 6.0;
      volume += sixth * a.dot(p.cross(q));
      if (!gradient) continue;
      by_apex += sixth * p.cross(q);
      patches.pull(piece.from, pull * sixth * q.cross(a), *gradient);
      patches.pull(piece.to, pull * sixth * a.cross(p), *gradient);
    }
    if (gradient) patches.pull_apex(pieces, pull * by_apex, *gradient);
  });
  if (region.closing)
    for (const ContourClosing::Path& path : region.closing->paths)
      volume += frozen_closing(patches, path, region.centre, pull, gradient);
  return pull * volume;
}

double frozen_volume(const FrozenPatches& patches, const Triangles& corners, const PenetrationRegion& region,
                     const PenetrationLossOptions& options, Points* gradient) {
  const double scale = 6 * options.weight, sense = region.volume < 0 ? -1 : 1;
  if (options.saturation == 0) return pulled_volume(patches, corners, region, sense * scale, gradient);
  const double size = pulled_volume(patches, corners, region, sense, nullptr);
  if (gradient) {
    const double share = pressure_share(size, options.saturation);
    pulled_volume(patches, corners, region, sense * scale * share, gradient);
  }
  return scale * saturated_volume(size, options.saturation);
}

double frozen_area(const FrozenPatches& patches, const Triangles& corners, const PenetrationRegion& region,
                   double scale, Points* gradient) {
  double area = 0;
  for (const ClippedFace& clipped : region.faces) {
    if (!clipped.whole) continue;
    const Vec3 a = patches.corner(clipped.face, 0);
    const Vec3 normal = (patches.corner(clipped.face, 1) - a).cross(patches.corner(clipped.face, 2) - a);
    const double length = normal.norm(), times = std::abs(clipped.covered());
    area += times * length;
    if (!gradient || length == 0) continue;
    for (int k = 0; k < 3; ++k) {
      const Vec3 across = patches.corner(clipped.face, (k + 1) % 3) - patches.corner(clipped.face, (k + 2) % 3);
      const Vec3 step = across.cross(normal / length);
      gradient->row(corners(clipped.face, k)) += (scale * times) * step.transpose();
    }
  }
  for_each_face(region.pieces, [&](std::span<const ClippedPiece> pieces) {
    const Vec3 a = patches.apex(pieces);
    Vec3 twice = Vec3::Zero();
    for (const ClippedPiece& piece : pieces)
      twice += piece.times * (patches.at(piece.from) - a).cross(patches.at(piece.to) - a);
    const double length = twice.norm();
    area += 0.5 * length;
    if (!gradient || length == 0) return;
    const Vec3 direction = (0.5 * scale / length) * twice;
    Vec3 by_apex = Vec3::Zero();
    for (const ClippedPiece& piece : pieces) {
      const Vec3 by_from = piece.times * (patches.at(piece.to) - a).cross(direction);
      const Vec3 by_to = piece.times * direction.cross(patches.at(piece.from) - a);
      by_apex -= by_from + by_to;
      patches.pull(piece.from, by_from, *gradient);
      patches.pull(piece.to, by_to, *gradient);
    }
    patches.pull_apex(pieces, by_apex, *gradient);
  });
  return scale * area;
}

}  // namespace

double saturated_volume(double volume, double saturation) {
  return saturation > 0 && volume > saturation ? saturation * (1 + std::log(volume / saturation)) : volume;
}

double penetration_loss(const ClosedSurface& closed, const Points& x, const Penetration& penetration,
                        const PenetrationLossOptions& options, Points* gradient) {
  if (gradient) *gradient = Points::Zero(closed.surface.vertex_count, 3);
  const bool is_area = options.measure == PenetrationMeasure::area;
  const FrozenPatches patches(closed, x, penetration.crossings, options.crossings == CrossingMotion::frozen_on_face);
  const Triangles& corners = closed.surface.triangles;
  double loss = 0;
  for (const PenetrationRegion& region : penetration.regions)
    if (is_area)
      loss += frozen_area(patches, corners, region, options.weight, gradient);
    else if (options.crossings == CrossingMotion::exact)
      loss += exact_volume(closed, x, penetration.crossings, patches, region, options, gradient);
    else
      loss += frozen_volume(patches, corners, region, options, gradient);
  return loss;
}

}  // namespace selvedge
