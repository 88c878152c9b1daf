#pragma once

#include <memory>

#include "pipeline/exports/export_formats.hpp"

namespace selvedge {

// The run of a request as writers of exports take it: a surface a cloth that has triangles, then the obstacles if they
// are wanted. A cloth whose file had a look has the vertices and faces of that file. A mesh given by `onto` stands
// first, in the place of the cloths that drive it. The trajectory stays open as long as `frame` lives; `frame` reads it
// once a call, and tells the request's progress, of which `all` is set by the writer's number of reads.
// Throws Error for a run without a frame, an unknown cloth, and a mesh that does not lie at the rest shape.
struct AnimatedRun {
  AnimatedSurfaces surfaces;
  std::shared_ptr<int> reads = std::make_shared<int>(0);  // of the positions of a frame that are to come
};
AnimatedRun animated_run(const ExportRequest&);

}  // namespace selvedge
