#include "physics/steppers/finish_step.hpp"

#include <algorithm>
#include <utility>

#include "collision/geometry/pair_budget.hpp"

namespace selvedge {
namespace {

constexpr double position_rounding = 1e-14;  // relative, of positions that are added up over substeps

}  // namespace

void finish_step(const Scene& scene, const State& from, const Drive& drive, double dt, StepEnd end, AuditMemory& audits,
                 State& to, StepReport& report, LaterAudits* later) {
  report.status = StepStatus::accepted;
  double lag = 0, size = largest_coordinate(from.x);
  for (std::size_t k = 0; k < end.obstacles.size(); ++k) {
    if (end.obstacles[k].rows() == 0) continue;
    lag = std::max(lag, (end.obstacles[k] - drive.obstacles[k]).rowwise().norm().maxCoeff());
    size = std::max(size, largest_coordinate(drive.obstacles[k]));
  }
  to.time = from.time + dt;
  to.frame = from.frame + 1;
  to.x = std::move(end.x);
  to.v = std::move(end.v);
  to.obstacles = std::move(end.obstacles);
  to.pinched = lag > position_rounding * size;
  to.cut_out = from.cut_out;
  to.memory = std::move(end.memory);
  report.collision.obstacle_lag = to.pinched ? lag : 0;
  if (later) {
    to.clean = true;
    later->audits.push_back([&scene, drive, state = to, &audits](StepReport& found) mutable {
      audit_state(scene, drive, state, audits, found);
    });
    return;
  }
  try {
    audit_state(scene, drive, to, audits, report);
  } catch (const TooManyPairs&) {
    report.status = StepStatus::rejected;
    report.reason = Reason::too_many_pairs;
    to.clean = false;
  }
}

}  // namespace selvedge
