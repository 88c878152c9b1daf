#include "pipeline/run/memory_forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace selvedge {
namespace {

// The form of a stepper's block, the same in every state.
struct MemoryForm {
  std::string_view name;
  RowsOf rows_of = RowsOf::none;
  int columns = 3;
  bool positions = false;
  int rows = 1;        // of RowsOf::none
  double most = 1e6;   // largest absolute value
  bool whole = false;  // all values are integers >= 0
};

constexpr std::array known_forms{
    // physics/solve/bdf2.cpp
    MemoryForm{.name = "bdf2.h", .columns = 1},
    MemoryForm{.name = "bdf2.x", .rows_of = RowsOf::vertices, .positions = true},
    MemoryForm{.name = "bdf2.v", .rows_of = RowsOf::vertices, .most = 1e9},
    MemoryForm{.name = "bdf2.contact", .rows_of = RowsOf::vertices, .columns = 1, .most = 2, .whole = true},
    // physics/solve/energy_balance.cpp
    MemoryForm{.name = "energy.from_nowhere", .columns = 1, .most = 1e12},
    // physics/steppers/carried_guess.cpp
    MemoryForm{.name = "carried.target", .rows_of = RowsOf::vertices, .positions = true},
    MemoryForm{.name = "carried.motion", .rows_of = RowsOf::vertices},
    MemoryForm{.name = "carried.target_before", .rows_of = RowsOf::vertices, .positions = true},
    MemoryForm{.name = "carried.motion_before", .rows_of = RowsOf::vertices},
    // physics/steppers/recovering_stepper.cpp
    MemoryForm{.name = "recovering.last_clean", .rows_of = RowsOf::vertices, .positions = true},
    MemoryForm{.name = "recovering.last_clean_obstacles", .rows_of = RowsOf::obstacle_vertices, .positions = true},
    // physics/steppers/resting_stepper.cpp
    MemoryForm{.name = "resting.seconds", .rows_of = RowsOf::cloths, .columns = 1, .most = 1e9},
    MemoryForm{.name = "resting.place", .rows_of = RowsOf::vertices, .positions = true},
    MemoryForm{.name = "resting.air", .rows = 2},
    MemoryForm{.name = "resting.forces", .rows_of = RowsOf::vertices, .columns = 7, .most = 1e12},
    // physics/steppers/proposal_trust.cpp
    MemoryForm{.name = "hybrid.trust", .whole = true},
    // learned/steppers/learned_state.cpp
    MemoryForm{.name = "learned.velocity", .rows_of = RowsOf::vertices},
    MemoryForm{.name = "learned.previous", .rows_of = RowsOf::vertices, .positions = true},
    MemoryForm{.name = "learned.body_previous", .rows_of = RowsOf::obstacle_vertices, .positions = true}};

// The form of a block of another program's stepper.
MemoryForm form_of(const MemoryBlock& block) {
  return {block.name,
          block.rows_of,
          static_cast<int>(block.rows.cols()),
          block.positions,
          static_cast<int>(block.rows.rows()),
          std::numeric_limits<double>::max(),
          false};
}

Eigen::Index rows_in(const Scene& scene, const MemoryForm& form) {
  switch (form.rows_of) {
    case RowsOf::vertices:
      return scene.surface.vertex_count;
    case RowsOf::triangles:
      return scene.surface.triangles.rows();
    case RowsOf::cloths:
      return std::ssize(scene.cloths);
    case RowsOf::obstacle_vertices: {
      Eigen::Index count = 0;
      for (const Obstacle& obstacle : scene.obstacles) count += obstacle.surface.vertex_count;
      return count;
    }
    case RowsOf::none:
      break;
  }
  return form.rows;
}

// A value that is not allowed in this form; nothing if all are allowed.
std::optional<double> wrong_value(const MemoryRows& rows, const MemoryForm& form) {
  for (const double value : rows.reshaped<Eigen::RowMajor>())
    if (!(std::abs(value) <= form.most) || (form.whole && (value < 0 || value != std::floor(value)))) return value;
  return {};
}

}  // namespace

std::optional<std::string> misfit(const Memory& memory, const Scene& scene) {
  for (std::size_t b = 0; b < memory.size(); ++b) {
    const MemoryBlock& block = memory[b];
    if (std::ranges::find(memory, block.name, &MemoryBlock::name) != memory.begin() + static_cast<std::ptrdiff_t>(b))
      return fmt::format("`{}` is there twice", block.name);
    const auto known = std::ranges::find(known_forms, block.name, &MemoryForm::name);
    const MemoryForm form = known != known_forms.end() ? *known : form_of(block);
    if (block.rows_of != form.rows_of || block.positions != form.positions)
      return fmt::format("`{}` has rows of something else than it has in any scene", block.name);
    const Eigen::Index rows = rows_in(scene, form);
    if (block.rows.rows() != rows || block.rows.cols() != form.columns)
      return fmt::format("`{}` is {} x {}, in the scene {} x {}", block.name, block.rows.rows(), block.rows.cols(),
                         rows, form.columns);
    if (const auto value = wrong_value(block.rows, form))
      return fmt::format("`{}` has the value {:g}, which it has in no scene", block.name, *value);
  }
  return {};
}

}  // namespace selvedge
