#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "collision/untangle/give_way.hpp"
#include "pipeline/bodies/body.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/garments/footing.hpp"
#include "pipeline/motions/clip.hpp"
#include "pipeline/obstacles/setup_obstacle.hpp"
#include "pipeline/obstacles/tissue_store_hdf5.hpp"
#include "pipeline/shapes/motion.hpp"

namespace selvedge {

// Times of a draped start. Members are described where keys are bound to them: pipeline/scene/config_garment.cpp.
struct Draping {
  double seconds = 1, hold = 0.5;
  bool operator==(const Draping&) const = default;
};

// The surface of a body before it is placed in the scene: skinned, and with its soft tissue given way [m].
struct PosedBody {
  Points skinned, given;
  bool apart = false;  // no triangles of `given` are known to intersect
};

// A cache of posed surfaces of one performance by time, since soft tissue takes long, and the obstacle and all garments
// need the same times.
struct PosedBodies {
  std::map<double, PosedBody> at;
  Points joints = {};      // in its shape and zero pose [m]; empty: nobody asked yet
  bool keeps_all = false;  // false: keeps only the last poses
  double skin_at = 0;      // time of `skin` [s]
  std::optional<PosedSkin> skin;
  std::uint64_t performance = 0;       // a hash of the body, its room and its clip; 0: it has no soft tissue
  std::shared_ptr<TissueStore> store;  // of soft tissue from earlier runs; null: none is kept
  double room = 0;                     // that soft tissue leaves between the body's parts [m]; 0: there is none
  int poses = 0;                       // that were computed with soft tissue
  double seconds = 0;                  // that it took
};

// A body of a scene with its motion and placement. The obstacle and the garments on it share it.
struct Performance {
  std::string name;  // the obstacle's
  BodyModel body;
  Surface surface;          // of its skin, welded (welded_surface.hpp)
  std::vector<int> joined;  // of each vertex the one that stands for it in `surface`; empty: none joined
  Eigen::VectorXd shape;
  Eigen::VectorXd given_shape;                 // the shape from its section; empty: none
  Clip clip;                                   // no poses: it stands in the zero pose
  std::shared_ptr<const GiveWay> soft_tissue;  // null: the body may pass through itself
  bool fits_room = false;                      // the room between its parts follows from its garments
  int garments = 0;                            // number of garments that it wears
  Config section;                              // the obstacle's section, with its placement
  Motion motion;                               // of the placed body
  Clip before;                                 // the motion up to time 0, if the scene begins earlier
  double begins = 0;                           // time at which the scene begins [s]
  std::shared_ptr<PosedBodies> known = std::make_shared<PosedBodies>();  // cache
  std::vector<std::string> warnings = {};  // about information that files lack or contradict
};

// The bodies of a scene's obstacles: one per obstacle, null if it is no body. `folder` is the scene file's.
using Performances = std::vector<std::shared_ptr<Performance>>;
Performances read_performances(const Config& obstacles, const std::filesystem::path& folder);

// Reads a `body` section: model, shape and clip.
Performance read_performance(const Config& body, const std::filesystem::path& folder);
// The same in two parts: read_figure reads the model, in its zero pose; perform reads shape, clip and room and replaces
// the old ones.
Performance read_figure(const Config& body, const std::filesystem::path& folder);
void perform(const Config& body, const std::filesystem::path& folder, Performance&);

// The same for bodies and clips that are in no file. figure_of gives the body in its mean shape and zero pose. It turns
// closed shells outwards; `what` names the body in warnings of that.
Performance figure_of(BodyModel, const std::string& what);
// Gives it a clip of its own joints, and the room of the `body` section. Throws Error at `what` for a clip that moves
// the body absurdly far.
void perform_clip(Clip, const Config& body, const Config& what, Performance&);
// Names it, and places and moves it as its `obstacle` section says.
void place_performance(const Config& obstacle, const std::string& name, Performance&);

// Sets the number of garments that the body wears. The room between its parts grows with it, unless the body's section
// gives the room.
void wear(int garments, Performance&);

// Lets the scene's time begin before 0, at `begins`. The body moves from these rotations of its joints into its pose at
// time 0 within `seconds`, and holds it from then on.
void come_from(const Points& rotations, double begins, double seconds, Performance&);

// A hash of all that decides which poses with soft tissue a body meets in a clip; it only names a file.
std::uint64_t hash_of_performance(const Surface&, const SkinnedSurface&, const Eigen::VectorXd& shape, const Clip&,
                                  double room);
// Gives the bodies the stores of soft tissue that a cache folder has for them; empty: none.
void read_tissue(const std::filesystem::path& folder, const std::vector<std::shared_ptr<PosedBodies>>& bodies);
// Writes stores that have grown. Throws Error if the folder cannot be written.
void write_tissue(const std::vector<std::shared_ptr<PosedBodies>>& bodies);

BodyPose pose_at(const Performance&, double time);

// Transforms of its joints from the zero pose to a pose. The joints of its shape are cached.
JointTransforms transforms_to(const Performance&, const BodyPose&);

// The body at a time [s], before it is placed. Cached in the performance.
const PosedBody& posed_at(const Performance&, double time);

// The skin after soft tissue gave way, before it is placed. The last one is cached.
const PosedSkin& skin_at(const Performance&, double time);

// The body as placed in the scene at a time [s], with its soft tissue if it has any.
Points body_at(const Performance&, double time);

// Positions scaled, turned and moved as the body is at a time [s].
Points in_scene(const Performance&, const Points&, double time);

bool is_still(const Performance&);

// The obstacle for a body.
ObstaclePart obstacle_of(const std::shared_ptr<const Performance>&);

}  // namespace selvedge
