#pragma once

#include <memory>

#include "pipeline/exports/export_formats.hpp"

namespace selvedge {

struct AnimatedRun {
  AnimatedSurfaces surfaces;
  std::shared_ptr<int> reads = std::make_shared<int>(0);  // how often `frame` will be called, for the progress
};

// The run of a request as writers of exports take it: a surface a cloth that has triangles, then the obstacles if they
// are wanted. A cloth whose file had a look has the vertices and faces of that file. A mesh given by `onto` stands
// first, in the place of the cloths that drive it. The trajectory stays open as long as `frame` lives. Throws Error for
// a run without a frame, an unknown cloth, and a mesh that does not lie at the rest shape.
AnimatedRun animated_run(const ExportRequest&);

}  // namespace selvedge
