#include "pipeline/obstacles/tissue_store_hdf5.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"
#include "pipeline/host/bounded_folder.hpp"
#include "pipeline/host/bytes_of.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/write_file.hpp"

namespace selvedge {
namespace {

constexpr std::size_t most_in_store = std::size_t{25} << 20;  // coordinates

const h5::FileForm tissue_form{"selvedge tissue 1", "soft tissue", "docs/bodies.md"};

// All poses on end: the halves of their keys, how many vertices move in each, which, and where they are.
void read_poses(const h5::Fields& file, TissueStore& store) {
  const std::vector<int> keys = file.integers("keys"), counts = file.integers("counts"),
                         vertices = file.integers("vertices");
  const Points x = file.points("positions");
  if (keys.size() != 2 * counts.size() || static_cast<Eigen::Index>(vertices.size()) != x.rows() || !x.allFinite())
    file.fail("counts", "does not fit the other fields");
  std::ptrdiff_t at = 0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] < 0 || counts[k] > std::ssize(vertices) - at)
      file.fail("counts", "asks for more vertices than there are");
    const std::uint64_t key =
        std::uint64_t{static_cast<std::uint32_t>(keys[2 * k])} << 32 | static_cast<std::uint32_t>(keys[2 * k + 1]);
    store.poses[key] = {{vertices.begin() + at, vertices.begin() + at + counts[k]}, x.middleRows(at, counts[k])};
    at += counts[k];
  }
  store.numbers = static_cast<std::size_t>(x.size());
}

}  // namespace

TissueStore read_tissue_store(const std::filesystem::path& cache, std::uint64_t performance) {
  TissueStore store;
  if (cache.empty()) return store;
  store.file = cache / "tissue" / fmt::format("{:016x}.h5", performance);
  std::error_code ignored;
  if (!std::filesystem::exists(store.file, ignored)) return store;
  try {
    read_poses(h5::Fields(store.file, tissue_form), store);
    mark_used(store.file);
  } catch (const Error&) {  // they are computed anew
    store.poses.clear();
  }
  return store;
}

std::optional<Points> known_tissue(const TissueStore& store, const Points& skinned) {
  const auto found = store.poses.find(hash_of(bytes_of(skinned)));
  if (found == store.poses.end()) return {};
  const TissueStore::Pose& pose = found->second;
  const auto is_vertex = [&](int v) { return v >= 0 && v < skinned.rows(); };
  if (!std::ranges::all_of(pose.vertices, is_vertex)) return {};
  Points given = skinned;
  given(pose.vertices, Eigen::all) = pose.x;
  return given;
}

void keep_tissue(const Points& skinned, const Points& given, TissueStore& store) {
  TissueStore::Pose pose;
  for (int v = 0; v < skinned.rows(); ++v)
    if (given.row(v) != skinned.row(v)) pose.vertices.push_back(v);
  pose.x = given(pose.vertices, Eigen::all);
  const auto count = static_cast<std::size_t>(pose.x.size());
  if (store.numbers + count > most_in_store) return;
  store.numbers += count;
  store.grown = true;
  store.poses[hash_of(bytes_of(skinned))] = std::move(pose);
}

void write_tissue_store(TissueStore& store, std::uintmax_t most) {
  if (store.file.empty() || !std::exchange(store.grown, false)) return;
  std::vector<int> keys, counts, vertices;
  Points x(static_cast<Eigen::Index>(store.numbers / 3), 3);
  Eigen::Index at = 0;
  for (const auto& [key, pose] : store.poses) {
    keys.push_back(static_cast<int>(key >> 32));
    keys.push_back(static_cast<int>(key & 0xffffffffu));
    counts.push_back(static_cast<int>(pose.vertices.size()));
    vertices.insert(vertices.end(), pose.vertices.begin(), pose.vertices.end());
    x.middleRows(at, pose.x.rows()) = pose.x;
    at += pose.x.rows();
  }
  write_cached(store.file, [&] {
    h5::write_form(store.file, tissue_form, [&](const h5::File& file) {
      h5::write_integers(file, "keys", keys);
      h5::write_integers(file, "counts", counts);
      h5::write_integers(file, "vertices", vertices);
      h5::write_points(file, "positions", x);
    });
  });
  keep_within(store.file.parent_path(), most);
}

}  // namespace selvedge
