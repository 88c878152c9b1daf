#pragma once

#include <memory>
#include <string>

#include "collision/contact/resolve.hpp"
#include "collision/search/intersections.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// When the response to a motion is given up (ContourCraft's released code, digest 3.2). Zero: never for that reason.
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

// Keeps a cloth that is free of intersections with itself so: impulses and impact zones of Bridson, Fedkiw and Anderson
// 2002 on a motion that somebody else proposes. Obstacles count for nothing. Keeps a reference to the scene.
class Safeguard {
 public:
  explicit Safeguard(const Scene&, const SafeguardOptions& = {});
  // Changes `to` so that the straight motion from -> to meets nothing; given up, `to` is junk. `from` may not intersect
  // itself: that gives up too.
  SafeguardReport operator()(const Points& from, Points& to);

 private:
  SafeguardOptions options_;
  ResolveOptions resolve_;
  const Surface& surface_;
  ContactWorld world_;
  PairSearch search_;
  Eigen::VectorXd inverse_mass_;
  PathPairs path_;
  IntersectionCache intersections_;
};

// A stepper whose proposals go through a Safeguard. A step that is given up is rejected: the reason `penetrating`, with
// the counts in the report. What a learned stepper carries to the next frame is what the response has left of it. Keeps
// a reference to the scene.
std::unique_ptr<Stepper> make_safeguarded(const Scene&, std::unique_ptr<Stepper>, const SafeguardOptions& = {});

}  // namespace selvedge
