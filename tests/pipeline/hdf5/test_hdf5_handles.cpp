#include "pipeline/hdf5/hdf5_handles.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include <thread>

#include "collision/geometry/error.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "tests/learned/learned_scenes.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::test_hdf5_handles {

namespace {

// From now on all writes to the file fail, as on a full disk.
void break_writes(const h5::File& file) {
  void* descriptor = nullptr;
  if (H5Fget_vfd_handle(file.id(), H5P_DEFAULT, &descriptor) < 0) return;
  const int closed_to_writes = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(closed_to_writes, *static_cast<int*>(descriptor));
}

}  // namespace

// In a child that ends as the program does: a file that HDF5 cannot close would crash it then.
TEST_CASE("a file that cannot be written ends in an error, leaves nothing and crashes nothing", "[hdf5_handles]") {
  const fake::Folder folder("hdf5_not_written");
  const pid_t child = fork();
  if (child == 0) {
    const std::vector<double> numbers(50000, 1.0);
    try {
      h5::write_whole(folder.path / "a.h5", [&](const h5::File& file) {
        file.write_text("format", "anything");
        break_writes(file);
        file.write_constant("numbers", H5T_NATIVE_DOUBLE, {numbers.size()}, numbers.data());
      });
    } catch (const Error& error) {
      H5close();  // what the library does at the end of a program
      _exit(std::string(error.what()).find("a.h5: cannot write") != std::string::npos ? 7 : 8);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 7);
  CHECK(std::filesystem::is_empty(folder.path));
}

TEST_CASE("a file that cannot be made is named as it was to be called", "[hdf5_handles]") {
  const fake::Folder folder("hdf5_not_made");
  CHECK_THROWS_WITH(
      h5::write_whole(folder.path / "none" / "a.h5", [](const h5::File&) {}),
      Catch::Contains("none/a.h5: cannot write (No such file or directory)\n  cure: check that the folder"));
}

TEST_CASE("HDF5: the same content gives the same bytes, whenever it is written", "[hdf5_handles]") {
  const fake::Folder folder("hdf5_times");
  const fake::NarrowNetwork network = fake::narrow_network("contourcraft");
  const auto write = [&](const std::string& name) {
    h5::write_whole(folder.path / name, [](const h5::File& file) {
      const std::vector<double> numbers{1, 2, 3};
      file.make_group("group");
      file.write_text("group/text", "anything");
      file.write_constant("numbers", H5T_NATIVE_DOUBLE, {numbers.size()}, numbers.data());
      file.make_growing("rows", H5T_NATIVE_DOUBLE, {3}, 2, 0);
    });
    write_weight_file(folder.path / ("weights_" + name), {network.architecture, network.weights, "", {}, ""});
  };
  write("a.h5");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 has times in whole seconds
  write("b.h5");
  for (const std::string before : {"", "weights_"})
    CHECK(fake::whole(folder.path / (before + "a.h5")) == fake::whole(folder.path / (before + "b.h5")));
}

}  // namespace selvedge::test_hdf5_handles
