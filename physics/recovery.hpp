#pragma once

#include "collision/exemption.hpp"
#include "collision/intersections.hpp"
#include "collision/separation.hpp"

namespace selvedge {

// What a step that starts tangled does first: `untangle` says where the cloth should be, and every vertex that may move
// goes there by at most `reach` [m], through no obstacle that it was clean of. Cloth that is tangled with cloth gets no
// linear momentum of it: one side goes against the other. `left` is what is still tangled then, for contact to leave
// alone, and `gained` what the solve must not lose again, how far the sides have come against each other, or a vertex
// against an obstacle: what springs back gets nowhere, and what holds it pulls the cloth after it.
// Cloth at a part of a body that is switched off (`off`, of the nodes; or empty), since the body crosses itself there,
// can be nowhere: it waits where it is. Cloth that does not cross itself will not do so after.
struct Recovery {
  Exemption left;
  std::vector<Separation> gained;
};
Recovery recover(const ContactWorld&, const Eigen::VectorXd& inverse_mass, double reach, const std::vector<char>& off,
                 Points& nodes);

// Which obstacles cross themselves, in the positions of a step's start or end. Remembers what it was asked last.
class SelfCrossings {
 public:
  explicit SelfCrossings(const ContactWorld& world);  // keeps a reference
  void switch_off(const Points& from, const Points& to, Exemption&);

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
