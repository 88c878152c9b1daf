#pragma once

#include <set>
#include <string>

#include "pipeline/exports/export_materials.hpp"
#include "pipeline/exports/moved_normals.hpp"

namespace selvedge {

// Names of prims side by side: letters, digits and underscores, each other than those that were given before.
struct PrimNames {
  std::set<std::string> taken = {};
  std::string operator()(const std::string& name);
};

// The materials below the prim `run`, in a scope `Looks`, and where each is: /run/Looks/cotton. Empty texts where there
// are none.
struct UsdMaterials {
  std::string text;
  std::vector<std::string> paths;
};
UsdMaterials usd_materials(const ExportMaterials&);

// "(0, 0, 1), ..." with so many digits after the point.
std::string usd_rows(const PointsF& rows, int digits);

// The fields of a mesh with a look, but points and normals: faces, texture coordinates, and subsets of faces by
// material and by part. materials: the paths of the look's materials.
std::string usd_look_text(const Look&, const std::vector<std::string>& materials);
// The declaration of its normals and their indices; values come as time samples.
std::string usd_normals_text(const NormalSlots&);

}  // namespace selvedge
