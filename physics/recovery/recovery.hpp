#pragma once

#include <optional>

#include "collision/contact/exemption.hpp"
#include "collision/search/intersections.hpp"
#include "collision/untangle/separation.hpp"
#include "physics/recovery/recovery_options.hpp"
#include "physics/recovery/untangling_budget.hpp"

namespace selvedge {

// What contact leaves alone of cloth that crosses itself through and through, a sheet that starts in one point say: it
// has no sides to go to, and its own stiffness opens it first. Absent where it does not.
std::optional<Exemption> hopeless(const ContactWorld&, const Points& nodes, const RecoveryOptions&);

// What a step that starts tangled does first: `untangle` says where the cloth should be, and every vertex that may move
// goes there by at most `reach` [m], through no obstacle that it was clean of. Cloth that is tangled with cloth gets no
// linear momentum of it: one side goes against the other. `left` is what is still tangled then, for contact to leave
// alone, and `gained` what the solve must not lose again, how far the sides have come against each other, or a vertex
// against an obstacle: what springs back gets nowhere, and what holds it pulls the cloth after it.
// Cloth that is carried (carrying.hpp; or empty) and what is tangled together with it, and tangled cloth at a part of a
// body that is switched off, waits: it is parted from cloth but not from obstacles. Cloth that does not cross itself
// will not do so after, and cloth that does crosses itself in no more pairs. `before` is what is tangled, as
// find_exemption has it, and what is switched off. No budget: an ample one.
struct Recovery {
  Exemption left;
  std::vector<Separation> gained;
  bool stuck = false;       // untangling knows no way out of any of it: all is where it was
  std::vector<char> waits;  // 1 for vertices that wait, or empty
};
Recovery recover(const ContactWorld&, const Eigen::VectorXd& inverse_mass, double reach, const Exemption& before,
                 const std::vector<char>& carried, Points& nodes, UntanglingBudget* = nullptr,
                 const RecoveryOptions& = {});

// Which obstacles cross themselves, in the positions of a step's start or end, and what cloth is caught there
// (caught.hpp). Remembers what it was asked last.
class SelfCrossings {
 public:
  explicit SelfCrossings(const ContactWorld& world);  // keeps a reference
  void switch_off(const Points& from, const Points& to, const Points& worn, Exemption&);

 private:
  struct Known {
    Points x;
    bool crosses = false;
    IntersectionCache cache;
  };
  bool crosses(int obstacle, const Points& nodes, Known&);

  const ContactWorld& world_;
  std::vector<std::array<Known, 2>> known_;
};

}  // namespace selvedge
