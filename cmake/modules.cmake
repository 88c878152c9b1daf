# How a module is compiled: the files of a room together, a precompiled header, OpenMP only where there is a pragma,
# position-independent everywhere, so that the Python extension is linked to the libraries of any build.

set(SELVEDGE_COMMON_HEADERS <algorithm> <array> <cassert> <chrono> <cmath> <fstream> <functional> <iomanip> <map>
  <memory> <mutex> <numeric> <optional> <set> <span> <sstream> <string> <thread>
  <vector> <Eigen/Core> <Eigen/Geometry>)

# Functions of a file that call each other are inlined as elsewhere: nothing replaces them when a program is loaded.
function(selvedge_position_independent target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE -fno-semantic-interposition)
endfunction()

# The precompiled headers that modules share, one for each set of compiler flags.
foreach(flags IN ITEMS plain parallel)
  set(headers selvedge_headers_${flags})
  file(CONFIGURE OUTPUT ${headers}.cpp CONTENT "")
  add_library(${headers} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${headers}.cpp)
  selvedge_position_independent(${headers})
  target_link_libraries(${headers} PRIVATE Eigen3::Eigen selvedge_warnings)
  target_precompile_headers(${headers} PRIVATE ${SELVEDGE_COMMON_HEADERS} <Eigen/SparseCore>)
endforeach()
if(SELVEDGE_OPENMP)
  target_compile_options(selvedge_headers_parallel PRIVATE ${OpenMP_CXX_FLAGS})
endif()

