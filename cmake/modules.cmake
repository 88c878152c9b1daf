# How a module is compiled: the files of a room together, one precompiled header, OpenMP only where there is a pragma.

set(SELVEDGE_COMMON_HEADERS <algorithm> <array> <cassert> <cmath> <functional> <map> <optional> <set> <span> <string>
  <vector> <Eigen/Core> <Eigen/Geometry>)

# selvedge_module(NAME LEFT_OUT stem... ALONE room... HEADERS header... PUBLIC library... PRIVATE library...): the sources of
# this folder and of its rooms, but those left out, as the library selvedge_NAME. The files of the rooms ALONE are not
# compiled together. Files with an OpenMP pragma are a target of their own, selvedge_NAME_parallel: all others have the same
# flags in builds with OpenMP and without, so that a compile cache serves both.
function(selvedge_module name)
  cmake_parse_arguments(module "" "" "LEFT_OUT;ALONE;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cpp)
  foreach(stem IN LISTS module_LEFT_OUT)
    list(FILTER sources EXCLUDE REGEX "(^|/)${stem}\\.cpp$")
  endforeach()
  set(parallel ${sources})
  foreach(source IN LISTS sources)
    file(READ ${source} text)
    if(NOT text MATCHES "#pragma omp|omp\\.h>")
      list(REMOVE_ITEM parallel ${source})
    endif()
  endforeach()
  list(REMOVE_ITEM sources ${parallel})

  set(objects selvedge_${name}_parallel)
  add_library(${objects} OBJECT ${parallel})
  add_library(selvedge_${name} STATIC ${sources} $<TARGET_OBJECTS:${objects}>)
  target_include_directories(selvedge_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(selvedge_${name} PUBLIC ${module_PUBLIC} PRIVATE ${module_PRIVATE} selvedge_warnings)
  target_include_directories(${objects} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${objects} PRIVATE ${module_PUBLIC} ${module_PRIVATE} selvedge_warnings)
  if(SELVEDGE_OPENMP)
    target_compile_options(${objects} PRIVATE ${OpenMP_CXX_FLAGS})
    target_link_libraries(selvedge_${name} PUBLIC ${OpenMP_CXX_LIBRARIES})
  endif()
  selvedge_compile_together(selvedge_${name} "${module_ALONE}" "${module_HEADERS}" ${sources})
  selvedge_compile_together(${objects} "${module_ALONE}" "${module_HEADERS}" ${parallel})
endfunction()

# selvedge_compile_together(TARGET ALONE HEADERS source...): the sources of a folder are compiled a few at a time, with a
# precompiled header. Sources with flags of their own are compiled alone.
function(selvedge_compile_together target alone headers)
  target_precompile_headers(${target} PRIVATE ${headers})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${SELVEDGE_UNITY} UNITY_BUILD_MODE GROUP)
  foreach(source IN LISTS ARGN)
    cmake_path(GET source PARENT_PATH room)
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    get_source_file_property(definitions ${source} COMPILE_DEFINITIONS)
    if(options OR definitions OR source MATCHES "_(absent|fcl|cholmod)\\.cpp$")
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
    elseif(NOT room IN_LIST alone)
      string(REPLACE "/" "_" room "${room}")
      math(EXPR batch "0${count_${room}} / ${SELVEDGE_UNITY_BATCH}")
      math(EXPR count_${room} "0${count_${room}} + 1")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${room}${batch})
    endif()
  endforeach()
endfunction()
