#include <sys/resource.h>
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <limits>

#include "collision/geometry/error.hpp"
#include "physics/scene/contact_forces.hpp"
#include "pipeline/hdf5/hdf5_handles.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/hdf5/trajectory_row.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/refusal.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_trajectory {

namespace {

void write_three_frames(const std::filesystem::path& path, const Scene& scene) {
  TrajectoryWriter writer(path, trajectory_info(scene, "", "conventional", 30));
  for (int i = 0; i < 3; ++i) writer.append(fake::frame(scene, i));
  writer.close();
}

void require_same(const Frame& a, const Frame& b) {
  REQUIRE(a.time == b.time);
  REQUIRE(a.x == b.x);
  REQUIRE(a.obstacles.size() == b.obstacles.size());
  for (std::size_t k = 0; k < a.obstacles.size(); ++k) REQUIRE(a.obstacles[k] == b.obstacles[k]);
  for (const BoundField<Frame>& field : frame_fields()) {
    INFO(field.name);
    REQUIRE(field.get(a) == field.get(b));
  }
  REQUIRE(a.bad_triangles == b.bad_triangles);
}

}  // namespace

TEST_CASE("a trajectory read back is what was written") {
  const fake::Folder folder("trajectory");
  const Scene scene = fake::scene();
  const TrajectoryInfo info = trajectory_info(scene, "run:\n  frames: 5\n", "conventional", 24);
  {
    TrajectoryWriter writer(folder.path / "run.h5", info);
    for (int i = 0; i < 100; ++i) writer.append(fake::frame(scene, i));
    writer.close();
  }
  const TrajectoryReader reader(folder.path / "run.h5");
  REQUIRE(reader.frame_count() == 100);
  REQUIRE(reader.closed());
  REQUIRE(reader.info().config == info.config);
  REQUIRE(reader.info().fps == 24);
  REQUIRE(reader.info().stepper == "conventional");
  REQUIRE(reader.info().program_version == info.program_version);
  REQUIRE(reader.info().self_audited);
  REQUIRE(h5::File::open(folder.path / "run.h5").read_texts("codes/verdict") == verdict_names());
  REQUIRE(reader.info().triangles == scene.surface.triangles);
  REQUIRE(reader.info().rest == scene.rest);
  REQUIRE(reader.info().rest_triangle == scene.rest_triangle);
  REQUIRE(reader.info().cloth_names == std::vector<std::string>{"sheet"});
  REQUIRE(reader.info().cloth_first_vertex == std::vector<int>{0, 25});
  REQUIRE(reader.info().obstacles.size() == 2);
  REQUIRE(reader.info().obstacles[1].name == "mover");
  REQUIRE(reader.info().obstacles[1].moving);
  for (int i : {0, 1, 2, 50, 99}) {
    require_same(reader.frame(i), fake::frame(scene, i));
    REQUIRE(reader.time(i) == reader.frame(i).time);
  }
  REQUIRE_THROWS_AS(reader.time(100), Error);
}

TEST_CASE("a file that is being written can be read up to its last full frame") {
  const fake::Folder folder("growing");
  const Scene scene = fake::scene();
  TrajectoryWriter writer(folder.path / "run.h5", trajectory_info(scene, "", "conventional", 30));
  REQUIRE(TrajectoryReader(folder.path / "run.h5").frame_count() == 0);
  for (int i = 0; i < 3; ++i) {
    writer.append(fake::frame(scene, i));
    const TrajectoryReader reader(folder.path / "run.h5");
    REQUIRE(reader.frame_count() == i + 1);
    REQUIRE_FALSE(reader.closed());
    require_same(reader.frame(i), fake::frame(scene, i));
  }
}

