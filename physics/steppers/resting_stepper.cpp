#include "physics/steppers/resting_stepper.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "collision/geometry/box.hpp"
#include "physics/energies/joints.hpp"
#include "physics/energies/measures.hpp"
#include "physics/scene/contact_forces.hpp"
#include "physics/scene/part_of_scene.hpp"

namespace selvedge {
namespace {

constexpr int force_columns = 7;
constexpr std::size_t most_kept = 4;  // scenes with some of the cloths that are kept, since resting cloths may wake

constexpr const char *seconds_block = "resting.seconds", *place_block = "resting.place", *air_block = "resting.air",
                     *forces_block = "resting.forces";

using Chosen = std::vector<char>;  // one per cloth

bool any(const Chosen& cloths) { return std::ranges::count(cloths, true) > 0; }

Box box_of_motion(const Points& x0, const Points& x1, double margin) {
  Box box = empty_box;
  for (int i = 0; i < x0.rows(); ++i) box = join(box, moving_point_box(row(x0, i), row(x1, i), margin));
  return box;
}

// The box of a motion from x0 to x1 that leaves the straight path by no more than the path's length.
Box box_of_motion(const Points& x0, const Points& x1) { return box_of_motion(x0, x1, largest_row(x1 - x0)); }

// Of each cloth the lowest one that springs join it to.
std::vector<int> joined_cloths(const Scene& scene) {
  std::vector<int> cloth_of_vertex;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c)
    cloth_of_vertex.insert(cloth_of_vertex.end(), static_cast<std::size_t>(scene.cloths[c].vertex_count),
                           static_cast<int>(c));
  return joined_parts(scene, cloth_of_vertex, static_cast<int>(scene.cloths.size()));
}

class RestingStepper final : public Stepper {
 public:
  RestingStepper(const Scene& scene, MakeStepper make, std::unique_ptr<Stepper> whole, const RestingOptions& options)
      : scene_(scene),
        make_(std::move(make)),
        whole_(std::move(whole)),
        still_(options.still_edges * mean_edge_length(scene)),
        still_seconds_(options.still_seconds),
        joined_(joined_cloths(scene)) {}

  const StepperTraits& traits() const override { return whole_->traits(); }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) override;

 private:
  struct Part {
    std::shared_ptr<const PartOfScene> part;
    std::unique_ptr<Stepper> stepper;
  };
  auto rows(const Points& x, int cloth) const {
    return x.middleRows(scene_.cloths[cloth].first_vertex, scene_.cloths[cloth].vertex_count);
  }
  bool pins_move(const State& from, const Drive& drive, int cloth) const;
  void keep_joined(Chosen& resting) const;
  Chosen still_ones(const State& from, const Rest& rest, const Drive& drive) const;
  bool wake(const State& from, const std::vector<Box>& moving, Chosen& resting) const;
  std::vector<Box> moving_boxes(const State& from, const Drive& drive, double dt, const Chosen& resting) const;
  StepReport step_others(const State& from, const Rest& rest, const Drive& drive, double dt, const Chosen& resting,
                         const StepExtras&, State& to);
  bool comes_near(const State& from, const State& to, Chosen& resting) const;
  Rest rest_after(Rest rest, const State& from, const State& to, const Drive& drive, double dt) const;
  Part& part(const Chosen& resting);

  const Scene& scene_;
  MakeStepper make_;
  std::unique_ptr<Stepper> whole_;
  double still_;             // cloth that moves by less is still [m]
  double still_seconds_;     // cloth that was still for this long rests [s]
  std::vector<int> joined_;  // of each cloth the lowest one that springs join it to
  std::map<Chosen, Part> parts_;
};

bool RestingStepper::pins_move(const State& from, const Drive& drive, int cloth) const {
  const Cloth& c = scene_.cloths[cloth];
  for (std::size_t p = 0; p < scene_.pins.size(); ++p) {
    const int pin = scene_.pins[p];
    if (pin >= c.first_vertex && pin < c.first_vertex + c.vertex_count &&
        drive.pins.row(static_cast<Eigen::Index>(p)) != from.x.row(pin))
      return true;
  }
  return false;
}

// Cloths that springs join rest only if all of them are still.
void RestingStepper::keep_joined(Chosen& resting) const {
  Chosen all(resting.size(), true);
  for (std::size_t c = 0; c < resting.size(); ++c) all[joined_[c]] = all[joined_[c]] && resting[c];
  for (std::size_t c = 0; c < resting.size(); ++c) resting[c] = all[joined_[c]];
}

