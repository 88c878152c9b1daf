#include "pipeline/bodies/mannequin_form.hpp"
#include "pipeline/bodies/mannequin_skin.hpp"
#include "pipeline/shapes/isosurface.hpp"
#include "pipeline/shapes/remesh.hpp"

namespace selvedge {

MirroredMesh mannequin_mesh() {
  constexpr double grid = 0.012;
  constexpr int rounds = 6;
  const Form form = mannequin_form();
  const Shape rough = isosurface([&](const Vec3& p) { return signed_value(form, p); }, Vec3(0, -0.02, -0.2),
                                 Vec3(0.95, 1.78, 0.25), grid);
  const RemeshTarget target{mannequin_edge, [&](const Vec3& p) { return projected(form, p); }};
  return mirrored(remeshed(rough, target, rounds));
}

}  // namespace selvedge
