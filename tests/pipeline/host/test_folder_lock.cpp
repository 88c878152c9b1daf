#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>

#include "collision/geometry/error.hpp"
#include "pipeline/host/folder_lock.hpp"
#include "pipeline/host/write_file.hpp"
#include "tests/pipeline/fake_run.hpp"

namespace selvedge::test_folder_lock {
using Catch::Matchers::Contains;

TEST_CASE("One run at a time writes into a folder; a finished or killed one leaves it free", "[folder_lock]") {
  const fake::Folder folder("lock");
  {
    const FolderLock lock(folder.path);
    CHECK_THROWS_WITH(FolderLock(folder.path), Contains("process " + std::to_string(getpid())) &&
                                                   Contains(folder.path.string()) && Contains("--out"));
  }
  CHECK(std::filesystem::is_empty(folder.path));

  int ready[2];
  REQUIRE(pipe(ready) == 0);
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);
    const FolderLock lock(folder.path);
    [[maybe_unused]] const auto written = write(ready[1], "x", 1);
    pause();
    _exit(0);
  }
  char byte = 0;
  REQUIRE(read(ready[0], &byte, 1) == 1);
  // A run by the library alone is refused as well, and touches nothing.
  fake::FallingStepper stepper;
  CHECK_THROWS_WITH(fake::run(fake::setup(), stepper, folder.path), Contains("process " + std::to_string(child)));
  CHECK_FALSE(std::filesystem::exists(folder.path / "run.h5"));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  CHECK(std::filesystem::exists(folder.path / "run.lock"));  // nobody could remove it
  CHECK(fake::run(fake::setup(), stepper, folder.path).frames == 12);
  CHECK_FALSE(std::filesystem::exists(folder.path / "run.lock"));
  close(ready[0]);
  close(ready[1]);
}

TEST_CASE("A cache that cannot be written says which variable to set", "[folder_lock]") {
  const fake::Folder folder("cache");
  const std::filesystem::path file = folder.path / "file";
  write_file(file, "no folder");
  CHECK_THROWS_WITH(write_cached(file / "selvedge" / "body.h5", [] {}), Contains("XDG_CACHE_HOME"));
  CHECK_THROWS_WITH(write_cached(folder.path / "body.h5", [&] { write_file(file / "x", ""); }),
                    Contains("XDG_CACHE_HOME"));
}

}  // namespace selvedge::test_folder_lock
