#include "pipeline/exports/animated_surfaces.hpp"

#include "collision/geometry/error.hpp"

namespace selvedge {

void check_finite(const AnimatedSurface& surface, const PointsF& x, int frame, const std::string& format) {
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    if (!x.row(i).allFinite())
      throw Error("vertex " + std::to_string(i) + " is not finite in frame " + std::to_string(frame),
                  "`" + surface.name + "`", format + " holds numbers alone; obj and ply take the frames before it");
}

}  // namespace selvedge
