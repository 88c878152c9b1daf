#pragma once

#include <filesystem>
#include <memory>

#include "pipeline/processes/processes.hpp"

namespace selvedge {

// The path of the shared library with Open MPI: beside the running program.
std::filesystem::path mpi_library_path();

// The processes that Open MPI's mpirun has started this one with. Null where it was started alone or by something else;
// nothing is opened then. The library ends with the object: every process must have made its last call. Only one thread
// may use it. Throws Error where there is no library at the path, where it is of another version, or where MPI fails.
// Where MPI fails later, this and all further calls throw Error, and mpirun ends the other processes when this one
// ends.
std::unique_ptr<Processes> processes_of_mpirun(const std::filesystem::path& library = mpi_library_path());

// Whether this process is the one that speaks for all those that mpirun has started on its machine; true without
// mpirun.
bool speaks_for_machine();

}  // namespace selvedge
