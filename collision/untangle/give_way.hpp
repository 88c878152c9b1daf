#pragma once

#include <memory>

#include "collision/geometry/surface.hpp"

namespace selvedge {

struct GiveWayOptions {
  double room = 0.01;   // left between parts that come together, for cloth [m]; 0: they may just touch
  double most = 0.045;  // how far a vertex gives way [m]
};

// A body's surface as it gives way, like flesh, where it would pass through itself: under the arms, between the thighs,
// in the bends of limbs. Skinning knows nothing of that, and cloth between faces that have passed each other has no
// place to be. Where more than `most` would be needed, a hand in the belly, the body still passes through itself:
// but for single spots it leaves room or crosses, and does not merely touch.
class GiveWay {
 public:
  // rest: the body where its parts are apart, as in the zero pose [m].
  GiveWay(Surface body, const Points& rest, const GiveWayOptions& = {});

  // The surface that is skinned to x, moved. Depends on x alone.
  Points operator()(const Points& x) const;

 private:
  std::shared_ptr<const struct Flesh> flesh_;
};

}  // namespace selvedge