# selvedge_module(NAME [ROOMS room...] LEFT_OUT stem... ALONE room... HEADERS header... HEADERS_OF module
#   OPTIONS option... PUBLIC library... PRIVATE library... [HEAVY source library])
# makes the library selvedge_NAME of the sources of this folder and of its rooms, but those left out; with ROOMS, of
# these rooms only. The files of the rooms ALONE are not compiled together. HEADERS are precompiled beside the common
# ones; HEADERS_OF takes those of another module with the same options. Files with an OpenMP pragma are a target of
# their own, selvedge_NAME_parallel, and so is the source that alone sees the heavy package, selvedge_NAME_heavy. All
# others have the same flags in every build, so that a compile cache serves builds with these packages and without.
# OPTIONS are for these others.
function(selvedge_module name)
  cmake_parse_arguments(module "" "HEADERS_OF" "ROOMS;LEFT_OUT;ALONE;HEADERS;OPTIONS;PUBLIC;PRIVATE;HEAVY" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cpp)
  if(module_ROOMS)
    list(JOIN module_ROOMS "|" rooms)
    list(FILTER sources INCLUDE REGEX "^(${rooms})/")
  endif()
  if(SELVEDGE_ROOMS_LEFT_OUT)
    list(FILTER sources EXCLUDE REGEX "^(${SELVEDGE_ROOMS_LEFT_OUT})/")
  endif()
  foreach(stem IN LISTS module_LEFT_OUT)
    list(FILTER sources EXCLUDE REGEX "(^|/)${stem}\\.cpp$")
  endforeach()
  if(module_HEAVY)
    list(GET module_HEAVY 0 heavy_source)
    list(GET module_HEAVY 1 heavy_library)
    list(REMOVE_ITEM sources ${heavy_source})
  endif()
  set(parallel ${sources})
  foreach(source IN LISTS sources)
    file(READ ${source} text)
    if(NOT text MATCHES "#pragma omp|omp\\.h>")
      list(REMOVE_ITEM parallel ${source})
    endif()
  endforeach()
  list(REMOVE_ITEM sources ${parallel})

  add_library(selvedge_${name} STATIC ${sources})
  selvedge_position_independent(selvedge_${name})
  target_include_directories(selvedge_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:include>)
  # Who builds on it names headers as where it is installed: <selvedge/...>.
  add_library(selvedge_${name}_user INTERFACE)
  target_include_directories(selvedge_${name}_user INTERFACE ${PROJECT_BINARY_DIR}/include)
  target_link_libraries(selvedge_${name}_user INTERFACE selvedge_${name})
  add_library(selvedge::${name} ALIAS selvedge_${name}_user)
  target_compile_features(selvedge_${name} PUBLIC cxx_std_20)
  target_link_libraries(selvedge_${name} PUBLIC ${module_PUBLIC}
    PRIVATE ${module_PRIVATE} $<BUILD_INTERFACE:selvedge_warnings>)
  target_compile_options(selvedge_${name} PRIVATE ${module_OPTIONS})
  if(module_HEADERS_OF)
    target_precompile_headers(selvedge_${name} REUSE_FROM selvedge_${module_HEADERS_OF})
  elseif(module_HEADERS OR module_OPTIONS)
    target_precompile_headers(selvedge_${name} PRIVATE ${SELVEDGE_COMMON_HEADERS} ${module_HEADERS})
  else()
    target_precompile_headers(selvedge_${name} REUSE_FROM selvedge_headers_plain)
  endif()
  selvedge_compile_together(selvedge_${name} "${module_ALONE}" ${sources})

  if(parallel)
    set(objects selvedge_${name}_parallel)
    selvedge_objects(${name} ${objects} ${parallel})
    target_link_libraries(${objects} PRIVATE ${module_PUBLIC} ${module_PRIVATE})
    target_precompile_headers(${objects} REUSE_FROM selvedge_headers_parallel)
    selvedge_compile_together(${objects} "${module_ALONE}" ${parallel})
    if(SELVEDGE_OPENMP)
      target_compile_options(${objects} PRIVATE ${OpenMP_CXX_FLAGS})
      # Where it is installed, OpenMP is that of the machine that links it.
      target_link_libraries(selvedge_${name} PUBLIC "$<BUILD_INTERFACE:${OpenMP_CXX_LIBRARIES}>"
        INTERFACE $<INSTALL_INTERFACE:$<LINK_ONLY:OpenMP::OpenMP_CXX>>)
    endif()
  endif()
  if(module_HEAVY)
    selvedge_objects(${name} selvedge_${name}_heavy ${heavy_source})
    target_link_libraries(selvedge_${name}_heavy PRIVATE ${module_PUBLIC} ${heavy_library})
    # Linked without its include folders, which are flags too.
    get_target_property(linked ${heavy_library} INTERFACE_LINK_LIBRARIES)
    target_link_libraries(selvedge_${name} PRIVATE $<BUILD_INTERFACE:${linked}>
      INTERFACE $<INSTALL_INTERFACE:selvedge::${heavy_library}>)
  endif()
endfunction()

# selvedge_objects(NAME TARGET source...): sources with flags of their own, part of the library selvedge_NAME.
function(selvedge_objects name target)
  add_library(${target} OBJECT ${ARGN})
  selvedge_position_independent(${target})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE selvedge_warnings)
  target_sources(selvedge_${name} PRIVATE $<TARGET_OBJECTS:${target}>)
endfunction()

# selvedge_compile_together(TARGET ALONE source...): the sources of a folder are compiled a few at a time. Sources with
# flags of their own are compiled alone.
function(selvedge_compile_together target alone)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${SELVEDGE_UNITY} UNITY_BUILD_MODE GROUP)
  foreach(source IN LISTS ARGN)
    cmake_path(GET source PARENT_PATH room)
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    get_source_file_property(definitions ${source} COMPILE_DEFINITIONS)
    if(options OR definitions OR source MATCHES "_absent\\.cpp$")
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
    elseif(NOT room IN_LIST alone)
      string(REPLACE "/" "_" room "${room}")
      math(EXPR batch "0${count_${room}} / ${SELVEDGE_UNITY_BATCH}")
      math(EXPR count_${room} "0${count_${room}} + 1")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${room}${batch})
    endif()
  endforeach()
endfunction()
