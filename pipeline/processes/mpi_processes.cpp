#include "pipeline/processes/mpi_processes.hpp"

#include <cstdlib>
#include <string>

#include "collision/geometry/error.hpp"
#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/shared_library.hpp"
#include "pipeline/processes/mpi_interface.hpp"

namespace selvedge {
namespace {

const MpiCalls& mpi_calls(const std::filesystem::path& library) {
  const std::string cure =
      "run `make mpi`, or install libopenmpi-dev and configure with -DSELVEDGE_MPI=ON; or start one process without "
      "mpirun";
  // Open MPI opens parts of its own later, which look for its symbols.
  const auto entry = reinterpret_cast<MpiEntry>(entry_of_library(library, mpi_entry, "Open MPI", cure, true));
  if (!entry || entry()->version != mpi_interface_version)
    throw Error("the library is of another version of this program", library.string(), cure);
  return *entry();
}

class MpiProcesses : public Processes {
 public:
  explicit MpiProcesses(const MpiCalls& calls) : calls_(calls) { check(calls_.begin(&report_) != 0); }
  ~MpiProcesses() override {
    if (!failed_) calls_.end();
  }
  MpiProcesses(const MpiProcesses&) = delete;
  MpiProcesses& operator=(const MpiProcesses&) = delete;
  int rank() const override { return report_.rank; }
  int count() const override { return report_.count; }
  void gather(std::span<const std::byte> block, std::span<std::byte> all) override {
    check(failed_ || calls_.gather(block.data(), all.data(), static_cast<std::int64_t>(block.size()), &report_) != 0);
  }
  void exchange(std::span<const std::byte> blocks, std::span<std::byte> got) override {
    const auto size = static_cast<std::int64_t>(blocks.size()) / count();
    check(failed_ || calls_.exchange(blocks.data(), got.data(), size, &report_) != 0);
  }

 private:
  void check(bool failed) {
    restore_standard_arithmetic();
    failed_ = failed;
    if (failed) throw Error(std::string("Open MPI says: ") + report_.error, "the processes of mpirun", "");
  }
  const MpiCalls& calls_;
  MpiReport report_;
  bool failed_ = false;
};

}  // namespace

std::filesystem::path mpi_library_path() { return library_beside_program("libselvedge_mpi.so"); }

std::unique_ptr<Processes> processes_of_mpirun(const std::filesystem::path& library) {
  const char* count = std::getenv("OMPI_COMM_WORLD_SIZE");
  if (!count || std::atoi(count) < 2) return nullptr;
  return std::make_unique<MpiProcesses>(mpi_calls(library));
}

bool speaks_for_machine() {
  const char* rank = std::getenv("OMPI_COMM_WORLD_LOCAL_RANK");
  return !rank || std::atoi(rank) == 0;
}

}  // namespace selvedge
