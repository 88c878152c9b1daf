#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// What a scene is to come to, measured in its states. A measure is one number a frame.

struct OutsideBox {  // the farthest that a vertex lies outside a box of space [m]
  std::vector<int> vertices;
  Vec3 low, high;
};
struct Turns {  // turns of vertices about their middle, followed from frame to frame, less those of others
  std::vector<int> vertices, against;  // `against` may be empty
  Vec3 axis;                           // of unit length
};
struct PartsApart {  // from the middle of some vertices to the middle of others [m]
  std::vector<int> from, to;
  Vec3 along;  // unit: the signed part in this direction; zero: the distance
};
struct Disorder {  // vertices whose upper side looks at the lower side of the cloth before theirs in the scene
  Vec3 up;         // of unit length
};
struct Ahead {  // how far the foremost vertex near an obstacle's axis is ahead of the obstacle's foremost point [m]
  std::vector<int> vertices;
  int obstacle = 0;
  Vec3 direction;     // of the axis through the middle of the obstacle's box, unit length
  double radius = 0;  // what is near [m]; nothing near measures minus infinity
};
struct Drift {  // the farthest that a vertex is from where it was in the first frame that counts [m]
  std::vector<int> vertices;
};
struct LargestStretch {};       // largest principal stretch
struct Lag {                    // largest distance of an obstacle vertex from where it was wanted [m]
  std::optional<int> obstacle;  // absent: of any
};
struct WantedPairs {};  // intersecting pairs and vertices inside, with the obstacles where they were wanted

using Measure = std::variant<OutsideBox, Turns, PartsApart, Disorder, Ahead, Drift, LargestStretch, Lag, WantedPairs>;

// What the measures come to in one frame.
double measured(const OutsideBox&, const Scene&, const State&, const Drive&);
double measured(const PartsApart&, const Scene&, const State&, const Drive&);
double measured(const Disorder&, const Scene&, const State&, const Drive&);
double measured(const Ahead&, const Scene&, const State&, const Drive&);
double measured(const LargestStretch&, const Scene&, const State&, const Drive&);
double measured(const Lag&, const Scene&, const State&, const Drive&);
double measured(const WantedPairs&, const Scene&, const State&, const Drive&);

double turned(const Turns&, const Points& before, const Points& now);  // from one frame to the next, under half a turn
double drift(const Drift&, const Points& start, const Points& now);

// Largest distance of a vertex of obstacle k from where it was wanted [m].
double obstacle_lag(const State&, const Drive&, std::size_t k);

}  // namespace selvedge