// Cloth that leaves a still obstacle no room moves it.
TEST_CASE("a still obstacle is stored where it was in every frame") {
  const fake::Folder folder("pushed");
  const Scene scene = fake::scene();
  const auto pushed = [&](int i) {
    Frame frame = fake::frame(scene, i);
    if (i == 3 || i == 4) frame.obstacles[0] = fake::tetrahedron_points(0.01 * i, -5).cast<float>();
    return frame;
  };
  TrajectoryWriter writer(folder.path / "run.h5", trajectory_info(scene, "", "conventional", 30));
  for (int i = 0; i < 6; ++i) {
    writer.append(pushed(i));
    const TrajectoryReader reader(folder.path / "run.h5");
    CHECK(reader.info().obstacles[0].moving == (i >= 3));
    for (int k = 0; k <= i; ++k) require_same(reader.frame(k), pushed(k));
  }
  CHECK(h5::File::open(folder.path / "run.h5").shape_of("obstacles/0/x", 3)[0] == 6);
}

TEST_CASE("contact forces are stored where they are asked for, and are no number where they are not known") {
  const fake::Folder folder("contact_forces");
  const Scene scene = fake::scene();
  const Eigen::Index n = scene.rest.rows();
  TrajectoryInfo info = trajectory_info(scene, "", "conventional", 30);
  Frame frame = fake::frame(scene, 0);
  frame.report.contact_forces = std::make_shared<const ContactForces>(ContactForces{
      Points::Constant(n, 3, 0.25), Points::Constant(n, 3, -0.5), Eigen::VectorXd::LinSpaced(n, 0, n - 1.0)});
  const auto written = [&](bool asked) {
    info.contact_forces = asked;
    TrajectoryWriter writer(folder.path / "run.h5", info);
    writer.append(fake::frame(scene, 0));
    writer.append(frame);
    Frame rejected = frame;
    rejected.report.status = StepStatus::rejected;
    writer.append(rejected);
    writer.close();
    return TrajectoryReader(folder.path / "run.h5");
  };
  const TrajectoryReader with = written(true);
  REQUIRE(with.info().contact_forces);
  for (const int unknown : {0, 2}) {
    CHECK(with.frame(unknown).report.contact_forces->normal.array().isNaN().all());
    CHECK(with.frame(unknown).report.contact_forces->pressure.array().isNaN().all());
  }
  const Frame read = with.frame(1);
  CHECK(read.report.contact_forces->normal == frame.report.contact_forces->normal);
  CHECK(read.report.contact_forces->friction == frame.report.contact_forces->friction);
  CHECK(read.report.contact_forces->pressure == frame.report.contact_forces->pressure);
  const TrajectoryReader without = written(false);
  CHECK_FALSE(without.info().contact_forces);
  CHECK_FALSE(without.frame(1).report.contact_forces);
  CHECK_FALSE(h5::File::open(folder.path / "run.h5").has("frames/contact_normal"));
}

