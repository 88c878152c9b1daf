#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

struct FitRegion {
  std::string name;
  Vec3 axis = Vec3::UnitY();  // along which the limb runs, unit length: girths are taken across it; zero: none are
};

// Parts of a body's surface.
struct FitRegions {
  std::vector<FitRegion> regions;
  std::vector<int> of_vertex;  // one a vertex of the body: its region, -1: none
};

// A region a joint: the vertices of which it has the largest weight. Joints of the SMPL family get tailors' words
// (`left_hip` the left thigh); the axis goes from the joint to its children, or from its parent. `joints`: where they
// are in the frame, joints x 3 [m].
FitRegions regions_by_weights(const BodyModel&, const Points& joints);

// From a JSON object of lists of vertices, as GarmentCode's ggg_body_segmentation.json: a vertex of several regions is
// of the first. Axes are the directions in which regions are longest at `body` [m]. Throws Error for what is no such
// object and for a vertex that the body does not have.
FitRegions regions_of_file(const std::filesystem::path&, const Points& body);

// All of the body as one.
FitRegions whole_body(const Points& body);

}  // namespace selvedge
