#pragma once

#include <filesystem>
#include <string_view>

#include "pipeline/exports/animated_surfaces.hpp"
#include "pipeline/formats/xdmf.hpp"

namespace selvedge {

struct ExportRequest {
  std::filesystem::path trajectory;
  std::string format = "obj";                         // the name of an ExportFormat, with which files end
  std::filesystem::path out;                          // folder
  bool obstacles = false;                             // also the obstacles, each under its own name
  std::function<void(int done, int all)> progress{};  // of frames read, over all passes; may be empty

  std::filesystem::path file(const std::string& name) const;  // of the folder, which it makes
  std::filesystem::path one_file() const;                     // of the trajectory's name
};

// Writes a run, and returns the files in order. Throws Error for a file that cannot be written.
using WriteExport = std::vector<std::filesystem::path>(const AnimatedSurfaces&, const ExportRequest&);

WriteExport export_meshes;        // mesh_frames.cpp: a mesh a surface and frame, obj or ply
WriteExport export_point_caches;  // point_cache.cpp: a mesh of frame 0 and a cache a surface, pc2 or mdd

// glTF 2.0, binary: a mesh a surface, a morph target a frame, and one animation that goes from each to the next. Each
// position is a whole number on a grid of 65,534 steps along the longest side of the box that the surface fills over
// the run (KHR_mesh_quantization), so that it is off by at most 8e-6 of that side: 8 bytes a vertex and frame. Surfaces
// that never move have no targets. Normals are left to the reader. Throws Error for positions that are not finite and a
// file beyond the 4 GiB of the format.
WriteExport export_glb;

// USD as text: a Mesh a surface below the Xform `run`, metres, Y up, a time sample of `points` a frame, rounded to a
// micrometre. Cloths carry the schema of deformable surfaces that the AOUSD proposes and newton reads, obstacles that
// of colliders. Surfaces that never move have one value. The text is streamed, a surface after the other. Throws Error
// for positions that are not finite.
WriteExport export_usda;

struct ExportFormat {
  std::string_view name, about;
  bool each_cloth;                         // a surface a cloth, unless seams join two; false: all cloths are one
  int (*reads)(int surfaces, int frames);  // so often the positions of a frame are read
  WriteExport* write;
};

// All formats that `selvedge export` writes; docs/export.md says more of each. How to add one: docs/extending.md.
inline constexpr ExportFormat export_formats[]{
    {"obj", "a mesh a frame", false, [](int, int frames) { return frames; }, export_meshes},
    {"ply", "a mesh a frame", false, [](int, int frames) { return frames; }, export_meshes},
    {"pc2", "a point cache", false, [](int surfaces, int frames) { return surfaces * (frames + 1); },
     export_point_caches},
    {"mdd", "a point cache", false, [](int surfaces, int frames) { return surfaces * (frames + 1); },
     export_point_caches},
    {"glb", "glTF", true, [](int, int frames) { return 2 * frames; }, export_glb},
    {"usda", "USD", true, [](int surfaces, int frames) { return surfaces * frames; }, export_usda},
    {"xdmf", "a sidecar of the trajectory", false, [](int, int) { return 0; },
     [](const AnimatedSurfaces&, const ExportRequest& request) {
       return std::vector<std::filesystem::path>{write_xdmf(request.trajectory)};
     }}};

}  // namespace selvedge