// Cloths that rest if nothing comes near them.
Chosen RestingStepper::still_ones(const State& from, const Rest& rest, const Drive& drive) const {
  Chosen still(scene_.cloths.size(), false);
  if (!from.clean || from.pinched || rest.seconds.size() != still.size()) return still;
  if (rest.wind != drive.wind || rest.acceleration != drive.acceleration) return still;
  for (std::size_t c = 0; c < still.size(); ++c)
    still[c] = rest.seconds[c] >= still_seconds_ && !pins_move(from, drive, static_cast<int>(c));
  keep_joined(still);
  return still;
}

// Boxes of what moves in the step: obstacles, and the other cloths as far as they will probably move.
std::vector<Box> RestingStepper::moving_boxes(const State& from, const Drive& drive, double dt,
                                              const Chosen& resting) const {
  std::vector<Box> boxes;
  for (std::size_t k = 0; k < from.obstacles.size(); ++k)
    if (from.obstacles[k] != drive.obstacles[k]) boxes.push_back(box_of_motion(from.obstacles[k], drive.obstacles[k]));
  for (std::size_t c = 0; c < resting.size(); ++c) {
    if (resting[c]) continue;
    const Points x0 = rows(from.x, static_cast<int>(c));
    Points x1 = x0 + dt * rows(from.v, static_cast<int>(c));
    x1.rowwise() += dt * dt * drive.acceleration.transpose();
    boxes.push_back(box_of_motion(x0, x1));
  }
  return boxes;
}

// True if a resting cloth is near one of the boxes; that cloth then no longer rests.
bool RestingStepper::wake(const State& from, const std::vector<Box>& moving, Chosen& resting) const {
  bool woken = false;
  for (std::size_t c = 0; c < resting.size(); ++c) {
    if (!resting[c]) continue;
    const Points x = rows(from.x, static_cast<int>(c));
    const Box own = box_of_motion(x, x, scene_.contact.thickness);
    if (std::ranges::none_of(moving, [&](const Box& other) { return overlap(own, other); })) continue;
    resting[c] = false;
    woken = true;
  }
  if (woken) keep_joined(resting);
  return woken;
}

RestingStepper::Part& RestingStepper::part(const Chosen& resting) {
  if (const auto found = parts_.find(resting); found != parts_.end()) return found->second;
  if (parts_.size() == most_kept) parts_.clear();
  Chosen chosen = resting;
  for (char& c : chosen) c = !c;
  Part& made = parts_[resting];
  made.part = std::make_shared<const PartOfScene>(part_of(scene_, chosen));
  made.stepper = make_(made.part->scene);
  return made;
}

// A step of what does not rest. Contact exerts on the others what it did in their last step.
StepReport RestingStepper::step_others(const State& from, const Rest& rest, const Drive& drive, double dt,
                                       const Chosen& resting, const StepExtras& extras, State& to) {
  const int count = static_cast<int>(std::ranges::count(resting, true));
  if (count == 0) return whole_->step(from, drive, dt, to, extras);
  to = from;
  to.time = from.time + dt;
  to.frame = from.frame + 1;
  to.v.setZero();
  if (count == static_cast<int>(resting.size())) {
    to.obstacles = drive.obstacles;
    to.memory.clear();
    StepReport report;
    report.status = StepStatus::accepted;
    report.by = traits().name;
    report.resting = count;
    report.contact_forces = rest.forces;
    return report;
  }
  Part& others = part(resting);
  State end;
  StepReport report =
      others.stepper->step(state_of(*others.part, from), drive_of(*others.part, drive), dt, end, {.stop = extras.stop});
  report.resting = count;
  if (report.status != StepStatus::accepted) return report;
  put(*others.part, end, to);
  report.path.part = others.part;
  if (report.contact_forces) {
    ContactForces all = rest.forces ? *rest.forces : unknown_contact_forces(to.x.rows());
    put(*others.part, *report.contact_forces, all);
    report.contact_forces = std::make_shared<const ContactForces>(std::move(all));
  }
  return report;
}

