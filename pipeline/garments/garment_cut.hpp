#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "pipeline/bodies/mannequin_form.hpp"
#include "pipeline/garments/garment.hpp"
#include "pipeline/shapes/border.hpp"
#include "pipeline/shapes/implicit_form.hpp"

namespace selvedge {

// Linear between points (coordinate, value), constant beyond them.
using Profile = std::vector<std::array<double, 2>>;
double at(const Profile&, double coordinate);

// The depth of edges of this length below a surface as round as a limb, if they join points on it [m].
double sagitta(double edge);

// An end of a garment: the part beyond the border is cut away. Paired openings are cut on both sides of x = 0 and named
// _left and _right.
struct Opening {
  std::string group;
  Border border;
  bool paired = false;
  std::function<Border(double)> widened = {};  // for round ones: the border at a larger distance from the neck [m]
};

// A patch on the front, stitched on along its sides and its lower edge.
struct Pocket {
  Vec2 centre, size;  // seen from the front: x and height [m]
};

// A garment as a surface round the mannequin's form, above the floor y = 0 [m]: where the value of the limbs that it
// covers, merged with lofts of its own, equals the ease.
struct GarmentCut {
  std::string name = {};
  Fit fit = Fit::loose;
  std::vector<MannequinLimb> limbs = {};
  std::vector<Part> lofts = {};
  Profile ease = {};         // from body to cloth over height
  Profile sleeve_ease = {};  // over the distance from the middle, on the arms
  std::vector<Opening> openings = {};
  std::string pinned = {};  // the group that stays with the body; empty: it hangs from the shoulders
  bool legs_apart = false;  // however loose they are
  double collar = 0;        // width of the turn-down collar [m]; 0: none
  std::vector<Pocket> pockets = {};
};

// All cuts, from T-shirt to jacket, in a fixed order with unique names.
const std::vector<GarmentCut>& garment_cuts();

}  // namespace selvedge
