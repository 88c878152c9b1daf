#pragma once

#include <array>
#include <optional>
#include <vector>

#include "collision/penetration/clipped_faces.hpp"

namespace selvedge {

// How a contour is continued beyond its last point. rim: round a hole. plane: straight, where a plane cuts the surface.
// middles: along the shortest strip of faces, through the middles of edges.
enum class ClosingKind { rim, plane, middles };

// How a contour between two garments is closed that ends at their rims, because fans meet only their own garment. On
// each garment's surface a path leads from its last point back to its first. Triangles between the two paths, with a
// corner at the middle of these two points, close the gap between the surfaces.
struct ContourClosing {
  struct Path {
    ClosingKind kind = ClosingKind::plane;
    std::vector<CurvePoint> points;  // from the contour's last to its first, both included
    std::array<int, 2> end_faces{};  // the contour's last and first triangle on this side
    int times = 0;  // how often its triangles (middle, point, next point) count in the region's surface
  };
  std::array<Path, 2> paths;  // by side of the contour
};

// Closes a contour with both ends at closed holes. If both are at one hole, the cloth round the hole has gone through
// the other garment: on its own surface the path takes the shorter way round the rim, on the other surface it leads
// straight from end to end. If one end is at a rim of each garment, both paths lead straight. Straight means in a plane
// through both ends and up_of_plane. Where that meets a hole or is longer than twice the contour, both paths go through
// the middles of edges, which always exist along the contour itself. Returns nothing for other contours, with two holes
// of one garment among them. Otherwise appends the curves of both sides to `curves`, and to `crossings` where paths cut
// edges (with `face` -1).
std::optional<ContourClosing> close_open_contour(const ClosedSurface&, const Points& closed_x, const Contour&,
                                                 int number, std::vector<Crossing>& crossings,
                                                 std::vector<SurfaceCurve>& curves);

// The sum of the unit normals of the surfaces that the plane cuts, each the mean of those at the contour's ends.
Vec3 up_of_plane(const ClosedSurface&, const Points& closed_x, const ContourClosing&);

// The volume of the cones from `centre` over the closing's triangles, a part of the region's volume [m^3].
double closing_volume(const ClosedSurface&, const Points& closed_x, const std::vector<Crossing>&, const ContourClosing&,
                      const Vec3& centre);

// Adds to `gradient` `scale` times the derivative of the flux through the closing's triangles by the closed positions:
// crossings stay where edges and faces meet, cuts stay in their plane. With the flux through the surfaces' faces it is
// the exact derivative of the region's volume.
void add_closing_flux(const ClosedSurface&, const Points& closed_x, const std::vector<Crossing>&, const ContourClosing&,
                      double scale, Points& gradient);

}  // namespace selvedge
