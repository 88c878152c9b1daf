#pragma once

#include <map>
#include <memory>
#include <optional>

#include "collision/untangle/give_way.hpp"
#include "pipeline/bodies/body.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/garments/footing.hpp"
#include "pipeline/meshes/setup_obstacle.hpp"
#include "pipeline/motions/clip.hpp"
#include "pipeline/shapes/motion.hpp"

namespace selvedge {

// How a clean start is grown: bodies come from the pose that their garments were made in, and hold still [s].
struct Draping {
  double seconds = 1, hold = 0.5;
  bool operator==(const Draping&) const = default;
};

// A body before it is placed: as skinned, and where it has given way to itself [m].
struct PosedBody {
  Points skinned, given;
};

// Of one body doing one thing. To give way takes time, and the obstacle and all garments ask for the same moments.
struct PosedBodies {
  std::map<double, PosedBody> at;
  bool keeps_all = false;  // else those asked for last
  double skin_at = 0;      // the moment of:
  std::optional<PosedSkin> skin;
};

// A body of a scene, what it does and where: the obstacle and the garments on it share it.
struct Performance {
  std::string name;  // the obstacle's
  BodyModel body;
  Surface surface;  // of its skin
  Eigen::VectorXd shape;
  Clip clip;                                   // without poses: it stands in the zero pose
  std::shared_ptr<const GiveWay> soft_tissue;  // null: it passes through itself
  bool fits_room = false;                      // between its parts to what it wears
  int garments = 0;                            // that it wears
  Config section;                              // the obstacle's: how it is placed
  Motion motion;                               // of what is placed
  Clip before;                                 // up to time 0, where the scene's time begins before it
  double begins = 0;                           // when it does [s]
  std::shared_ptr<PosedBodies> known = std::make_shared<PosedBodies>();  // where it was asked for, by time
};

// The bodies of a scene's obstacles, one an obstacle, null for what is none. `folder` is the scene file's.
using Performances = std::vector<std::shared_ptr<Performance>>;
Performances read_performances(const Config& obstacles, const std::filesystem::path& folder);

// A `body` section by itself: model, shape and clip.
Performance read_performance(const Config& body, const std::filesystem::path& folder);

// Has it wear that many, and leave as much room between parts that come together as they ask for over each other,
// unless the body's section says how much.
void wear(int garments, Performance&);

// Makes the scene's time begin that early, with that many seconds of the body's way from these rotations of its joints
// into its pose at time 0, which it holds from then on.
void come_from(const Points& rotations, double begins, double seconds, Performance&);

BodyPose pose_at(const Performance&, double time);

// Before it is placed; kept in what the performance knows.
const PosedBody& posed_at(const Performance&, double time);

// Where it has given way to itself, before it is placed; the last one is kept.
const PosedSkin& skin_at(const Performance&, double time);

// The body where the scene has it at a time [s], with its soft tissue deformed if it has any.
Points body_at(const Performance&, double time);

// Scaled, turned and moved as the body is.
Points in_scene(const Performance&, const Points&, double time);

bool is_still(const Performance&);

// The obstacle that a body is.
ObstaclePart obstacle_of(const std::shared_ptr<const Performance>&);

}  // namespace selvedge
