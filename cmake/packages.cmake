# Every package is found here, once. What is absent is named by `selvedge info`.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
if(SELVEDGE_PROGRAM)
  find_package(HDF5 REQUIRED COMPONENTS C)
  add_library(selvedge_hdf5 INTERFACE)
  target_include_directories(selvedge_hdf5 SYSTEM INTERFACE ${HDF5_INCLUDE_DIRS})
  target_link_libraries(selvedge_hdf5 INTERFACE ${HDF5_LIBRARIES})
  find_package(yaml-cpp REQUIRED)
  find_package(CLI11 REQUIRED)
  find_package(nlohmann_json REQUIRED)
  find_package(fmt REQUIRED)
  find_package(TinyGLTF REQUIRED)
  # Debian's CMake package of libzip asks for programs that it does not install.
  find_path(LIBZIP_INCLUDE zip.h REQUIRED)
  find_library(LIBZIP_LIBRARY zip REQUIRED)
  add_library(selvedge_libzip INTERFACE)
  target_include_directories(selvedge_libzip SYSTEM INTERFACE ${LIBZIP_INCLUDE})
  target_link_libraries(selvedge_libzip INTERFACE ${LIBZIP_LIBRARY})
endif()

if(SELVEDGE_OPENMP)
  find_package(OpenMP REQUIRED COMPONENTS CXX)
endif()

if(SELVEDGE_FCL)
  find_package(fcl 0.7 REQUIRED)
  add_library(selvedge_fcl INTERFACE)
  target_link_libraries(selvedge_fcl INTERFACE fcl)
endif()

if(SELVEDGE_SUITESPARSE)
  # CHOLMOD ships no CMake package.
  find_path(CHOLMOD_INCLUDE cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
  find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
  add_library(selvedge_cholmod INTERFACE)
  target_include_directories(selvedge_cholmod SYSTEM INTERFACE ${CHOLMOD_INCLUDE})
  target_link_libraries(selvedge_cholmod INTERFACE ${CHOLMOD_LIBRARY})
endif()

if(SELVEDGE_MPI)
  find_package(MPI REQUIRED COMPONENTS C)  # Open MPI: Debian's libopenmpi-dev
endif()

if(SELVEDGE_TORCH)
  find_package(Torch REQUIRED)  # Debian's libtorch-dev, or any newer one by CMAKE_PREFIX_PATH
endif()
