#pragma once

#include <optional>

#include "collision/contact/exemption.hpp"
#include "collision/search/intersections.hpp"
#include "collision/untangle/separation.hpp"
#include "physics/recovery/recovery_options.hpp"
#include "physics/recovery/untangling_budget.hpp"

namespace selvedge {

// What contact leaves alone of cloth that crosses itself almost everywhere, such as a sheet that starts in one point:
// no side can be told, and its own stiffness has to open it first. Absent for other cloth.
std::optional<Exemption> too_tangled(const ContactWorld&, const Points& nodes, const RecoveryOptions&);

// The first part of a step that starts tangled. `untangle` says where the cloth should be. Every vertex that may move
// goes there by at most `reach` [m], and not through an obstacle of which it was clean. Cloth that is tangled with
// cloth gets no linear momentum: the two sides move against each other. `left_alone` is what is still tangled then, for
// contact to leave alone. The solve must keep the `separations`: how far the two sides, or a vertex and an obstacle,
// have come apart. Otherwise cloth would spring back and untangling would get nowhere.
// Trapped cloth has no way out of an obstacle yet. It is cloth tangled with obstacles that is drawn (`drawn`, see
// drawn.hpp; or empty) or crosses switched-off parts of a body, and tangled cloth that is connected to it.
// Trapped and drawn cloth is parted from cloth but not from obstacles. The cloth does not cross itself in more pairs
// than before. `before`: what is tangled (find_exemption) and switched off. Without a budget an ample one is used.
struct Recovery {
  Exemption left_alone;
  std::vector<Separation> separations;
  bool stuck = false;         // untangling finds no way to part anything: nothing was moved
  std::vector<char> trapped;  // 1 for trapped vertices, or empty
};
Recovery recover(const ContactWorld&, const Eigen::VectorXd& inverse_mass, double reach, const Exemption& before,
                 const std::vector<char>& drawn, Points& nodes, UntanglingBudget* = nullptr,
                 const RecoveryOptions& = {});

// Finds obstacles that cross themselves at a step's start or end, and the cloth that is caught there (caught.hpp).
// `apart`, by obstacle: 1 for those that are known not to cross themselves at its end; empty: nothing is known. Caches
// the answers for the last positions.
class SelfCrossings {
 public:
  explicit SelfCrossings(const ContactWorld& world);  // keeps a reference
  void switch_off(const Points& from, const Points& to, const Points& targets, Exemption&,
                  const std::vector<char>& apart = {});

 private:
  struct Known {
    Points x;
    bool crosses = false;
    IntersectionCache cache;
  };
  bool crosses(int obstacle, const Points& nodes, bool apart, Known&);

  const ContactWorld& world_;
  std::vector<std::array<Known, 2>> known_;
};

}  // namespace selvedge
