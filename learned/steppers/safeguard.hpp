#pragma once

#include <string>

#include "collision/contact/resolve.hpp"
#include "collision/search/intersections.hpp"
#include "physics/scene/scene.hpp"

namespace selvedge {

// Limits beyond which the response to a motion is given up (ContourCraft's released code). Zero: no limit.
struct SafeguardOptions {
  int largest_zone = 30;          // vertices of an impact zone
  double largest_impulse = 5e-2;  // motion of a vertex [m]
  int most_contacts = 2000;       // contacts of the proposed motion
  double thickness = 2e-3;        // of cloth [m]
};

struct SafeguardReport {
  bool kept = true;
  std::string why;  // reason for giving up; empty: none
  int impulses = 0, zones = 0;
};

// Keeps cloth free of intersections with itself: applies the impulses and impact zones of Bridson, Fedkiw and Anderson
// 2002 to a proposed motion. Obstacles are ignored. Keeps a reference to the scene.
class Safeguard {
 public:
  explicit Safeguard(const Scene&, const SafeguardOptions& = {});
  // Changes `to` so that nothing meets on the straight motion from -> to. Gives up also where `from` intersects itself;
  // then `to` is undefined.
  SafeguardReport operator()(const Points& from, Points& to);

 private:
  SafeguardReport respond(const Points& from, Points& to);

  SafeguardOptions options_;
  ResolveOptions resolve_;
  const Surface& surface_;
  ContactWorld world_;
  PairSearch search_;
  Eigen::VectorXd inverse_mass_;
  PathPairs path_;
  IntersectionCache intersections_;
};

}  // namespace selvedge
