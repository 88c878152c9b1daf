#pragma once

#include <vector>

#include "collision/kept_shape.hpp"
#include "collision/surface.hpp"

namespace selvedge {

struct GiveWayOptions {
  double room = 0.01;   // left between parts that come together, for cloth [m]; 0: they may just touch
  double most = 0.045;  // how far a vertex gives way [m]
};

// A body's surface as it gives way, like flesh, where it would pass through itself: under the arms, between the thighs,
// in the bends of limbs. Skinning knows nothing of that, and cloth between faces that have passed each other has no
// place to be. Where more than `most` would be needed, a hand in the belly, the body still passes through itself.
class GiveWay {
 public:
  // rest: the body where its parts are apart, as in the zero pose [m].
  GiveWay(Surface body, const Points& rest, const GiveWayOptions& = {});
  GiveWay(const GiveWay&) = delete;
  GiveWay& operator=(const GiveWay&) = delete;

  // The surface that is skinned to x, moved. Depends on x alone.
  Points operator()(const Points& x) const;

 private:
  // A vertex and the one that it meets, on another part of the body.
  struct Meeting {
    int vertex, partner;
    Vec3 apart;    // the way to go [unit]
    double least;  // distance along it [m]
    double share;  // of what is missing that the vertex goes
  };
  int facing(int vertex, const class CellGrid&, const Points& x, const Points& normals) const;
  std::vector<Meeting> meetings(const Points& x) const;
  Points pressed(const Points& x) const;
  bool mend(const std::vector<int>& place, const Points& from, const Points& x, Points& result) const;

  Surface body_;
  KeptShape shape_;
  GiveWayOptions options_;
  std::vector<double> thickness_;  // of the body under each vertex [m]
};

}  // namespace selvedge
