#pragma once

#include <cstdint>

// The interface between the program and the shared library with Open MPI: plain structs, and one C function that
// returns a table of calls. No exception crosses it: calls return 0, or another number and a message in the report.
namespace selvedge {

constexpr int mpi_interface_version = 1;

struct MpiReport {
  char error[512] = {};
  int rank = 0, count = 0;
};

struct MpiCalls {
  int version;
  // Joins the processes that mpirun has started. Once in a process.
  int (*begin)(MpiReport*);
  // MPI_Allgather and MPI_Alltoall of blocks of `size` bytes. A process that waits sleeps.
  int (*gather)(const void* block, void* all, std::int64_t size, MpiReport*);
  int (*exchange)(const void* blocks, void* got, std::int64_t size, MpiReport*);
  void (*end)();  // after the last call of every process
};

constexpr const char* mpi_entry = "selvedge_mpi_calls";
using MpiEntry = const MpiCalls* (*)();

}  // namespace selvedge
