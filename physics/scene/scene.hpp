#pragma once

#include <span>
#include <string>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

enum class MembraneModel { stvk, stable_neo_hookean, baraff_witkin };  // membrane.hpp has their sources
enum class BendingModel { curvature, hinge };
// The edge length that weights a hinge: that of the rest shape, or the present one as in HOOD's and ContourCraft's
// losses.
enum class HingeLength { rest, current };

// What a cloth is made of. Members are described where keys are bound to them: pipeline/scene/config_cloth.cpp.
struct Material {
  std::string name = "cotton";
  double density = 0.2;
  MembraneModel membrane = MembraneModel::stvk;
  double lame_mu = 384.6, lame_lambda = 329.7;
  double warp = 1000, weft = 1000, shear = 400;
  BendingModel bending_model = BendingModel::curvature;
  double bending = 1e-5;
  HingeLength hinge_length = HingeLength::rest;
  double stiffness_damping = 0, mass_damping = 0;
};

// Where a cloth lies in the joint numbering of Scene::surface.
struct Cloth {
  std::string name;
  Material material;
  int first_vertex = 0, vertex_count = 0;
  int first_triangle = 0, triangle_count = 0;
};

// Rest shape of a triangle flattened into its own plane: corners as columns u, v [m].
using RestTriangle = Eigen::Matrix<double, 2, 3>;

struct Obstacle {
  std::string name;
  Surface surface;
  bool moving = false;
};

// The air round the cloth. Members are described where keys are bound to them: pipeline/scene/config_scene.cpp.
struct Wind {
  bool on = false;
  double air_density = 1.2;
  double drag = 1.0, lift = 0.0;
};

// Joins two vertices of the same cloth or of different ones, as a button does. It resists both extension and
// compression. Members are described where keys are bound to them: pipeline/scene/config_sewing.cpp.
struct Spring {
  int a = 0, b = 0;        // vertices of the scene
  double rest_length = 0;  // [m]
  double stiffness = 1e4;
};

// Contact of cloth with itself and with obstacles. Members are described where keys are bound to them:
// pipeline/scene/config_scene.cpp.
struct ContactSettings {
  double thickness = 2e-3;
  double friction = 0.3, self_friction = 0.3;
  bool self = true;
  bool rigid_zones = false;
};

// Constant during a run. All cloths are one surface: vertices and triangles numbered cloth after cloth.
struct Scene {
  std::vector<Cloth> cloths;
  Surface surface;
  Points rest;  // one row a vertex [m]; for lengths and angles that need 3D (curved rest shapes)
  std::vector<RestTriangle> rest_triangle;  // one a triangle; the metric of the rest shape
  bool rest_is_flat = true;                 // no rest angles, no rest curvature
  std::vector<int> pins;                    // vertices with prescribed positions, ascending
  std::vector<Spring> springs;
  std::vector<Obstacle> obstacles;
  ContactSettings contact;
  Wind wind;
};

RestTriangle flatten(const Vec3& a, const Vec3& b, const Vec3& c);  // a in the origin, b on the u axis
double area(const RestTriangle&);                                   // signed [m2]; positive for flatten()

// Lumped mass of every vertex [kg]: a third of each triangle's rest area times its cloth's density.
Eigen::VectorXd lumped_masses(const Scene&);

// Inverse masses of all nodes of cloth and obstacles [1/kg]; 0 for pins, vertices without mass and obstacles, whose
// positions are prescribed.
Eigen::VectorXd inverse_masses(const Scene&, int node_count);

double smallest_altitude(const RestTriangle&);           // [m]; 0 for a triangle without extent
double mean_edge_length(std::span<const RestTriangle>);  // [m]; 0 without triangles
double mean_edge_length(const Scene&);                   // of all triangles at rest [m]

std::vector<const Surface*> obstacle_surfaces(const Scene&);  // of the scene, which must outlive them

}  // namespace selvedge
