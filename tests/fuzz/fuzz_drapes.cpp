#include <cstdlib>

#include "pipeline/drapes/drape_set.hpp"
#include "tests/fuzz/valid_hdf5.hpp"

using namespace selvedge;

// As many poses as garments, each of as many joints and vertices as asked for.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr int joints = 3, vertices = 5;
  const auto write = [](const std::filesystem::path& path) {
    DrapePath drapes;
    drapes.shape = Eigen::VectorXd::Constant(2, 0.5);
    drapes.rotations.assign(2, Points::Zero(joints, 3));
    drapes.x.assign(2, Points::Ones(vertices, 3));
    drapes.dropped = {{"tangled", 2}};
    write_drape_path(path, drapes);
  };
  return fuzz::with_altered_file(data, size, write, [](const std::filesystem::path& path) {
    const DrapePath drapes = read_drape_path(path, joints, vertices);
    if (drapes.x.size() != drapes.rotations.size()) std::abort();
    for (const Points& x : drapes.x)
      if (x.rows() != vertices) std::abort();
  });
}
