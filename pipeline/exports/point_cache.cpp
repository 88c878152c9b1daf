#include "pipeline/exports/point_cache.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#include "pipeline/exports/export_formats.hpp"
#include "pipeline/exports/obj_objects.hpp"
#include "pipeline/host/growing_file.hpp"
#include "pipeline/host/write_file.hpp"

namespace selvedge {
namespace {

static_assert(std::endian::native == std::endian::little, "PC2 is little-endian");

// Appends four bytes, in reverse for MDD.
template <class Value>
void put_word(std::string& bytes, Value value, bool big_endian) {
  static_assert(sizeof value == 4);
  char word[4];
  std::memcpy(word, &value, 4);
  if (big_endian) std::reverse(word, word + 4);
  bytes.append(word, 4);
}

void put_points(std::string& bytes, const PointsF& x, bool big_endian) {
  for (Eigen::Index i = 0; i < x.size(); ++i) put_word(bytes, x.data()[i], big_endian);
}

// The header, then the positions of one surface.
void write_cache(const std::filesystem::path& path, const std::string& header, const AnimatedSurfaces& run,
                 std::size_t surface, bool big_endian) {
  GrowingFile file(path);
  file.write(header);
  for (int i = 0; i < run.frame_count; ++i) {
    std::string bytes;
    put_points(bytes, run.frame(i)[surface], big_endian);
    file.write(bytes);
  }
  file.keep();
}

}  // namespace

void write_pc2(const std::filesystem::path& path, const AnimatedSurfaces& run, std::size_t surface) {
  std::string header("POINTCACHE2\0", 12);
  put_word(header, std::int32_t{1}, false);
  put_word(header, std::int32_t{run.surfaces[surface].vertex_count}, false);
  put_word(header, 0.0f, false);
  put_word(header, 1.0f, false);
  put_word(header, std::int32_t{run.frame_count}, false);
  write_cache(path, header, run, surface, false);
}

void write_mdd(const std::filesystem::path& path, const AnimatedSurfaces& run, std::size_t surface) {
  std::string header;
  put_word(header, std::int32_t{run.frame_count}, true);
  put_word(header, std::int32_t{run.surfaces[surface].vertex_count}, true);
  for (int i = 0; i < run.frame_count; ++i) put_word(header, static_cast<float>(i / run.fps), true);
  write_cache(path, header, run, surface, true);
}

std::vector<std::filesystem::path> export_point_caches(const AnimatedSurfaces& run, const ExportRequest& request) {
  const auto write = request.format == "pc2" ? write_pc2 : write_mdd;
  std::vector<std::filesystem::path> written;
  const std::vector<PointsF> first = run.frame(0);
  for (std::size_t s = 0; s < run.surfaces.size(); ++s) {
    const AnimatedSurface& surface = run.surfaces[s];
    const std::string materials = objects_materials({&surface, 1});
    const NormalSlots slots = normal_slots(surface.look);
    if (!materials.empty()) {
      written.push_back(request.file(surface.file + ".mtl"));
      write_file(written.back(), materials);
    }
    written.push_back(request.file(surface.file + ".obj"));
    write_file(written.back(), objects_text({&surface, 1}, {&slots, 1}, {&first[s], 1},
                                            materials.empty() ? "" : surface.file + ".mtl"));
    if (!surface.moving) continue;
    written.push_back(request.file(surface.file + "." + request.format));
    write(written.back(), run, s);
  }
  return written;
}

}  // namespace selvedge
