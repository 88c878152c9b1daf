#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "physics/scene/memory.hpp"
#include "pipeline/drapes/drape_set.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"

namespace selvedge {
namespace {

const h5::FileForm path_form{"selvedge drapes 1", "path of drapes", "docs/repulsion.md"};

std::vector<Points> parts_of(const h5::Fields& fields, const std::string& name, int rows) {
  const Points all = fields.points(name);
  if (rows < 1 || all.rows() % rows != 0)
    fields.fail(name, fmt::format("has {} rows, not a multiple of {}", all.rows(), rows));
  std::vector<Points> parts;
  for (Eigen::Index k = 0; k < all.rows() / rows; ++k) parts.push_back(all.middleRows(k * rows, rows));
  return parts;
}

}  // namespace

void write_drape_path(const std::filesystem::path& file, const DrapePath& path) {
  h5::write_form(file, path_form, [&](const h5::File& to) {
    h5::write_numbers(to, "shape", {path.shape.begin(), path.shape.end()});
    h5::write_numbers(to, "style", {path.style.begin(), path.style.end()});
    if (!path.x.empty()) {
      h5::write_points(to, "rotations", joined_rows(path.rotations));
      h5::write_points(to, "x", joined_rows(path.x));
    }
    std::vector<std::string> reasons;
    std::vector<int> counts;
    for (const auto& [reason, count] : path.dropped) {
      reasons.push_back(reason);
      counts.push_back(count);
    }
    if (!reasons.empty()) {
      to.write_texts("dropped_reasons", reasons);
      h5::write_integers(to, "dropped_counts", counts);
    }
    h5::write_numbers(to, "seconds", {path.seconds});
    h5::write_integers(to, "poses_redrawn", {path.poses_redrawn});
  });
}

DrapePath read_drape_path(const std::filesystem::path& file, int joints, int vertices) {
  const h5::Fields fields(file, path_form);
  DrapePath path;
  const std::vector<double> shape = fields.numbers("shape"), style = fields.numbers("style");
  path.shape = Eigen::Map<const Eigen::VectorXd>(shape.data(), static_cast<Eigen::Index>(shape.size()));
  if (style.size() != path.style.size()) fields.fail("style", fmt::format("has {} numbers, not 4", style.size()));
  std::copy(style.begin(), style.end(), path.style.begin());
  if (fields.has("x")) {
    path.rotations = parts_of(fields, "rotations", joints);
    path.x = parts_of(fields, "x", vertices);
    if (path.rotations.size() != path.x.size()) fields.fail("x", "has another number of drapes than `rotations`");
  }
  if (fields.has("dropped_reasons")) {
    const std::vector<std::string> reasons = fields.texts("dropped_reasons");
    const std::vector<int> counts = fields.integers("dropped_counts");
    if (counts.size() != reasons.size()) fields.fail("dropped_counts", "has another length than `dropped_reasons`");
    for (std::size_t k = 0; k < reasons.size(); ++k) path.dropped[reasons[k]] = counts[k];
  }
  const std::vector<double> seconds = fields.numbers("seconds");
  const std::vector<int> redrawn = fields.integers("poses_redrawn");
  if (seconds.size() != 1 || redrawn.size() != 1) fields.fail("seconds", "is not one number");
  path.seconds = seconds[0];
  path.poses_redrawn = redrawn[0];
  return path;
}

std::filesystem::path drape_path_file(const std::filesystem::path& folder, int number) {
  return folder / fmt::format("path_{:04d}.h5", number);
}

DrapeSet read_drape_set(const std::filesystem::path& folder) {
  const std::filesystem::path config = folder / "config.yaml";
  if (!std::filesystem::exists(config))
    throw Error("there are no drapes", folder.string(), "make them with `selvedge dataset configs/data/drape.yaml`");
  DrapeSet set{make_drape_world(read_drape_options(config)), {}, {}};
  const DrapeOptions& options = set.world.options;
  const auto joints = static_cast<int>(set.world.body.joints.size());
  for (int k = 0; k < options.training + options.test; ++k) {
    if (!std::filesystem::exists(drape_path_file(folder, k)))
      throw Error("path " + std::to_string(k) + " of the drapes is missing", folder.string(),
                  "repeat the `selvedge dataset` that began them");
    (k < options.training ? set.training : set.test)
        .push_back(read_drape_path(drape_path_file(folder, k), joints, set.world.surface.vertex_count));
  }
  return set;
}

}  // namespace selvedge
