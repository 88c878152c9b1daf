#include <sys/mman.h>
#include <sys/wait.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "tests/pipeline/fake_run.hpp"

namespace selvedge::test_kill {

namespace {

// Frames that a writer has appended, seen by the process that will kill it.
struct SharedCount {
  std::atomic<int>* appended;
  SharedCount() {
    void* memory = mmap(nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    REQUIRE(memory != MAP_FAILED);
    appended = new (memory) std::atomic<int>(0);
  }
  ~SharedCount() { munmap(appended, sizeof(std::atomic<int>)); }
};

}  // namespace

// Wherever its writer is killed, a file exists only if it can be opened, and each frame that it counts is whole. The
// kill comes between the start and dozens of frames later. The test waits for frames instead of time, so that a busy
// machine sees as much; only the moment within the current frame is random.
TEST_CASE("a trajectory opens after kill -9 at random moments") {
  const fake::Folder folder("kill");
  const Scene scene = fake::scene(12);
  std::mt19937 random(20020701);
  int opened = 0, frames = 0;
  for (int kill_number = 0; kill_number < 20; ++kill_number) {
    const std::filesystem::path path = folder.path / ("run" + std::to_string(kill_number) + ".h5");
    const int wanted_frames = kill_number < 4 ? 0 : static_cast<int>(1 + random() % 40);
    const SharedCount count;
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      alarm(60);  // ends it where the parent was ended before it could
      try {
        TrajectoryWriter writer(path, trajectory_info(scene, "run: {}\n", "conventional", 30));
        for (int i = 0;; ++i) {
          writer.append(fake::frame(scene, i));
          ++*count.appended;
        }
      } catch (...) {
        _exit(1);  // or it would go on as a second parent
      }
    }
    while (*count.appended < wanted_frames && waitpid(child, nullptr, WNOHANG) == 0) std::this_thread::yield();
    REQUIRE(*count.appended >= wanted_frames);
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 2000));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (!std::filesystem::exists(path)) continue;
    ++opened;
    const TrajectoryReader reader(path);
    REQUIRE_FALSE(reader.closed());
    REQUIRE(reader.frame_count() >= wanted_frames);
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
  REQUIRE(opened >= 16);
  REQUIRE(frames > 100);
}

}  // namespace selvedge::test_kill
