#pragma once

#include <string>

#include "collision/contact/resolve.hpp"
#include "collision/search/intersections.hpp"
#include "physics/scene/scene.hpp"

namespace selvedge {

// When the response to a motion is given up (ContourCraft's released code). Zero: never for that reason.
struct SafeguardOptions {
  int largest_zone = 30;          // vertices of an impact zone
  double largest_impulse = 5e-2;  // that a vertex is moved by it [m]
  int most_contacts = 2000;       // of the motion as proposed
  double thickness = 2e-3;        // of cloth [m]
};

struct SafeguardReport {
  bool kept = true;
  std::string why;  // it was given up; empty: it was not
  int impulses = 0, zones = 0;
};

// Keeps cloth free of intersections with itself: applies the impulses and impact zones of Bridson, Fedkiw and Anderson
// 2002 to a proposed motion. Obstacles are ignored. Keeps a reference to the scene.
class Safeguard {
 public:
  explicit Safeguard(const Scene&, const SafeguardOptions& = {});
  // Changes `to` so that the straight motion from -> to meets nothing; where it gives up, `to` is undefined. It also
  // gives up where `from` intersects itself.
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
