#include "pipeline/garments/garment_hdf5.hpp"

#include <hdf5.h>

#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/hdf5/hdf5_handles.hpp"
#include "tests/pipeline/fake_body.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_garment_hdf5 {

using Catch::Matchers::Contains;

namespace {

Garment shirt(int joints, int vertices, int shapes, bool corrections) {
  Garment garment{"shirt \xC3\xB6", fake::body(joints, vertices, shapes, corrections).skin, {}, {}, {}};
  garment.groups = {{"hem", {0, 3, 5}}, {"none", {}}, {"left cuff", {3, vertices - 1}}};
  garment.pins = {1, 2, vertices - 1};
  garment.made_for = "random";
  garment.stitches = {{0, vertices - 1, 0.006}, {5, 2, 0}, {0, 7, 1.0 / 3}};
  return garment;
}

void check_same(const Garment& a, const Garment& b) {
  CHECK(a.name == b.name);
  CHECK(a.made_for == b.made_for);
  CHECK(a.skin.rest == b.skin.rest);
  CHECK(a.skin.triangles == b.skin.triangles);
  CHECK(a.skin.shape_directions == b.skin.shape_directions);
  CHECK(a.skin.pose_directions.cols() == b.skin.pose_directions.cols());
  CHECK(a.skin.pose_directions == b.skin.pose_directions);
  CHECK(Eigen::MatrixXd(a.skin.weights) == Eigen::MatrixXd(b.skin.weights));
  CHECK(a.made_in.rotations.rows() == b.made_in.rotations.rows());
  CHECK(a.made_in.rotations == b.made_in.rotations);
  CHECK(a.made_in.translation == b.made_in.translation);
  CHECK(a.groups == b.groups);
  CHECK(a.pins == b.pins);
  CHECK(a.stitches == b.stitches);
}

// What reading says of a file from which a field was taken and, if there are values, written anew.
std::string complaint(const std::string& field, const std::vector<int>& values = {}) {
  const fake::Folder folder("broken_garment");
  const auto path = folder.path / "shirt.h5";
  Garment garment = shirt(5, 40, 3, true);
  garment.made_in = fake::pose(5);
  write_garment(path, garment);
  {
    h5::silence();
    const h5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    REQUIRE(H5Ldelete(file.id(), field.c_str(), H5P_DEFAULT) >= 0);
    if (!values.empty()) {
      const hsize_t count = values.size();
      const h5::Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
      const h5::Handle dataset(
          H5Dcreate2(file.id(), field.c_str(), H5T_NATIVE_INT32, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
          H5Dclose);
      H5Dwrite(dataset.id(), H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
  }
  try {
    read_garment(path);
  } catch (const Error& error) {
    CHECK_FALSE(error.cure().empty());
    CHECK_THAT(error.what(), Contains("shirt.h5"));
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a garment comes back from its file to the bit") {
  const fake::Folder folder("garment");
  for (const bool corrections : {true, false})
    for (const int shapes : {0, 10}) {
      Garment garment = shirt(24, 500, shapes, corrections);
      garment.skin.rest(0, 0) = 1e-310;
      if (shapes == 0) garment.made_in = fake::pose(24);
      write_garment(folder.path / "shirt.h5", garment);
      check_same(garment, read_garment(folder.path / "shirt.h5"));
    }
  Garment plain{"plain", fake::body(3, 20, 0, false).skin, {}, {}, {}};
  write_garment(folder.path / "shirt.h5", plain);
  check_same(plain, read_garment(folder.path / "shirt.h5"));
  CHECK_FALSE(std::filesystem::exists(folder.path / "shirt.h5.part"));
}

TEST_CASE("a garment that is not sound is not written") {
  const fake::Folder folder("unsound_garment");
  const auto path = folder.path / "shirt.h5";
  const auto refused = [&](const auto& change) {
    Garment garment = shirt(5, 40, 3, true);
    change(garment);
    CHECK_THROWS_AS(write_garment(path, garment), Error);
  };
  refused([](Garment& g) { g.pins = {40}; });
  refused([](Garment& g) { g.pins = {3, 3}; });
  refused([](Garment& g) { g.pins = {-1}; });
  refused([](Garment& g) { g.groups[0].second = {5, 3}; });
  refused([](Garment& g) { g.groups[1].first = "hem"; });
  refused([](Garment& g) { g.groups[1].first = ""; });
  refused([](Garment& g) { g.made_in = fake::pose(4); });
  refused([](Garment& g) {
    g.made_in = fake::pose(5);
    g.made_in.translation.x() = std::nan("");
  });
  refused([](Garment& g) { g.stitches[1].b = 40; });
  refused([](Garment& g) { g.stitches[1].a = -1; });
  refused([](Garment& g) { g.stitches[1].b = 5; });
  refused([](Garment& g) { g.stitches[1].rest_length = -1e-3; });
  refused([](Garment& g) { g.stitches[1].rest_length = std::nan(""); });
  refused([](Garment& g) { g.skin.rest(7, 1) = std::nan(""); });
  refused([](Garment& g) { g.skin.triangles(7, 1) = 40; });
  refused([](Garment& g) { g.skin.triangles(7, 1) = g.skin.triangles(7, 2); });
  CHECK(std::filesystem::is_empty(folder.path));
}

TEST_CASE("a garment's file without what it needs is refused, by field") {
  const fake::Folder folder("lacking_garment");
  CHECK_THROWS_AS(read_garment(folder.path / "absent.h5"), Error);
  CHECK_THROWS_AS(read_garment(fake::write(folder, "text.h5", "no HDF5")), Error);
  for (const std::string field : {"format", "rest", "triangles", "weights", "weights/indices", "joint_count",
                                  "groups/names", "groups/begin", "groups/vertices", "made_in/rotations",
                                  "made_in/translation", "stitches/from", "stitches/to", "stitches/rest_lengths"}) {
    INFO(field);
    CHECK_THAT(complaint(field), Contains(field));
  }
  for (const std::string field :
       {"name", "made_for", "shape_directions", "pose_directions", "made_in", "groups", "pins", "stitches"})
    CHECK(complaint(field).empty());
}

TEST_CASE("a garment's fields with wrong indices are refused, by field") {
  CHECK_THAT(complaint("pins", {1, 40}), Contains("pins") && Contains("names vertex 40"));
  CHECK_THAT(complaint("pins", {4, 1}), Contains("pins") && Contains("ascending"));
  CHECK_THAT(complaint("stitches/from", {0, 5, 40}), Contains("stitches") && Contains("vertices 40 and 7"));
  CHECK_THAT(complaint("stitches/to", {1, 2}), Contains("stitches/to") && Contains("2 entries, not 3"));
  CHECK_THAT(complaint("stitches/rest_lengths", {1}), Contains("stitches/rest_lengths"));
  CHECK_THAT(complaint("joint_count", {4}), Contains("weights/indices"));
  CHECK_THAT(complaint("joint_count", {6}), Contains("pose_directions"));
  CHECK_THAT(complaint("joint_count", {5, 5}), Contains("joint_count"));
  CHECK_THAT(complaint("joint_count", {2000000000}), Contains("from 1 to 100000"));
  CHECK_THAT(complaint("groups/begin", {0, 3, 5}), Contains("groups/begin"));
  CHECK_THAT(complaint("groups/begin", {0, 4, 3, 5}), Contains("groups/begin"));
  CHECK_THAT(complaint("groups/vertices", {0, 3, 40, 3, 39}), Contains("hem"));
}

}  // namespace selvedge::test_garment_hdf5
