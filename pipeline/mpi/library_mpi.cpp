#include <mpi.h>

#include <chrono>
#include <climits>
#include <cstdio>
#include <thread>

#include "pipeline/processes/mpi_interface.hpp"

// The table of calls to Open MPI, in a shared library of its own.
namespace selvedge {
namespace {

int fail(MpiReport* report, int code) {
  char text[MPI_MAX_ERROR_STRING] = {};
  int length = 0;
  MPI_Error_string(code, text, &length);
  std::snprintf(report->error, sizeof report->error, "%s", text);
  return 1;
}

// Sleeps between looks, so that a process that waits leaves its core to the threads and processes that work.
int wait(MPI_Request* request, MpiReport* report) {
  constexpr int looks_before_sleep = 100;
  constexpr std::chrono::microseconds sleep{50};
  int done = 0;
  for (int look = 0;; ++look) {
    if (const int code = MPI_Test(request, &done, MPI_STATUS_IGNORE); code != MPI_SUCCESS) return fail(report, code);
    if (done) return 0;
    if (look >= looks_before_sleep) std::this_thread::sleep_for(sleep);
  }
}

bool is_too_large(std::int64_t size, MpiReport* report) {
  if (size <= INT_MAX) return false;
  std::snprintf(report->error, sizeof report->error, "a block of %lld bytes is larger than MPI sends",
                static_cast<long long>(size));
  return true;
}

int begin(MpiReport* report) {
  int given = 0;
  if (const int code = MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given); code != MPI_SUCCESS)
    return fail(report, code);
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  MPI_Comm_rank(MPI_COMM_WORLD, &report->rank);
  MPI_Comm_size(MPI_COMM_WORLD, &report->count);
  if (given >= MPI_THREAD_FUNNELED) return 0;
  std::snprintf(report->error, sizeof report->error, "it does not serve programs with threads");
  return 1;
}

int gather(const void* block, void* all, std::int64_t size, MpiReport* report) {
  if (is_too_large(size, report)) return 1;
  const int bytes = static_cast<int>(size);
  MPI_Request request = MPI_REQUEST_NULL;
  const int code = MPI_Iallgather(block, bytes, MPI_BYTE, all, bytes, MPI_BYTE, MPI_COMM_WORLD, &request);
  return code == MPI_SUCCESS ? wait(&request, report) : fail(report, code);
}

int exchange(const void* blocks, void* got, std::int64_t size, MpiReport* report) {
  if (is_too_large(size, report)) return 1;
  const int bytes = static_cast<int>(size);
  MPI_Request request = MPI_REQUEST_NULL;
  const int code = MPI_Ialltoall(blocks, bytes, MPI_BYTE, got, bytes, MPI_BYTE, MPI_COMM_WORLD, &request);
  return code == MPI_SUCCESS ? wait(&request, report) : fail(report, code);
}

void end() { MPI_Finalize(); }

const MpiCalls calls{mpi_interface_version, begin, gather, exchange, end};

}  // namespace
}  // namespace selvedge

extern "C" __attribute__((visibility("default"))) const selvedge::MpiCalls* selvedge_mpi_calls() {
  return &selvedge::calls;
}
