#pragma once

#include "pipeline/training/training_world.hpp"

namespace selvedge {

// Body and garments in a frame of a clip, the garments one behind the other [m].
struct WornFrame {
  PointsF body, cloth;
};
WornFrame worn_frame(TrainingWorld&, int wear, int body, int clip, int frame);

}  // namespace selvedge
