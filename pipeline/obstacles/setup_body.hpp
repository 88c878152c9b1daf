#pragma once

#include <map>
#include <memory>
#include <optional>

#include "collision/untangle/give_way.hpp"
#include "pipeline/bodies/body.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/garments/footing.hpp"
#include "pipeline/motions/clip.hpp"
#include "pipeline/obstacles/setup_obstacle.hpp"
#include "pipeline/shapes/motion.hpp"

namespace selvedge {

// Times of a draped start [s]: of the motion from the pose in which the garments were made, and of the hold after it.
struct Draping {
  double seconds = 1, hold = 0.5;
  bool operator==(const Draping&) const = default;
};

// The surface of a body before it is placed in the scene: skinned, and with deformed soft tissue [m].
struct PosedBody {
  Points skinned, given;
};

// Poses of one performance by time. They are kept because soft tissue takes long, and the obstacle and all garments
// need the same times.
struct PosedBodies {
  std::map<double, PosedBody> at;
  bool keeps_all = false;  // false: only the last poses are kept
  double skin_at = 0;      // the moment of:
  std::optional<PosedSkin> skin;
};

// A body of a scene with its motion and placement. The obstacle and the garments on it share it.
struct Performance {
  std::string name;  // the obstacle's
  BodyModel body;
  Surface surface;          // of its skin, welded (welded_surface.hpp)
  std::vector<int> joined;  // of each vertex the one that stands for it in `surface`; empty: none is joined
  Eigen::VectorXd shape;
  Eigen::VectorXd said;                        // the shape that its section gives; empty: none
  Clip clip;                                   // without poses: it stands in the zero pose
  std::shared_ptr<const GiveWay> soft_tissue;  // null: it passes through itself
  bool fits_room = false;                      // between its parts to what it wears
  int garments = 0;                            // that it wears
  Config section;                              // the obstacle's: how it is placed
  Motion motion;                               // of what is placed
  Clip before;                                 // up to time 0, where the scene's time begins before it
  double begins = 0;                           // when it does [s]
  std::shared_ptr<PosedBodies> known = std::make_shared<PosedBodies>();  // where it was asked for, by time
  std::vector<std::string> warnings = {};                                // of what its files do not say, or say twice
};

// The bodies of a scene's obstacles, one an obstacle, null for what is none. `folder` is the scene file's.
using Performances = std::vector<std::shared_ptr<Performance>>;
Performances read_performances(const Config& obstacles, const std::filesystem::path& folder);

// A `body` section by itself: model, shape and clip.
Performance read_performance(const Config& body, const std::filesystem::path& folder);
// The same in two parts: the model, which stands in its zero pose, and what it does: shape, clip and room, in place of
// what it did before.
Performance read_figure(const Config& body, const std::filesystem::path& folder);
void perform(const Config& body, const std::filesystem::path& folder, Performance&);

// Sets the number of garments that the body wears. The room between its parts grows with it, unless the body's section
// gives the room.
void wear(int garments, Performance&);

// Lets the scene's time begin before 0, at `begins`. The body moves from these rotations of its joints into its pose at
// time 0 within `seconds`, and holds it from then on.
void come_from(const Points& rotations, double begins, double seconds, Performance&);

BodyPose pose_at(const Performance&, double time);

// The body at a time before it is placed. The performance keeps it.
const PosedBody& posed_at(const Performance&, double time);

// The skin with deformed soft tissue before it is placed. The last one is kept.
const PosedSkin& skin_at(const Performance&, double time);

// The body where the scene has it at a time [s], with its soft tissue deformed if it has any.
Points body_at(const Performance&, double time);

// Scaled, turned and moved as the body is.
Points in_scene(const Performance&, const Points&, double time);

bool is_still(const Performance&);

// The obstacle that a body is.
ObstaclePart obstacle_of(const std::shared_ptr<const Performance>&);

}  // namespace selvedge