// Files that HDF5 has no objection to, with one field of another shape or of absurd values.
TEST_CASE("every field of a trajectory is checked before it is read") {
  const fake::Folder folder("hostile");
  const Scene scene = fake::scene();
  const std::filesystem::path path = folder.path / "run.h5";
  const auto refusal = [&](const std::string& field, hid_t type, const std::vector<hsize_t>& shape,
                           const void* data) -> std::string {
    write_three_frames(path, scene);
    h5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    H5Ldelete(file.id(), field.c_str(), H5P_DEFAULT);
    const h5::Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
    const h5::Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (!data) {  // only declared
      const std::vector<hsize_t> chunk(shape.size(), 1);
      H5Pset_chunk(creation.id(), static_cast<int>(shape.size()), chunk.data());
    }
    {
      const h5::Handle dataset(
          H5Dcreate2(file.id(), field.c_str(), type, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Dclose);
      REQUIRE(dataset.id() >= 0);
      if (data) H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    }
    file.reset();  // HDF5 opens no file twice with other flags
    return testing::refusal([&] {
      const TrajectoryReader reader(path);
      for (int i = 0; i < reader.frame_count(); ++i) reader.frame(i);
    });
  };
  const std::vector<double> many(64, 30.0);
  const std::vector<int> whole(64, 1000000);
  const std::string fps = refusal("fps", H5T_NATIVE_DOUBLE, {8}, many.data());
  CHECK_THAT(fps, Catch::Contains("run.h5: fps") && Catch::Contains("is 8, not 1"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THAT(refusal("fps", H5T_NATIVE_DOUBLE, {1}, &nan), Catch::Contains("fps is"));
  CHECK_THAT(refusal("closed", H5T_NATIVE_DOUBLE, {4, 4}, many.data()), Catch::Contains("4 x 4"));
  CHECK_THAT(refusal("cloth/rest", H5T_NATIVE_DOUBLE, {hsize_t{1} << 60, 3}, nullptr), Catch::Contains("cloth/rest"));
  CHECK_THAT(refusal("cloth/pins", H5T_NATIVE_INT32, {hsize_t{1} << 40}, nullptr), Catch::Contains("are stored"));
  CHECK_THAT(refusal("cloth/pins", H5T_NATIVE_INT32, {3}, whole.data()), Catch::Contains("cloth/pins"));
  CHECK_THAT(refusal("cloth/first_vertex", H5T_NATIVE_INT32, {2}, whole.data()), Catch::Contains("first_vertex"));
  CHECK_THAT(refusal("cloth/names", h5::text_type(4).id(), {4, 4}, whole.data()), Catch::Contains("2 dimensions"));
  CHECK_THAT(refusal("frames/bad_triangles", H5T_NATIVE_INT32, {8, 8}, whole.data()), Catch::Contains("2 dimensions"));
  CHECK_THAT(refusal("frames/switched_off", H5T_NATIVE_INT32, {3, 3}, whole.data()), Catch::Contains("switched_off"));
  CHECK_THAT(refusal("frames/switched_off", H5T_NATIVE_INT32, {1, 2}, whole.data()), Catch::Contains("fewer rows"));
  CHECK_THAT(refusal("frames/report", H5T_NATIVE_INT32, {3, 3}, whole.data()), Catch::Contains("frames/report"));
  CHECK_THAT(refusal("obstacles/0/x", H5T_NATIVE_FLOAT, {0, 2000000000, 3}, nullptr), Catch::Contains("obstacles/0/x"));
  CHECK_THAT(refusal("frames_complete", H5T_NATIVE_INT32, {1}, whole.data()), Catch::Contains("1000000 frames"));
}

// As a version wrote it that had these columns of frames/report only.
void leave_columns(const std::filesystem::path& path, const std::vector<std::string>& names) {
  h5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  h5::Handle report(H5Dopen2(file.id(), "frames/report", H5P_DEFAULT), H5Dclose);
  h5::Handle all(H5Dget_type(report.id()), H5Tclose), space(H5Dget_space(report.id()), H5Sclose);
  h5::Handle type(H5Tcreate(H5T_COMPOUND, H5Tget_size(all.id())), H5Tclose);
  for (const std::string& name : names) {
    const auto k = static_cast<unsigned>(H5Tget_member_index(all.id(), name.c_str()));
    const h5::Handle member(H5Tget_member_type(all.id(), k), H5Tclose);
    H5Tinsert(type.id(), name.c_str(), H5Tget_member_offset(all.id(), k), member.id());
  }
  const auto count = static_cast<hsize_t>(H5Sget_simple_extent_npoints(space.id()));
  std::vector<char> rows(H5Tget_size(all.id()) * count);
  REQUIRE(H5Dread(report.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) >= 0);
  report.reset();
  H5Ldelete(file.id(), "frames/report", H5P_DEFAULT);
  space = h5::Handle(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const h5::Handle old(
      H5Dcreate2(file.id(), "frames/report", type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  REQUIRE(H5Dwrite(old.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) >= 0);
}

TEST_CASE("a trajectory of a program that had fewer columns can be read: what it lacks is as in a new frame") {
  const fake::Folder folder("fewer_columns");
  const Scene scene = fake::scene();
  const std::filesystem::path path = folder.path / "run.h5";
  write_three_frames(path, scene);
  leave_columns(path, {"time", "by", "status", "reason", "iterations", "contacts", "bad_begin", "bad_count"});
  const TrajectoryReader reader(path);
  const Frame read = reader.frame(2), wrote = fake::frame(scene, 2), fresh;
  for (const BoundField<Frame>& field : frame_fields()) {
    INFO(field.name);
    const bool there = field.name == "time" || field.name == "by" || field.name == "status" || field.name == "reason" ||
                       field.name == "iterations" || field.name == "contacts" ||
                       field.name == "switched_off";  // which has a dataset of its own
    CHECK(field.get(read) == field.get(there ? wrote : fresh));
  }
  CHECK(read.bad_triangles == wrote.bad_triangles);
}

TEST_CASE("the reason of an accepted step of an older file becomes what it leaves in doubt") {
  const fake::Folder folder("older_reasons");
  const Scene scene = fake::scene();
  const std::filesystem::path path = folder.path / "run.h5";
  TrajectoryWriter writer(path, trajectory_info(scene, "", "conventional", 30));
  const std::vector<Reason> reasons{Reason::none, Reason::not_converged, Reason::penetrating, Reason::energy_gain};
  for (const StepStatus status : {StepStatus::accepted, StepStatus::rejected})
    for (const Reason reason : reasons) {
      Frame frame = fake::frame(scene, 0);
      frame.report.status = status;
      frame.report.reason = reason;
      writer.append(frame);
    }
  writer.close();
  leave_columns(path, {"time", "by", "status", "reason", "bad_begin", "bad_count"});
  const TrajectoryReader reader(path);
  const std::vector<Doubts> doubts{
      {}, {.not_converged = true}, {.penetrating = true}, {.energy_gain = true}, {}, {}, {}, {}};
  for (int i = 0; i < 8; ++i) {
    INFO(i);
    CHECK(reader.frame(i).report.doubts == doubts[static_cast<std::size_t>(i)]);
    CHECK(reader.frame(i).report.reason == (i < 4 ? Reason::none : reasons[static_cast<std::size_t>(i - 4)]));
  }
}

const std::filesystem::path files_page = source_root() / "docs" / "files.md";
const std::string columns_begin = "<!-- written by: selvedge_tests \"[write-docs]\" -->\n";

TEST_CASE("docs/files.md has the columns as the program has them", "[reports]") {
  const std::string text = fake::whole(files_page);
  const std::size_t at = text.find(columns_begin);
  REQUIRE(at != std::string::npos);
  CHECK(text.substr(at + columns_begin.size()) == trajectory_reference());
}

TEST_CASE("docs/files.md is written anew", "[.][write-docs]") {
  const std::string text = fake::whole(files_page);
  std::ofstream(files_page) << text.substr(0, text.find(columns_begin) + columns_begin.size())
                            << trajectory_reference();
}

TEST_CASE("a trajectory of a program that did not count what is switched off can be read") {
  const fake::Folder folder("older");
  const Scene scene = fake::scene();
  const std::filesystem::path path = folder.path / "run.h5";
  write_three_frames(path, scene);
  h5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  H5Ldelete(file.id(), "frames/switched_off", H5P_DEFAULT);
  file.reset();
  const TrajectoryReader reader(path);
  CHECK(reader.frame(2).report.switched_off.empty());
  CHECK(reader.frame(2).report.untangling == 6);
}

TEST_CASE("what is no trajectory is refused with a clear error") {
  const fake::Folder folder("refused");
  REQUIRE_THROWS_AS(TrajectoryReader(folder.path / "absent.h5"), Error);
  std::ofstream(folder.path / "text.h5") << "hello";
  REQUIRE_THROWS_AS(TrajectoryReader(folder.path / "text.h5"), Error);
  std::ofstream(folder.path / "empty.h5").close();
  REQUIRE_THROWS_AS(TrajectoryReader(folder.path / "empty.h5"), Error);
  const TrajectoryInfo info = trajectory_info(fake::scene(), "", "conventional", 30);
  REQUIRE_THROWS_AS(TrajectoryWriter(folder.path / "no" / "such" / "run.h5", info), Error);
}

// HDF5 reads metadata again while its checksum is wrong, for ever unless it is told how often.
TEST_CASE("a torn trajectory is refused, not waited for") {
  const fake::Folder folder("torn");
  const Scene scene = fake::scene();
  const std::filesystem::path path = folder.path / "run.h5";
  TrajectoryWriter writer(path, trajectory_info(scene, "", "conventional", 30));
  for (int i = 0; i < 40; ++i) writer.append(fake::frame(scene, i));
  std::ifstream written(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(written), {}};
  const std::string block = GENERATE("OHDR", "EAHD", "EADB");  // of a dataset, of its chunks' index and that one's data
  CAPTURE(block);
  const std::size_t at = bytes.rfind(block);
  REQUIRE(at != std::string::npos);
  bytes[at + 12] = static_cast<char>(bytes[at + 12] ^ 0x55);
  std::ofstream(folder.path / "torn.h5", std::ios::binary) << bytes;
  const auto read_all = [&] {
    const TrajectoryReader reader(folder.path / "torn.h5");
    for (int i = 0; i < reader.frame_count(); ++i) reader.frame(i);
  };
  REQUIRE_THROWS_AS(read_all(), Error);
}

// A writer that is killed may leave what it wrote last torn between two pages of memory. So no metadata lies in two.
TEST_CASE("no metadata of a trajectory lies across a page's end") {
  const fake::Folder folder("pages");
  const Scene scene = fake::scene();
  const std::filesystem::path path = folder.path / "run.h5";
  TrajectoryWriter(path, trajectory_info(scene, "", "conventional", 30)).append(fake::frame(scene, 0));
  const h5::File file = h5::File::open(path);
  const h5::Handle creation(H5Fget_create_plist(file.id()), H5Pclose);
  H5F_fspace_strategy_t strategy = H5F_FSPACE_STRATEGY_NTYPES;
  hbool_t persist = true;
  hsize_t threshold = 0, page = 0;
  H5Pget_file_space_strategy(creation.id(), &strategy, &persist, &threshold);
  H5Pget_file_space_page_size(creation.id(), &page);
  REQUIRE(strategy == H5F_FSPACE_STRATEGY_PAGE);
  REQUIRE(page == 4096);
}

// In a child, because the limit on the size of files cannot be lifted again.
TEST_CASE("a full disk ends in an error and leaves the full frames readable") {
  const fake::Folder folder("full_disk");
  const Scene scene = fake::scene(40);
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000000, 1000000};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      TrajectoryWriter writer(folder.path / "run.h5", trajectory_info(scene, "", "conventional", 30));
      for (int i = 0; i < 100; ++i) writer.append(fake::frame(scene, i));
      writer.close();
    } catch (const Error& error) {
      std::ofstream(folder.path / "note", std::ios::binary) << error.what();
      _exit(7);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFEXITED(status));
  REQUIRE(WEXITSTATUS(status) == 7);
  std::ifstream note(folder.path / "note");
  const std::string text{std::istreambuf_iterator<char>(note), {}};
  INFO(text);
  REQUIRE(text.find("run.h5") != std::string::npos);
  REQUIRE(text.find("File too large") != std::string::npos);
  REQUIRE(text.find("ulimit -f") != std::string::npos);
  const TrajectoryReader reader(folder.path / "run.h5");
  REQUIRE_FALSE(reader.closed());
  REQUIRE(reader.frame_count() > 0);
  REQUIRE(reader.frame_count() < 100);
  require_same(reader.frame(reader.frame_count() - 1), fake::frame(scene, reader.frame_count() - 1));
}

}  // namespace selvedge::test_trajectory
