#include "physics/steppers/finish_step.hpp"

#include <algorithm>
#include <utility>

#include "collision/contact/contact_world.hpp"

namespace selvedge {
namespace {

constexpr double position_rounding = 1e-14;  // relative, of positions that are added up over substeps

}  // namespace

void finish_step(const State& from, const Drive& drive, double dt, StepEnd end, State& to, StepReport& report) {
  report.status = StepStatus::accepted;
  double lag = 0, size = largest_coordinate(from.x);
  for (std::size_t k = 0; k < end.obstacles.size(); ++k) {
    if (end.obstacles[k].rows() == 0) continue;
    lag = std::max(lag, (end.obstacles[k] - drive.obstacles[k]).rowwise().norm().maxCoeff());
    size = std::max(size, largest_coordinate(drive.obstacles[k]));
  }
  if (report.path.substeps.empty())
    report.path = {gather_nodes(from.x, from.obstacles), {{gather_nodes(end.x, end.obstacles), {}}}, {}};
  to.time = from.time + dt;
  to.frame = from.frame + 1;
  to.x = std::move(end.x);
  to.v = std::move(end.v);
  to.obstacles = std::move(end.obstacles);
  to.pinched = lag > position_rounding * size;
  to.clean = false;
  to.cut_out = from.cut_out;
  to.memory = std::move(end.memory);
  report.collision.obstacle_lag = to.pinched ? lag : 0;
}

}  // namespace selvedge
