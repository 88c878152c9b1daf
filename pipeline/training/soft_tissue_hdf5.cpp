#include "pipeline/training/soft_tissue_hdf5.hpp"

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/mannequin.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"
#include "pipeline/host/bounded_folder.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/write_file.hpp"

namespace selvedge {
namespace {

const h5::FileForm soft_tissue_form{"selvedge flesh 1", "flesh", "docs/training.md"};

// The name has a hash of body and poses, so that another body or clip has another file.
std::filesystem::path soft_tissue_file(const std::filesystem::path& folder, const TrainingWorld& world,
                                       const TrainingBody& body, const TrainingClip& clip) {
  const Clip& motion = clip.motion;
  const TrainingPerson& person = world.people[static_cast<std::size_t>(body.person)];
  std::string text = fmt::format("{} {} {} {} {}", GiveWay::recipe, mannequin_recipe, person.body.name,
                                 layer_count(world, person), motion.fps);
  for (const double s : body.shape) text += fmt::format(" {:a}", s);
  if (body.tissue_key != 0) text += fmt::format(" of {:x} ", body.tissue_key);
  for (const BodyPose& pose : motion.poses)
    text.append(reinterpret_cast<const char*>(pose.rotations.data()),
                sizeof(double) * static_cast<std::size_t>(pose.rotations.size()));
  return folder / "flesh" / fmt::format("{}-{:016x}.h5", motion.name, hash_of(text));
}

// Writes all frames in one: the number of each frame, the count of its moving vertices, their numbers and motions.
void write_clip(const std::filesystem::path& path, const std::map<int, TissueDisplacements>& given) {
  std::vector<int> frames, counts, vertices;
  Points moves(0, 3);
  Eigen::Index rows = 0;
  for (const auto& [frame, known] : given) rows += known.displacements.rows();
  moves.resize(rows, 3);
  rows = 0;
  for (const auto& [frame, known] : given) {
    frames.push_back(frame);
    counts.push_back(static_cast<int>(known.vertices.size()));
    vertices.insert(vertices.end(), known.vertices.begin(), known.vertices.end());
    moves.middleRows(rows, known.displacements.rows()) = known.displacements.cast<double>();
    rows += known.displacements.rows();
  }
  h5::write_form(path, soft_tissue_form, [&](const h5::File& file) {
    h5::write_integers(file, "frames", frames);
    h5::write_integers(file, "counts", counts);
    h5::write_integers(file, "vertices", vertices);
    h5::write_points(file, "moves", moves);
  });
}

std::map<int, TissueDisplacements> read_clip(const std::filesystem::path& path, int body_vertices) {
  const h5::Fields file(path, soft_tissue_form);
  const std::vector<int> frames = file.integers("frames"), counts = file.integers("counts"),
                         vertices = file.integers("vertices");
  const Points moves = file.points("moves");
  std::map<int, TissueDisplacements> given;
  std::size_t at = 0;
  if (frames.size() != counts.size() || static_cast<Eigen::Index>(vertices.size()) != moves.rows())
    file.fail("counts", "does not fit the other fields");
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto count = static_cast<std::size_t>(std::max(counts[k], 0));
    if (count > vertices.size() - at) file.fail("counts", "asks for more vertices than there are");
    TissueDisplacements& known = given[frames[k]];
    known.vertices.assign(vertices.begin() + static_cast<std::ptrdiff_t>(at),
                          vertices.begin() + static_cast<std::ptrdiff_t>(at + count));
    known.displacements =
        moves.middleRows(static_cast<Eigen::Index>(at), static_cast<Eigen::Index>(count)).cast<float>();
    for (const int v : known.vertices)
      if (v < 0 || v >= body_vertices) file.fail("vertices", "names a vertex that the body lacks");
    at += count;
  }
  return given;
}

}  // namespace

std::map<int, TissueDisplacements> read_soft_tissue(const std::filesystem::path& folder, const TrainingWorld& world,
                                                    const TrainingBody& body, const TrainingClip& clip) {
  if (folder.empty() || !body.soft_tissue) return {};
  const std::filesystem::path path = soft_tissue_file(folder, world, body, clip);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return {};
  try {
    std::map<int, TissueDisplacements> given =
        read_clip(path, world.people[static_cast<std::size_t>(body.person)].surface.vertex_count);
    mark_used(path);
    return given;
  } catch (const Error&) {  // they are computed again
    return {};
  }
}

void write_soft_tissue(const std::filesystem::path& folder, const TrainingWorld& world, std::uintmax_t most) {
  if (folder.empty()) return;
  bool wrote = false;
  for (const TrainingBody& body : world.bodies)
    for (const TrainingClip& clip : body.clips) {
      if (!body.soft_tissue || clip.given.size() <= read_soft_tissue(folder, world, body, clip).size()) continue;
      const std::filesystem::path path = soft_tissue_file(folder, world, body, clip);
      make_folder(path.parent_path());
      write_clip(path, clip.given);
      wrote = true;
    }
  if (wrote) keep_within(folder / "flesh", most);
}

}  // namespace selvedge
