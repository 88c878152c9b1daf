#include <fmt/format.h>

#include <algorithm>

#include "pipeline/exports/export_formats.hpp"
#include "pipeline/exports/obj_objects.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/host/write_file.hpp"

namespace selvedge {
namespace {

// Surfaces that go into one file a frame.
struct Batch {
  std::string file;
  std::size_t first = 0, count = 1;
  bool moving = true;
  std::string materials = {};  // the name of its .mtl file; empty: it has none
};

// All cloths are objects of one OBJ; PLY has no objects.
std::vector<Batch> batches_of(const std::vector<AnimatedSurface>& surfaces, bool objects) {
  std::vector<Batch> batches;
  const auto cloths = static_cast<std::size_t>(std::ranges::count_if(surfaces, &AnimatedSurface::cloth));
  if (objects && cloths > 0) batches.push_back({"cloth", 0, cloths});
  for (std::size_t s = objects ? cloths : 0; s < surfaces.size(); ++s)
    batches.push_back({surfaces[s].file, s, 1, surfaces[s].moving});
  return batches;
}

}  // namespace

std::filesystem::path ExportRequest::file(const std::string& name) const {
  make_folder(out);
  return out / name;
}

std::filesystem::path ExportRequest::one_file() const { return file(trajectory.stem().string() + "." + format); }

std::vector<std::filesystem::path> export_meshes(const AnimatedSurfaces& run, const ExportRequest& request) {
  const bool objects = request.format != "ply";
  const std::span<const AnimatedSurface> all(run.surfaces);
  std::vector<Batch> batches = batches_of(run.surfaces, objects);
  std::vector<std::filesystem::path> written;
  for (Batch& batch : batches) {
    const std::string text = objects ? objects_materials(all.subspan(batch.first, batch.count)) : "";
    if (text.empty()) continue;
    batch.materials = batch.file + ".mtl";
    written.push_back(request.file(batch.materials));
    write_file(written.back(), text);
  }
  const std::vector<NormalSlots> slots = objects ? normal_slots(all) : std::vector<NormalSlots>{};
  for (int i = 0; i < run.frame_count; ++i) {
    const std::vector<PointsF> x = run.frame(i);
    for (const Batch& batch : batches) {
      if (i > 0 && !batch.moving) continue;
      written.push_back(request.file(fmt::format("{}_{:05}.{}", batch.file, i, request.format)));
      if (objects)
        write_file(written.back(), objects_text(all.subspan(batch.first, batch.count),
                                                std::span(slots).subspan(batch.first, batch.count),
                                                std::span(x).subspan(batch.first, batch.count), batch.materials));
      else
        write_ply(written.back(), x[batch.first].cast<double>(), all[batch.first].triangles);
    }
  }
  return written;
}

}  // namespace selvedge
