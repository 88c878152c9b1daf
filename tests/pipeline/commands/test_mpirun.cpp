#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "learned/network/weights_hdf5.hpp"
#include "pipeline/host/csv_columns.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/program.hpp"
#include "tests/source_root.hpp"

namespace selvedge::test_mpirun {

using fake::has;

// The program under Open MPI's mpirun: skipped where that, or the program's library for it, is absent. What processes
// do together is tested with threads in tests/pipeline/processes and test_training_processes.cpp.

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

bool is_there() {
  const bool library =
      std::filesystem::exists(std::filesystem::path(tested_program()).parent_path() / "libselvedge_mpi.so");
  const bool there = library && std::system("command -v mpirun >/dev/null 2>&1") == 0;
  if (!there) WARN("skipped: no mpirun, or no libselvedge_mpi.so beside the program (make mpi)");
  return there;
}

struct Ended {
  int status = -1;
  std::string out, err;
};

// As root, with more processes than cores, and beside other tests.
constexpr const char* settings =
    "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
    "OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_odls_base_sigkill_timeout=3 ";

std::string train_command(const fake::Folder& folder, int processes, const std::string& arguments) {
  const std::string mpirun = processes > 0 ? "mpirun -n " + std::to_string(processes) + " " : "";
  return "cd " + folder.path.string() + " && " + settings + "exec " + mpirun + tested_program() + " train " +
         (source_root() / "configs" / "training" / "tiny.yaml").string() +
         " --set pool.states=3 --set optimiser.warm_up=4 --set watch.frames=3 --set watch.fixed_states=2 " + arguments;
}

Ended ended(const fake::Folder& folder, int status) {
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, fake::whole(folder.path / "stdout"),
          fake::whole(folder.path / "stderr")};
}

Ended run(const fake::Folder& folder, int processes, const std::string& arguments) {
  return ended(folder,
               std::system((train_command(folder, processes, arguments) + " >stdout 2>stderr </dev/null").c_str()));
}

