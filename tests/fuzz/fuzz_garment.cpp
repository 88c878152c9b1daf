#include <cstdlib>

#include "pipeline/garments/garment_hdf5.hpp"
#include "tests/fuzz/valid_hdf5.hpp"
#include "tests/pipeline/fake_body.hpp"

using namespace selvedge;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto write = [](const std::filesystem::path& path) {
    const BodyModel body = fake::body(4, 12, 2, true);
    Garment garment;
    garment.name = "shirt";
    garment.made_for = body.name;
    garment.skin = body.skin;
    garment.made_in.rotations = Points::Zero(4, 3);
    garment.groups = {{"hem", {0, 1, 2}}, {"neck", {3, 5}}};
    garment.pins = {3, 5};
    garment.stitches = {{0, 4, 0.01}};
    write_garment(path, garment);
  };
  return fuzz::with_altered_file(data, size, write, [](const std::filesystem::path& path) {
    const Garment garment = read_garment(path);
    for (const auto& [name, vertices] : garment.groups)
      for (const int v : vertices)
        if (v < 0 || v >= garment.skin.rest.rows()) std::abort();
    const BodyPose pose{Points::Zero(garment.skin.weights.cols(), 3)};
    if (garment.skin.weights.cols() > 100) return;
    const JointTransforms still(static_cast<std::size_t>(garment.skin.weights.cols()),
                                Eigen::Matrix<double, 3, 4>::Identity());
    if (posed(garment.skin, Eigen::VectorXd(), pose, still).rows() != garment.skin.rest.rows()) std::abort();
  });
}
