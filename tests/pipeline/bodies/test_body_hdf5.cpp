#include "pipeline/bodies/body_hdf5.hpp"

#include <hdf5.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "pipeline/hdf5/hdf5_handles.hpp"
#include "tests/pipeline/fake_body.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/refusal.hpp"

namespace selvedge::test_body_hdf5 {

namespace {

void check_same(const SkinWeights& a, const SkinWeights& b) {
  CHECK(Eigen::MatrixXd(a) == Eigen::MatrixXd(b));
  CHECK(a.nonZeros() == b.nonZeros());
}

void check_same(const BodyModel& a, const BodyModel& b) {
  CHECK(a.name == b.name);
  CHECK(a.joints == b.joints);
  CHECK(a.parents == b.parents);
  CHECK(a.meshes == b.meshes);
  CHECK(a.skin.rest == b.skin.rest);
  CHECK(a.skin.triangles == b.skin.triangles);
  CHECK(a.skin.shape_directions == b.skin.shape_directions);
  CHECK(a.skin.pose_directions.cols() == b.skin.pose_directions.cols());
  CHECK(a.skin.pose_directions == b.skin.pose_directions);
  check_same(a.skin.weights, b.skin.weights);
  check_same(a.regressor, b.regressor);
}

// What reading says of a file from which a field was taken and, if `replace` is given, written anew.
template <class Replace>
std::string complaint(const fake::Folder& folder, const std::string& field, const Replace& replace) {
  const auto path = folder.path / "broken.h5";
  write_body(path, fake::body(5, 40, 3, true));
  {
    h5::silence();
    const h5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    REQUIRE(H5Ldelete(file.id(), field.c_str(), H5P_DEFAULT) >= 0);
    replace(file.id());
  }
  return testing::refusal([&] { read_body(path); });
}

template <class T>
auto with(const std::string& field, hid_t type, const std::vector<hsize_t>& shape, const std::vector<T>& values) {
  return [=](hid_t file) {
    const h5::Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
    const h5::Handle dataset(H5Dcreate2(file, field.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                             H5Dclose);
    if (!values.empty()) H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  };
}

using fake::has;

}  // namespace

TEST_CASE("a body comes back from its file to the bit") {
  const fake::Folder folder("body");
  for (const bool corrections : {true, false})
    for (const int shapes : {0, 10}) {
      BodyModel body = fake::body(24, 500, shapes, corrections);
      body.skin.rest(0, 0) = 1e-310;
      body.joints[3] = "lower spine, \xC3\xB6";
      write_body(folder.path / "body.h5", body);
      check_same(body, read_body(folder.path / "body.h5"));
    }
  CHECK_FALSE(std::filesystem::exists(folder.path / "body.h5.part"));
}

TEST_CASE("a body that is not sound is not written") {
  const fake::Folder folder("unsound");
  BodyModel body = fake::body(5, 40, 3, true);
  body.parents[2] = 4;
  CHECK_THROWS_AS(write_body(folder.path / "body.h5", body), Error);
  CHECK(std::filesystem::is_empty(folder.path));
  CHECK_THROWS_AS(write_body(folder.path / "absent" / "body.h5", fake::body(5, 40, 3, true)), Error);
}

TEST_CASE("a file without what a body needs is refused") {
  const fake::Folder folder("lacking");
  const auto nothing = [](hid_t) {};
  CHECK_THROWS_AS(read_body(folder.path / "absent.h5"), Error);
  CHECK_THROWS_AS(read_body(fake::write(folder, "text.h5", "no HDF5")), Error);
  for (const std::string field : {"rest", "triangles", "weights", "weights/indptr", "weights/indices", "weights/data",
                                  "joints", "parents", "regressor", "regressor/data", "format"}) {
    INFO(field);
    CHECK(has(complaint(folder, field, nothing), field));
  }
  for (const std::string field : {"name", "shape_directions", "pose_directions"})
    CHECK(complaint(folder, field, nothing).empty());
}

TEST_CASE("fields of a wrong shape or with wrong indices are refused") {
  const fake::Folder folder("wrong");
  const auto wrong = [&]<class T>(const std::string& field, hid_t type, const std::vector<hsize_t>& shape,
                                  const std::vector<T>& values) {
    const std::string said = complaint(folder, field, with(field, type, shape, values));
    INFO(field << ": " << said);
    CHECK(has(said, field.substr(0, field.find('/'))));
  };
  const hid_t real = H5T_NATIVE_DOUBLE, whole = H5T_NATIVE_INT32;
  wrong("rest", real, {40, 2}, std::vector<double>(80));
  wrong("rest", real, {120}, std::vector<double>(120));
  wrong("rest", real, {3000000000, 3}, std::vector<double>());
  wrong("triangles", whole, {1, 3}, std::vector<int>{0, 1, 40});
  wrong("shape_directions", real, {39, 3, 3}, std::vector<double>(351));
  wrong("shape_directions", real, {40, 4, 3}, std::vector<double>(480));
  wrong("pose_directions", real, {40, 3, 35}, std::vector<double>(4200));
  wrong("parents", whole, {5}, std::vector<int>{-1, 0, 7, 1, 1});
  wrong("weights/indptr", whole, {41}, std::vector<int>(41));
  wrong("weights/indptr", whole, {3}, std::vector<int>{0, 1, 160});
  wrong("weights/indices", whole, {160}, std::vector<int>(160, 5));
  wrong("weights/indices", whole, {160}, std::vector<int>(160, -1));
  wrong("weights/indices", whole, {9}, std::vector<int>(9));
  wrong("weights/data", real, {160}, std::vector<double>(160, 0.3));
  wrong("regressor/data", real, {15}, std::vector<double>(15, std::nan("")));
}

TEST_CASE("a body that several processes write at once is whole, and none of them fails") {
  const fake::Folder folder("body_race");
  const auto path = folder.path / "body.h5";
  const BodyModel body = fake::body(24, 2000, 10, true);
  std::vector<pid_t> children;
  for (int k = 0; k < 4; ++k) {
    children.push_back(fork());
    REQUIRE(children.back() >= 0);
    if (children.back() > 0) continue;
    try {
      for (int i = 0; i < 10; ++i) write_body(path, body);
    } catch (...) {
      _exit(1);
    }
    _exit(0);
  }
  for (const pid_t child : children) {
    int status = -1;
    waitpid(child, &status, 0);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
  }
  check_same(read_body(path), body);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 1);
}

}  // namespace selvedge::test_body_hdf5
