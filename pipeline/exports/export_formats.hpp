#pragma once

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "pipeline/exports/animated_surfaces.hpp"
#include "pipeline/hdf5/xdmf.hpp"

namespace selvedge {

struct ExportRequest {
  std::filesystem::path trajectory;
  std::string format = "obj";                         // the name of an ExportFormat, with which files end
  std::filesystem::path out;                          // folder
  bool obstacles = false;                             // also the obstacles, each under its own name
  std::function<void(int done, int all)> progress{};  // of frames read, over all passes; may be empty
  std::filesystem::path onto = {};  // a mesh (OBJ, PLY) at the rest shape of cloths, which takes their place
  std::string onto_unit = "m";      // unit of its coordinates
  std::function<void(const std::string&)> warn = {};  // gets what cannot be read in that mesh; may be empty
  std::string cloth = {};                             // the cloth whose place it takes; empty: all

  std::filesystem::path file(const std::string& name) const;  // of the folder, which it makes
  std::filesystem::path one_file() const;                     // of the trajectory's name
};

// Writes a run, and returns the files in order. Throws Error for a file that cannot be written.
using WriteExport = std::vector<std::filesystem::path>(const AnimatedSurfaces&, const ExportRequest&);

// mesh_frames.cpp: obj, one file a frame with an object a cloth; ply, a file a cloth and frame. Obstacles have files of
// their own, one where they never move.
WriteExport export_meshes;
// point_cache.cpp: a mesh of frame 0 and a cache a surface, pc2 or mdd. Surfaces that never move have the mesh alone.
WriteExport export_point_caches;

// glTF 2.0, binary: a mesh a surface, a morph target a frame, and one animation that goes from each to the next. Each
// position is a whole number on a grid of 65,534 steps along the longest side of the box that the surface fills over
// the run (KHR_mesh_quantization), so that it is off by at most 8e-6 of that side: 8 bytes a vertex and frame. Surfaces
// that never move have no targets. Surfaces with a look have its texture coordinates and materials, a primitive a part
// and material, and normals of every frame where it has normals; the vertices of its file come first, in its order, and
// those that texture and normals split follow. Others leave normals to the reader. Throws Error for positions that are
// not finite and a file beyond the 4 GiB of the format.
WriteExport export_glb;

// USD as text: a Mesh a surface below the Xform `run`, metres, Y up, a time sample of `points` a frame, rounded to a
// micrometre. Cloths carry the schema of deformable surfaces that the AOUSD proposes and newton reads, obstacles that
// of colliders. Surfaces with a look have the vertices, faces, texture coordinates, materials and parts of its file,
// and normals of every frame where it has normals. Surfaces that never move have one value. The text is streamed, a
// surface after the other. Throws Error for positions that are not finite.
WriteExport export_usda;

struct ExportFormat {
  std::string_view name, about;
  int (*reads)(const AnimatedSurfaces&);  // so often the positions of a frame are read
  WriteExport* write;
};

// Point caches read all frames for every surface that moves, and frame 0 for the meshes. USD reads frame 0 of each
// surface that does not, and all frames once more for normals.
inline int reads_of_point_caches(const AnimatedSurfaces& run) {
  return 1 + run.frame_count * static_cast<int>(std::ranges::count_if(run.surfaces, &AnimatedSurface::moving));
}
inline int reads_of_usda(const AnimatedSurfaces& run) {
  int reads = 0;
  for (const AnimatedSurface& surface : run.surfaces)
    reads += (surface.moving ? run.frame_count : 1) * (surface.look.corner_normal.empty() ? 1 : 2);
  return reads;
}

// All formats that `selvedge export` writes; docs/export.md says more of each. How to add one: docs/extending.md.
inline constexpr ExportFormat export_formats[]{
    {"obj", "one mesh for each frame", [](const AnimatedSurfaces& run) { return run.frame_count; }, export_meshes},
    {"ply", "one mesh for each frame", [](const AnimatedSurfaces& run) { return run.frame_count; }, export_meshes},
    {"pc2", "a point cache", reads_of_point_caches, export_point_caches},
    {"mdd", "a point cache", reads_of_point_caches, export_point_caches},
    {"glb", "glTF", [](const AnimatedSurfaces& run) { return 2 * run.frame_count; }, export_glb},
    {"usda", "USD", reads_of_usda, export_usda},
    {"xdmf", "a file beside the trajectory for ParaView", [](const AnimatedSurfaces&) { return 0; },
     [](const AnimatedSurfaces&, const ExportRequest& request) {
       return std::vector<std::filesystem::path>{write_xdmf(request.trajectory)};
     }}};

}  // namespace selvedge
