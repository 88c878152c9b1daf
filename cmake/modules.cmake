# How a module is compiled: the files of a room together, one precompiled header, OpenMP only where there is a pragma.

set(SELVEDGE_COMMON_HEADERS <algorithm> <array> <cassert> <cmath> <functional> <map> <optional> <set> <span> <string>
  <vector> <Eigen/Core> <Eigen/Geometry>)

# Code that is run once and by nobody's clock.
set(SELVEDGE_SMALL "")
if(CMAKE_BUILD_TYPE STREQUAL Release)
  set(SELVEDGE_SMALL -O1)
endif()

# selvedge_module(NAME LEFT_OUT stem... HEADERS header...): the sources of this folder and of its rooms, but those left
# out, as the library selvedge_NAME.
function(selvedge_module name)
  cmake_parse_arguments(module "" "" "LEFT_OUT;HEADERS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cpp)
  foreach(stem IN LISTS module_LEFT_OUT)
    list(FILTER sources EXCLUDE REGEX "(^|/)${stem}\\.cpp$")
  endforeach()
  add_library(selvedge_${name} STATIC ${sources})
  target_link_libraries(selvedge_${name} PRIVATE selvedge_warnings)
  selvedge_compile_fast(selvedge_${name} "${module_HEADERS}" ${sources})
endfunction()

# selvedge_compile_fast(TARGET HEADERS source...): the sources of a folder are compiled together, a few at a time. Those
# with an OpenMP pragma get its flags; all others do without, so that builds with and without OpenMP share them in a
# compile cache, and have a precompiled header. Sources with flags of their own are compiled alone.
function(selvedge_compile_fast target headers)
  target_precompile_headers(${target} PRIVATE ${headers})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${SELVEDGE_UNITY} UNITY_BUILD_MODE GROUP)
  foreach(source IN LISTS ARGN)
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    get_source_file_property(definitions ${source} COMPILE_DEFINITIONS)
    if(options OR definitions OR source MATCHES "_(absent|fcl|cholmod)\\.cpp$")
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
      continue()
    endif()
    cmake_path(GET source PARENT_PATH room)
    string(REPLACE "/" "_" room "${room}")
    file(READ ${source} text)
    if(text MATCHES "#pragma omp|omp\\.h>")
      string(APPEND room "_openmp")
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS "${OpenMP_CXX_FLAGS}")
    endif()
    math(EXPR batch "0${count_${room}} / ${SELVEDGE_UNITY_BATCH}")
    math(EXPR count_${room} "0${count_${room}} + 1")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${room}${batch})
  endforeach()
endfunction()
