#include "physics/solve/contour_potential.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace selvedge {
namespace {

// Where an edge is nearly parallel to a face, a crossing moves far for a small motion. Below this cosine of edge and
// normal the bound would be too stiff for the linear system.
constexpr double least_cosine = 0.01;

}  // namespace

ContourPotential::ContourPotential(const ContactWorld& world, const Points& nodes, double weight, ContourGradient kind)
    : world_(world), sheets_(world, nodes), weight_(weight), kind_(kind) {}

const Segments& ContourPotential::segments(const Points& x) {
  if (known_ && x == sheets_.positions[0]) return found_;
  sheets_.positions[0] = x;
  known_ = true;
  found_ = find_segments(sheets_.views);
  if (!world_.self) std::erase_if(found_.segments, [](const Segment& s) { return s.sheet[1] == 0; });
  return found_;
}

double ContourPotential::value(const Points& x) {
  if (!x.allFinite()) return std::numeric_limits<double>::infinity();
  return weight_ * contour_energy(sheets_.views, segments(x));
}

void ContourPotential::add_blocks(const Crossing& c, int uses, std::vector<ContactBlock>& blocks) const {
  const Surface &of_edge = *sheets_.views[c.edge_sheet].surface, &of_face = *sheets_.views[c.face_sheet].surface;
  const Points &x = sheets_.positions[c.edge_sheet], &y = sheets_.positions[c.face_sheet];
  const std::array<int, 2> edge{of_edge.edges(c.edge, 0), of_edge.edges(c.edge, 1)};
  const std::array<int, 3> face{of_face.triangles(c.face, 0), of_face.triangles(c.face, 1),
                                of_face.triangles(c.face, 2)};
  const Vec3 d0 = row(y, face[0]);
  const Vec3 normal = (row(y, face[1]) - d0).cross(row(y, face[2]) - d0).normalized();
  const double cosine = normal.dot((row(x, edge[1]) - row(x, edge[0])).normalized());
  if (!std::isfinite(cosine)) return;
  const bool both = c.edge_sheet == 0 && c.face_sheet == 0;
  const double stiffness = 2 * weight_ * uses * 2 * (both ? 2 : 1);  // factors for segment ends, and for edge and face
  ContactBlock block;
  block.normal = normal;
  block.normal_stiffness = stiffness / std::max(cosine * cosine, least_cosine * least_cosine);
  // The full gradient moves the edge with its crossing, too.
  const double along = kind_ == ContourGradient::full ? stiffness : 0;
  if (c.edge_sheet == 0) {
    block.nodes = {edge[0], edge[1], -1, -1};
    block.weights = {1 - c.s, c.s, 0, 0};
    block.tangent_stiffness = along;
    blocks.push_back(block);
  }
  if (c.face_sheet == 0) {
    block.nodes = {face[0], face[1], face[2], -1};
    block.weights = {c.weight[0], c.weight[1], c.weight[2], 0};
    block.tangent_stiffness = 0;
    blocks.push_back(block);
  }
}

void ContourPotential::add_derivatives(const Points& x, Points& gradient, std::vector<ContactBlock>& blocks) {
  const Segments& found = segments(x);
  if (found.segments.empty()) return;
  std::vector<Points> parts;
  contour_energy(sheets_.views, found, ContourMeasure::squared_length, &parts, kind_);
  gradient += weight_ * parts[0];
  std::vector<int> uses(found.crossings.size(), 0);
  for (const Segment& segment : found.segments)
    for (const int end : segment.end)
      if (end >= 0) ++uses[end];
  for (std::size_t c = 0; c < uses.size(); ++c)
    if (uses[c] > 0) add_blocks(found.crossings[c], uses[c], blocks);
}

}  // namespace selvedge