// A training that goes on until something ends it; mpirun's own process. Ended with the object.
class Running {
 public:
  Running(const fake::Folder& folder, int processes, const std::string& arguments) : folder_(folder) {
    const std::string command = train_command(folder, processes, arguments) + " >stdout 2>stderr </dev/null";
    process_ = fork();
    if (process_ != 0) return;
    setpgid(0, 0);
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  ~Running() {
    if (process_ <= 0) return;
    kill(process_, SIGTERM);
    wait(60);
  }
  pid_t process() const { return process_; }

  // Waits until the condition holds. Returns whether it does before the process or the time ends.
  bool until(const std::function<bool()>& holds, double seconds = 120) const {
    const Clock::time_point begin = Clock::now();
    while (!holds()) {
      if (seconds_since(begin) > seconds || waitpid(process_, nullptr, WNOHANG | WNOWAIT) != 0) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
  }
  // Ended within the time; else its status is -2.
  Ended wait(double seconds) {
    const Clock::time_point begin = Clock::now();
    int status = 0;
    while (waitpid(process_, &status, WNOHANG) == 0) {
      if (seconds_since(begin) > seconds) return {-2, "", "it goes on"};
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    process_ = -1;
    return ended(folder_, status);
  }

 private:
  const fake::Folder& folder_;
  pid_t process_ = -1;
};

// The processes of mpirun that train, by rank; empty until all are there.
std::vector<pid_t> ranks_of(pid_t mpirun, int count) {
  std::vector<pid_t> ranks(static_cast<std::size_t>(count));
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const pid_t process = std::atoi(entry.path().filename().c_str());
    if (process <= 0) continue;
    const std::string stat = fake::whole(entry.path() / "stat");
    const std::size_t name = stat.rfind(')');
    if (name == std::string::npos || std::atoi(stat.c_str() + name + 4) != mpirun) continue;  // of another parent
    const std::string environment = fake::whole(entry.path() / "environ"), key = "OMPI_COMM_WORLD_RANK=";
    const std::size_t at = environment.find(key);
    if (at == std::string::npos) continue;
    const int rank = std::atoi(environment.c_str() + at + key.size());
    if (rank < count) ranks[static_cast<std::size_t>(rank)] = process;
  }
  return ranks;
}

std::vector<float> weights_in(const std::filesystem::path& folder) {
  WeightFile file = read_weight_file(folder / "weights.h5");
  std::vector<float> all;
  for (const WeightArray& array : weight_arrays(file.architecture, file.weights))
    all.insert(all.end(), array.data, array.data + array.rows * array.columns);
  return all;
}

// The table of steps without its column of seconds.
std::vector<std::vector<double>> curves_in(const std::filesystem::path& folder) {
  CsvColumns table(fake::whole(folder / "steps.csv"));
  for (std::size_t k = 0; k < table.names.size(); ++k)
    if (table.names[k] == "seconds") table.columns[k].clear();
  return table.columns;
}

bool is_alive(pid_t process) { return kill(process, 0) == 0; }

}  // namespace

TEST_CASE("mpirun: two processes give the same bits each time, also when they were stopped and go on", "[mpi]") {
  if (!is_there()) return;
  const fake::Folder folder("mpirun_bits");
  const std::string steps = "--set steps=30 ";
  const Ended first = run(folder, 2, steps + "--out first");
  INFO(first.err);
  REQUIRE(first.status == 0);
  CHECK(has(first.err, "2 processes, 2 samples a step"));
  CHECK(first.out.find("trained") == first.out.rfind("trained"));  // one process speaks
  REQUIRE(run(folder, 2, steps + "--out second").status == 0);
  const std::vector<float> weights = weights_in(folder.path / "first");
  CHECK(weights_in(folder.path / "second") == weights);
  CHECK(curves_in(folder.path / "second") == curves_in(folder.path / "first"));
  REQUIRE(run(folder, 0, steps + "--out alone").status == 0);
  CHECK(weights_in(folder.path / "alone") != weights);

  // A signal to any process stops all at a checkpoint.
  Running stopped(folder, 2, steps + "--out stopped");
  std::vector<pid_t> ranks;
  REQUIRE(stopped.until([&] {
    ranks = ranks_of(stopped.process(), 2);
    return has(fake::whole(folder.path / "stderr"), "gap closed");
  }));
  REQUIRE(ranks[1] > 0);
  kill(ranks[1], SIGINT);
  const Ended halted = stopped.wait(120);
  INFO(halted.err);
  CHECK(has(halted.out, "stopped"));
  CHECK(has(halted.out, "go on with --resume"));
  // Another number of processes is refused, and the same number goes on.
  const Ended refused = run(folder, 0, steps + "--out stopped --resume");
  CHECK(refused.status == 2);
  CHECK(has(refused.err, "the checkpoint is of 2 processes, and 1 trains now"));
  const Ended three = run(folder, 3, steps + "--out stopped --resume");
  CHECK(three.status == 2);
  CHECK(three.err.find("the checkpoint is of 2 processes") == three.err.rfind("the checkpoint is of 2 processes"));
  CHECK(run(folder, 2, steps + "--out stopped --resume").status == 0);
  CHECK(weights_in(folder.path / "stopped") == weights);
}

TEST_CASE("mpirun: where a process is killed all end, and the last checkpoint goes on", "[mpi]") {
  if (!is_there()) return;
  const fake::Folder folder("mpirun_kill");
  const std::string often = "--set steps=1000000 --set watch.checkpoint_minutes=0.005 --out run ";
  const auto checkpoint = folder.path / "run" / "checkpoint.h5";
  {
    Running killed(folder, 2, often);
    REQUIRE(killed.until([&] { return std::filesystem::exists(checkpoint); }));
    const std::vector<pid_t> ranks = ranks_of(killed.process(), 2);
    REQUIRE(ranks[0] > 0);
    REQUIRE(ranks[1] > 0);
    const Clock::time_point begin = Clock::now();
    kill(ranks[1], SIGKILL);
    const Ended end = killed.wait(10);
    INFO(end.err);
    CHECK(end.status != 0);
    CHECK(end.status != -2);
    while (is_alive(ranks[0]) && seconds_since(begin) < 10) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    CHECK_FALSE(is_alive(ranks[0]));
    CHECK(has(end.err, "Killed"));
  }
  // It goes on, and `--pause` stops both.
  Running resumed(folder, 2, often + "--resume");
  REQUIRE(resumed.until([&] { return has(fake::whole(folder.path / "stderr"), "samples/s"); }));
  std::ofstream(folder.path / "run" / "pause") << "stop at a checkpoint\n";
  const Ended paused = resumed.wait(120);
  INFO(paused.err);
  CHECK(has(paused.out, "stopped"));
  CHECK_FALSE(std::filesystem::exists(folder.path / "run" / "pause"));
}

TEST_CASE("mpirun: Ctrl-C stops at a checkpoint, and one process alone opens nothing", "[mpi]") {
  if (!is_there()) return;
  const fake::Folder folder("mpirun_interrupt");
  const std::string endless = "--set steps=1000000 --out run ";
  Running interrupted(folder, 2, endless);
  REQUIRE(interrupted.until([&] { return has(fake::whole(folder.path / "stderr"), "gap closed"); }));
  kill(interrupted.process(), SIGINT);
  const Ended end = interrupted.wait(60);
  INFO(end.err);
  CHECK(end.status != -2);
  CHECK(std::filesystem::exists(folder.path / "run" / "checkpoint.h5"));

  Running alone(folder, 1, "--set steps=1000000 --out alone ");
  REQUIRE(alone.until([&] { return has(fake::whole(folder.path / "stderr"), "gap closed"); }));
  const std::vector<pid_t> ranks = ranks_of(alone.process(), 1);
  REQUIRE(ranks[0] > 0);
  const std::string maps = fake::whole("/proc/" + std::to_string(ranks[0]) + "/maps");
  CHECK(has(maps, "selvedge"));
  CHECK_FALSE(has(maps, "libmpi"));
}

TEST_CASE("mpirun: a failure is one message", "[mpi]") {
  if (!is_there()) return;
  const fake::Folder folder("mpirun_failure");
  const Ended wrong = run(folder, 2, "--set optimiser.batch=1000");
  INFO(wrong.err);
  CHECK(wrong.status == 2);
  CHECK(wrong.err.find("selvedge: ") == wrong.err.rfind("selvedge: "));
  CHECK(has(wrong.err, "batch"));
}

}  // namespace selvedge::test_mpirun
