#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

struct FitRegion {
  std::string name;
  Vec3 axis = Vec3::UnitY();  // direction of the limb, unit length: girths are measured across it; zero: not measured
};

// Parts of a body's surface.
struct FitRegions {
  std::vector<FitRegion> regions;
  std::vector<int> of_vertex;  // of each vertex of the body its region, -1: none
};

// One region per joint: the vertices for which it has the largest weight. Joints of the SMPL family get tailors' words
// (`left_hip` is the left thigh). The axis leads from the joint to its children, or from its parent. `joints`:
// positions in the frame, joints x 3 [m].
FitRegions regions_by_weights(const BodyModel&, const Points& joints);

// Regions from a JSON object of lists of vertices, such as GarmentCode's ggg_body_segmentation.json. A vertex in
// several regions belongs to the first. Axes are the directions in which regions are longest at `body` [m]. Throws
// Error for other JSON and for a vertex that the body lacks.
FitRegions regions_of_file(const std::filesystem::path&, const Points& body);

// The whole body as one region.
FitRegions whole_body(const Points& body);

}  // namespace selvedge