// True if something came nearer to a resting cloth than expected; that cloth then no longer rests.
bool RestingStepper::comes_near(const State& from, const State& to, Chosen& resting) const {
  std::vector<Box> boxes;
  for (std::size_t k = 0; k < from.obstacles.size(); ++k)
    if (from.obstacles[k] != to.obstacles[k]) boxes.push_back(box_of_motion(from.obstacles[k], to.obstacles[k]));
  for (std::size_t c = 0; c < resting.size(); ++c)
    if (!resting[c]) boxes.push_back(box_of_motion(rows(from.x, static_cast<int>(c)), rows(to.x, static_cast<int>(c))));
  return wake(from, boxes, resting);
}

Rest RestingStepper::rest_after(Rest rest, const State& from, const State& to, const Drive& drive, double dt) const {
  if (rest.seconds.size() != scene_.cloths.size() || rest.wind != drive.wind || rest.acceleration != drive.acceleration)
    rest = {std::vector<double>(scene_.cloths.size(), 0.0), from.x, drive.wind, drive.acceleration};
  for (std::size_t c = 0; c < rest.seconds.size(); ++c) {
    const int cloth = static_cast<int>(c);
    rest.seconds[c] += dt;
    if (largest_row(rows(to.x, cloth) - rows(rest.place, cloth)) <= still_) continue;
    rest.seconds[c] = 0;
    rest.place.middleRows(scene_.cloths[c].first_vertex, scene_.cloths[c].vertex_count) = rows(to.x, cloth);
  }
  return rest;
}

StepReport RestingStepper::step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) {
  if (extras.any()) return whole_->step(from, drive, dt, to, extras);
  const Rest rest = rest_of(from);
  Chosen resting = still_ones(from, rest, drive);
  while (any(resting) && wake(from, moving_boxes(from, drive, dt, resting), resting)) {
  }
  StepReport report = step_others(from, rest, drive, dt, resting, extras, to);
  while (report.status == StepStatus::accepted && any(resting) && comes_near(from, to, resting))
    report = step_others(from, rest, drive, dt, resting, extras, to);
  if (report.status != StepStatus::accepted) return report;
  Rest after = rest_after(rest, from, to, drive, dt);
  after.forces = report.contact_forces;
  remember(after, to);
  return report;
}

// Normal force, friction and pressure of each vertex in a row.
MemoryRows rows_of_forces(const ContactForces& forces) {
  MemoryRows rows(forces.normal.rows(), force_columns);
  rows << forces.normal, forces.friction, forces.pressure;
  return rows;
}

std::shared_ptr<const ContactForces> forces_of_rows(const MemoryRows* rows) {
  if (!rows || rows->cols() != force_columns) return nullptr;
  return std::make_shared<const ContactForces>(ContactForces{rows->leftCols(3), rows->middleCols(3, 3), rows->col(6)});
}

}  // namespace

Rest rest_of(const State& state) {
  const auto seconds = std::ranges::find(state.memory, seconds_block, &MemoryBlock::name);
  const MemoryRows* place = find_rows(state.memory, place_block, state.x.rows());
  const MemoryRows* air = find_rows(state.memory, air_block, 2);
  if (seconds == state.memory.end() || !place || !air) return {};
  const MemoryRows& rows = seconds->rows;
  return {{rows.data(), rows.data() + rows.size()},
          *place,
          air->row(0).transpose(),
          air->row(1).transpose(),
          forces_of_rows(find_rows(state.memory, forces_block, state.x.rows()))};
}

void remember(const Rest& rest, State& state) {
  MemoryRows air(2, 3);
  air << rest.wind.transpose(), rest.acceleration.transpose();
  const MemoryRows seconds = Eigen::Map<const Eigen::VectorXd>(rest.seconds.data(), std::ssize(rest.seconds));
  Memory blocks{
      {seconds_block, seconds, RowsOf::cloths}, {place_block, rest.place, RowsOf::vertices, true}, {air_block, air}};
  if (rest.forces && rest.forces->pressure.allFinite())
    blocks.push_back({forces_block, rows_of_forces(*rest.forces), RowsOf::vertices});
  replace_blocks("resting", std::move(blocks), state.memory);
}

std::unique_ptr<Stepper> make_resting_stepper(const Scene& scene, MakeStepper make, std::unique_ptr<Stepper> whole,
                                              const RestingOptions& options) {
  return std::make_unique<RestingStepper>(scene, std::move(make), std::move(whole), options);
}

}  // namespace selvedge
