#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// The soft tissue of a body in a clip, kept in a file of `tissue` in a cache folder, so that a second run or training
// need not compute it. A pose is known by all bits of its skinned positions: what is read is what would be computed, to
// the bit.
struct TissueStore {
  // The vertices of a pose that soft tissue moves, and where they then are [m].
  struct Pose {
    std::vector<int> vertices;
    Points x;
  };
  std::filesystem::path file;
  std::map<std::uint64_t, Pose> poses;  // by a hash of the skinned positions
  std::size_t numbers = 0;              // coordinates that the poses hold
  bool grown = false;                   // since the file was read
};

// The store of a body and clip, named by a hash of both, in the cache folder; without poses if it has no file that can
// be read. Without a folder it is never written.
TissueStore read_tissue_store(const std::filesystem::path& cache, std::uint64_t performance);

// The pose with its soft tissue, if the store has it.
std::optional<Points> known_tissue(const TissueStore&, const Points& skinned);
// Keeps a computed pose, unless the store is full (200 MB).
void keep_tissue(const Points& skinned, const Points& given, TissueStore&);

// Writes a store that has grown. Then takes away the files of its folder that were used longest ago, until it has no
// more than `most` bytes. A folder that cannot be written throws Error.
constexpr std::uintmax_t most_kept_tissue = std::uintmax_t{3} << 30;
void write_tissue_store(TissueStore&, std::uintmax_t most = most_kept_tissue);

}  // namespace selvedge
