#pragma once

#include <array>
#include <optional>
#include <vector>

#include "collision/penetration/clipped_faces.hpp"

namespace selvedge {

// Where a contour goes on beyond its last point. rim: round a hole. plane: straight, where a plane cuts the surface.
// middles: along the shortest strip of faces, through the middles of edges.
enum class ClosingWay { rim, plane, middles };

// How a contour between two garments is closed that ends at their rims, because fans meet only their own garment. On
// each garment's surface it goes on from its last point to its first; triangles between both ways, with a corner at the
// middle of these two points, close what lies between the surfaces.
struct ContourClosing {
  struct Way {
    ClosingWay kind = ClosingWay::plane;
    std::vector<CurvePoint> points;  // from the contour's last to its first, both with it
    std::array<int, 2> end_faces{};  // the contour's last and first triangle on this side
    int times = 0;                   // of its triangles (middle, point, next point) in the region's surface
  };
  std::array<Way, 2> ways;  // by side of the contour
};

// If both ends are at one closed hole, the cloth round the hole has gone through the other garment: on its own surface
// the contour goes on along the shorter way round the rim, on the other one back from end to end. If one end is at a
// rim of each garment, it goes back on both. That is in a plane through both ends that stands on the surfaces that it
// cuts (up_of_plane is in it), or, where this meets a hole or is longer than twice the contour, through the middles of
// edges; so there always is a way, for the contour is one. Nothing for other contours, or for one at two holes of one
// garment. Else appends the curves of both sides, and to the crossings where ways cut edges (their `face` is -1).
std::optional<ContourClosing> close_open_contour(const ClosedSurface&, const Points& closed_x, const Contour&,
                                                 int number, std::vector<Crossing>& crossings,
                                                 std::vector<SurfaceCurve>& curves);

// The sum of the unit normals of the surfaces that the plane cuts, each the mean of those at the contour's ends.
Vec3 up_of_plane(const ClosedSurface&, const Points& closed_x, const ContourClosing&);

// The part of a region's volume that the closing's triangles have, seen from `centre` [m^3].
double closing_volume(const ClosedSurface&, const Points& closed_x, const std::vector<Crossing>&, const ContourClosing&,
                      const Vec3& centre);

// Adds `scale` times the flux through the triangles as the closed positions move them: crossings stay where edges and
// faces meet, cuts in their plane. With what the moving surfaces add, it is the region's exact derivative.
void add_closing_flux(const ClosedSurface&, const Points& closed_x, const std::vector<Crossing>&, const ContourClosing&,
                      double scale, Points& gradient);

}  // namespace selvedge
