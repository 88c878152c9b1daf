#include <cstdlib>

#include "pipeline/bodies/body_hdf5.hpp"
#include "tests/fuzz/valid_hdf5.hpp"
#include "tests/pipeline/fake_body.hpp"

using namespace selvedge;

// What is read can be posed.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto write = [](const std::filesystem::path& path) { write_body(path, fake::body(4, 12, 2, true)); };
  return fuzz::with_altered_file(data, size, write, [](const std::filesystem::path& path) {
    const BodyModel body = read_body(path);
    const BodyPose pose{Points::Constant(static_cast<Eigen::Index>(body.joints.size()), 3, 0.1)};
    if (posed(body, Eigen::VectorXd(), pose).rows() != body.skin.rest.rows()) std::abort();
  });
}
