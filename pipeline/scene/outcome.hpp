#pragma once

#include <limits>
#include <optional>
#include <string>
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

// The measure must lie between `least` and `most` in every frame that counts, or in one of them (`once`).
struct Outcome {
  std::string name;
  Measure measure;
  std::optional<double> from{}, until{};  // times of the frames that count [s]; neither: the last frame
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  bool once = false;
};

struct OutcomeResult {
  std::string name;
  bool came_true = false;
  double value = 0;  // in the frame that decided: the first that failed, else the last that counted
  int frame = -1;    // that frame; -1: no frame counted
};

// Follows a run: shown every state from the first on, with what the world asked of it.
class OutcomeWatch {
 public:
  OutcomeWatch(const Scene&, const std::vector<Outcome>&, double end_time);
  void operator()(const State&, const Drive&);
  std::vector<OutcomeResult> results() const;

 private:
  struct Progress {
    double turned = 0;     // turns so far
    Points start;          // positions that drift is measured from
    bool decided = false;  // failed, or with `once` come true
    OutcomeResult result;
  };
  double measure(const Outcome&, Progress&, const State&, const Drive&) const;
  bool counts(const Outcome&, double time) const;

  const Scene& scene_;
  const std::vector<Outcome>& outcomes_;
  double end_time_;
  Points before_;  // positions of the frame before
  std::vector<Progress> progress_;
};

bool all_came_true(const std::vector<OutcomeResult>&);

// One line: the name, and where it did not come true what was measured instead.
std::string outcome_text(const Outcome&, const OutcomeResult&);

}  // namespace selvedge
