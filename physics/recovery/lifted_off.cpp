#include "physics/recovery/lifted_off.hpp"

#include <numeric>

#include "collision/geometry/corners.hpp"
#include "collision/search/nearest_face.hpp"

namespace selvedge {

Points lifted_off(const ContactWorld& world, const Points& nodes, const std::vector<char>& tangled,
                  const std::vector<char>& held, double gap) {
  Points cloth = nodes.topRows(world.cloth->vertex_count);
  if (std::ranges::find(tangled, 1) == tangled.end()) return cloth;
  const double edge = mean_edge(*world.cloth, cloth), on_it = 1e-6 * edge;
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) {
    const Surface& surface = *world.obstacles[k];
    const Points x = nodes.middleRows(world.first_node[k], surface.vertex_count);
    std::vector<int> all(static_cast<std::size_t>(surface.triangles.rows()));
    std::iota(all.begin(), all.end(), 0);
    const FaceTree faces = make_face_tree(surface, x, std::move(all));
    for (int v = 0; v < world.cloth->vertex_count; ++v) {
      if (!tangled[v] || held[v]) continue;
      const int face = nearest_face(faces, row(cloth, v), on_it, [](int) { return true; }).face;
      if (face < 0) continue;
      const Vec3 up = twice_area(surface.triangles, x, face).normalized();
      if (up.allFinite()) cloth.row(v) += gap * edge * up.transpose();
    }
  }
  return cloth;
}

}  // namespace selvedge
