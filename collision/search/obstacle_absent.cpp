#include "collision/geometry/error.hpp"
#include "collision/search/obstacle.hpp"

namespace selvedge {
namespace {

[[noreturn]] void throw_absent() {
  throw Error("this build has no FCL", "SELVEDGE_FCL=OFF", "install libfcl-dev and configure with -DSELVEDGE_FCL=ON");
}

}  // namespace

struct ObstacleModel::Impl {};

bool obstacle_available() { return false; }
ObstacleModel::ObstacleModel(const Triangles&, const Points&) { throw_absent(); }
ObstacleModel::~ObstacleModel() = default;
ObstacleModel::ObstacleModel(ObstacleModel&&) noexcept = default;
void ObstacleModel::refit(const Points&) { throw_absent(); }
std::vector<std::pair<int, int>> obstacle_self_pairs(const ObstacleModel&, const Triangles&) { throw_absent(); }
std::vector<std::pair<int, int>> obstacle_pairs(const ObstacleModel&, const ObstacleModel&) { throw_absent(); }
bool collision_free(const ObstacleModel&, const ObstacleModel&) { throw_absent(); }

}  // namespace selvedge
