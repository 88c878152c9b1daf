#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "pipeline/formats/trajectory_hdf5.hpp"
#include "tests/pipeline/fake_run.hpp"

namespace selvedge::test_kill {

// A file is there only once it can be opened, and each frame it counts is whole, wherever its writer is killed: from
// before the file is made to hundreds of frames later.
TEST_CASE("a trajectory opens after kill -9 at random moments") {
  const fake::Folder folder("kill");
  const Scene scene = fake::scene(12);
  std::mt19937 random(20020701);
  int opened = 0, frames = 0;
  // Twenty kills; more where a loaded machine let too few of them find anything written.
  const auto seen_enough = [&] { return opened >= 10 && frames > 20; };
  for (int kill_number = 0; kill_number < 20 || (!seen_enough() && kill_number < 200); ++kill_number) {
    const std::filesystem::path path = folder.path / ("run" + std::to_string(kill_number) + ".h5");
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      alarm(60);  // ends it where the parent was ended before it could
      try {
        TrajectoryWriter writer(path, trajectory_info(scene, "run: {}\n", "conventional", 30));
        for (int i = 0;; ++i) writer.append(fake::frame(scene, i));
      } catch (...) {
        _exit(1);  // or it would go on as a second parent
      }
    }
    std::this_thread::sleep_for(std::chrono::microseconds(std::uniform_int_distribution(1000, 100000)(random)));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (!std::filesystem::exists(path)) continue;
    ++opened;
    const TrajectoryReader reader(path);
    REQUIRE_FALSE(reader.closed());
    for (int i = 0; i < reader.frame_count(); ++i) {
      const Frame read = reader.frame(i), wanted = fake::frame(scene, i);
      REQUIRE(read.x == wanted.x);
      REQUIRE(read.obstacles[0] == wanted.obstacles[0]);
      REQUIRE(read.obstacles[1] == wanted.obstacles[1]);
      REQUIRE(read.report.by == wanted.report.by);
      REQUIRE(read.bad_triangles == wanted.bad_triangles);
    }
    frames += reader.frame_count();
  }
  CAPTURE(opened, frames);
  REQUIRE(opened >= 10);
  REQUIRE(frames > 20);
}

}  // namespace selvedge::test_kill
