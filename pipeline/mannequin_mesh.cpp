#include "pipeline/isosurface.hpp"
#include "pipeline/mannequin_form.hpp"
#include "pipeline/mannequin_skin.hpp"
#include "pipeline/remesh.hpp"

namespace selvedge {

MannequinMesh mannequin_mesh() {
  constexpr double grid = 0.012;
  constexpr int rounds = 6;
  const Form form = mannequin_form();
  const Shape rough = isosurface([&](const Vec3& p) { return signed_value(form, p); }, Vec3(0, -0.02, -0.2),
                                 Vec3(0.95, 1.78, 0.25), grid);
  const RemeshTarget target{mannequin_edge, [&](const Vec3& p) { return projected(form, p); }};
  const Shape half = remeshed(rough, target, rounds);

  MannequinMesh mesh;
  mesh.half = static_cast<int>(half.x.rows());
  int count = mesh.half;
  for (int v = 0; v < mesh.half; ++v) mesh.twin.push_back(half.x(v, 0) == 0 ? v : count++);
  mesh.x.resize(count, 3);
  mesh.x.topRows(mesh.half) = half.x;
  mesh.twin.resize(static_cast<std::size_t>(count));
  for (int v = 0; v < mesh.half; ++v) {
    const int twin = mesh.twin[static_cast<std::size_t>(v)];
    if (twin == v) continue;
    mesh.twin[static_cast<std::size_t>(twin)] = v;
    mesh.x.row(twin) << -half.x(v, 0), half.x(v, 1), half.x(v, 2);
  }
  const Eigen::Index m = half.triangles.rows();
  mesh.triangles.resize(2 * m, 3);
  mesh.triangles.topRows(m) = half.triangles;
  for (Eigen::Index t = 0; t < m; ++t) {
    const auto twin = [&](int k) { return mesh.twin[static_cast<std::size_t>(half.triangles(t, k))]; };
    mesh.triangles.row(m + t) << twin(0), twin(2), twin(1);
  }
  return mesh;
}

}  // namespace selvedge
