#include "pipeline/bodies/up_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_hdf5.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/scene/setup.hpp"
#include "pipeline/tools/convert_body.hpp"
#include "tests/pipeline/fake_garment.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_up_axis {

using Catch::Matchers::Contains;
using fake::Folder;

namespace {

Points z_up(const Points& x) {
  Points turned = x;
  turned.col(1) = -x.col(2);
  turned.col(2) = x.col(1);
  return turned;
}

BodyRequest write_mannequin(const Folder& folder, bool z) {
  const BodyModel& body = fake::mannequin();
  const Points joints = joint_positions(body, {});
  const auto as_file = [&](const Points& x) { return z ? z_up(x) : x; };
  write_obj(folder.path / "mesh.obj", as_file(body.skin.rest), body.skin.triangles);
  const Points at = as_file(joints);
  std::string text = "joints:\n";
  for (Eigen::Index j = 0; j < at.rows(); ++j)
    text += fmt::format("  {}: [{}, {}, {}]\n", body.joints[static_cast<std::size_t>(j)], at(j, 0), at(j, 1), at(j, 2));
  fake::write(folder, "joints.yaml", text);
  BodyRequest request;
  request.file = folder.path / "mesh.obj";
  request.joints = folder.path / "joints.yaml";
  request.out = folder.path / (z ? "z.h5" : "y.h5");
  return request;
}

}  // namespace

TEST_CASE("a body whose file has z up is told, and turned on request", "[up_axis]") {
  const Folder folder("up_axis");
  CHECK(convert_body(write_mannequin(folder, false)).warnings.empty());
  BodyRequest request = write_mannequin(folder, true);
  const BodyReport lying = convert_body(request);
  REQUIRE(lying.warnings.size() == 1);
  CHECK_THAT(lying.warnings[0], Contains("stands along z") && Contains("--up z"));
  const auto scene = fake::write(folder, "scene.yaml",
                                 "cloths: [{rectangle: {size: [0.1, 0.1], resolution: 3}, translate: [0, 3, 0]}]\n"
                                 "obstacles: [{name: person, body: {model: z.h5}}]\n");
  const std::vector<std::string> warnings = read_setup(scene).warnings;
  CHECK(std::ranges::any_of(warnings, [](const std::string& one) { return fake::has(one, "stands along z"); }));

  request.up = Up::z;
  const BodyReport report = convert_body(request);
  CHECK(report.warnings.empty());
  CHECK(report.t_pose);
  const BodyModel turned = read_body(request.out), body = read_body(folder.path / "y.h5");
  CHECK(fake::farthest(turned.skin.rest, body.skin.rest) < 1e-9);
  CHECK(fake::farthest(joint_positions(turned, {}), joint_positions(body, {})) < 1e-6);
  CHECK(read_setup(scene).warnings.empty());
}

TEST_CASE("files that say themselves which axis is up take no --up", "[up_axis]") {
  const Folder folder("up_axis_refused");
  BodyRequest request;
  request.up = Up::z;
  request.out = folder.path / "body.h5";
  for (const char* name : {"a.glb", "a.npz"}) {
    request.file = folder.path / name;
    CHECK_THROWS_WITH(convert_body(request), Contains("--up z") && Contains("y is up"));
  }
}

TEST_CASE("directions of shapes turn with the body", "[up_axis]") {
  BodyModel body = fake::mannequin();
  const Eigen::VectorXd shape = Eigen::VectorXd::Constant(2, 1.5);
  BodyModel lying = body;
  lying.skin.rest = z_up(body.skin.rest);
  for (Eigen::Index k = 0; k < body.skin.shape_directions.cols(); ++k)
    for (Eigen::Index v = 0; v < body.skin.rest.rows(); ++v) {
      lying.skin.shape_directions(3 * v + 1, k) = -body.skin.shape_directions(3 * v + 2, k);
      lying.skin.shape_directions(3 * v + 2, k) = body.skin.shape_directions(3 * v + 1, k);
    }
  CHECK(stands_along_z(lying));
  CHECK_FALSE(stands_along_z(body));
  turn_y_up(Up::z, lying);
  CHECK(fake::farthest(shaped(lying.skin, shape), shaped(body.skin, shape)) < 1e-12);
  BodyModel nameless = body;
  nameless.joints.assign(nameless.joints.size(), "bone");
  CHECK_FALSE(stands_along_z(nameless));
  nameless.skin.rest = z_up(nameless.skin.rest);
  CHECK(stands_along_z(nameless));
}

}  // namespace selvedge::test_up_axis
