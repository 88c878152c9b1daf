# The extension of the Python package. nanobind comes with its own Python package; scikit-build-core makes it known.
find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module OPTIONAL_COMPONENTS Development.SABIModule)
if(NOT nanobind_ROOT)
  execute_process(COMMAND ${Python_EXECUTABLE} -m nanobind --cmake_dir OUTPUT_STRIP_TRAILING_WHITESPACE
    OUTPUT_VARIABLE nanobind_ROOT)
endif()
find_package(nanobind CONFIG REQUIRED)
file(GLOB sources CONFIGURE_DEPENDS python/*.cpp)
# With a backend, a Python package that holds nanobind's compiled part, one extension serves CPython 3.10 and later.
# Without one it is linked into the extension, which then serves the Python that it is built with.
if(SELVEDGE_PYTHON_BACKEND)
  set(nanobind_mode BACKEND_MODULE ${SELVEDGE_PYTHON_BACKEND})
else()
  set(nanobind_mode NB_STATIC STABLE_ABI)
endif()
if(SELVEDGE_OPENMP)
  separate_arguments(openmp_flags UNIX_COMMAND "${OpenMP_CXX_FLAGS}")
  set_source_files_properties(python/module_nanobind.cpp PROPERTIES COMPILE_OPTIONS "${openmp_flags}")
endif()
nanobind_add_module(_selvedge ${nanobind_mode} NB_SUPPRESS_WARNINGS ${sources})
target_include_directories(_selvedge PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(_selvedge PRIVATE selvedge_studies selvedge_warnings)
target_compile_features(_selvedge PRIVATE cxx_std_20)
# What the libraries export is nobody else's: calls among them are direct, and another extension's are not mixed up.
target_link_options(_selvedge PRIVATE LINKER:--exclude-libs,ALL)

# A package that is complete, for the tests of a build tree.
set(package ${PROJECT_BINARY_DIR}/python/selvedge)
set_target_properties(_selvedge PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${package})
file(GLOB files CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/python/selvedge python/selvedge/*.py*
  python/selvedge/fleet/*.py python/selvedge/py.typed)
foreach(file IN LISTS files)
  configure_file(python/selvedge/${file} ${package}/${file} COPYONLY)
endforeach()

install(TARGETS _selvedge LIBRARY DESTINATION selvedge COMPONENT python)
# What scenes name without a path: materials, bodies, outfits. Trained networks are left out.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/configs DESTINATION selvedge COMPONENT python FILES_MATCHING PATTERN *.yaml)
