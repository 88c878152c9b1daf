#include "pipeline/shapes/mirrored_mesh.hpp"

namespace selvedge {

MirroredMesh mirrored(const Shape& half, const std::function<bool(int vertex)>& joined) {
  MirroredMesh mesh;
  mesh.half = static_cast<int>(half.x.rows());
  int count = mesh.half;
  for (int v = 0; v < mesh.half; ++v) mesh.twin.push_back(half.x(v, 0) == 0 && (!joined || joined(v)) ? v : count++);
  Points& x = mesh.shape.x;
  x.resize(count, 3);
  x.topRows(mesh.half) = half.x;
  mesh.twin.resize(static_cast<std::size_t>(count));
  for (int v = 0; v < mesh.half; ++v) {
    const int twin = mesh.twin[v];
    if (twin == v) continue;
    mesh.twin[twin] = v;
    x.row(twin) << -half.x(v, 0), half.x(v, 1), half.x(v, 2);
  }
  const Eigen::Index m = half.triangles.rows();
  mesh.shape.triangles.resize(2 * m, 3);
  mesh.shape.triangles.topRows(m) = half.triangles;
  for (Eigen::Index t = 0; t < m; ++t) {
    const auto twin = [&](int k) { return mesh.twin[half.triangles(t, k)]; };
    mesh.shape.triangles.row(m + t) << twin(0), twin(2), twin(1);
  }
  return mesh;
}

}  // namespace selvedge
