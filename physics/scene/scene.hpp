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

struct Material {
  std::string name = "cotton";
  double density = 0.2;  // areal [kg/m2]
  MembraneModel membrane = MembraneModel::stvk;
  double lame_mu = 384.6;           // membrane Lame coefficients, thickness included [N/m]
  double lame_lambda = 329.7;       // (E h = 1000 N/m, nu = 0.3, plane stress)
  double warp = 1000, weft = 1000;  // Baraff-Witkin stretch stiffness along u and v [N/m]
  double shear = 400;               // Baraff-Witkin shear stiffness [N/m]
  BendingModel bending_model = BendingModel::curvature;
  double bending = 1e-5;  // B, bending stiffness per width [N m]; for hinge: the papers' coefficient
  HingeLength hinge_length = HingeLength::rest;
  double stiffness_damping = 0;  // Rayleigh: damping force = -(stiffness_damping * K + mass_damping * M) v; [s]
  double mass_damping = 0;       // [1/s]
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

struct Wind {
  bool on = false;
  double air_density = 1.2;  // [kg/m3]
  double drag = 1.0;         // coefficient along the normal wind
  double lift = 0.0;         // coefficient of the tangential part
};

// Joins two vertices of the same cloth or of different ones, as a button does. It resists both extension and
// compression.
struct Spring {
  int a = 0, b = 0;        // vertices of the scene
  double rest_length = 0;  // [m]
  double stiffness = 1e4;  // [N/m]
};

struct ContactSettings {
  double thickness = 2e-3;     // distance between resting layers [m]
  double friction = 0.3;       // cloth on obstacle
  double self_friction = 0.3;  // cloth on cloth
  bool self = true;            // false: cloth-cloth contact is left out and not audited
  bool rigid_zones = false;    // impact zones of cloth alone move as rigid bodies
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
