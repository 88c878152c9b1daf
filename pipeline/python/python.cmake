# The extension of the Python package. nanobind comes with its own Python package; scikit-build-core makes it known.
find_package(Python 3.9 REQUIRED COMPONENTS Interpreter Development.Module OPTIONAL_COMPONENTS Development.SABIModule)
if(NOT nanobind_ROOT)
  execute_process(COMMAND ${Python_EXECUTABLE} -m nanobind --cmake_dir OUTPUT_STRIP_TRAILING_WHITESPACE
    OUTPUT_VARIABLE nanobind_ROOT)
endif()
find_package(nanobind CONFIG REQUIRED)
nanobind_add_module(_selvedge NB_STATIC STABLE_ABI python/module_nanobind.cpp python/arrays_nanobind.cpp)
target_include_directories(_selvedge PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(_selvedge PRIVATE selvedge_pipeline)
target_compile_features(_selvedge PRIVATE cxx_std_20)
set_target_properties(_selvedge PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/python/selvedge)
configure_file(python/selvedge/__init__.py ${PROJECT_BINARY_DIR}/python/selvedge/__init__.py COPYONLY)
install(TARGETS _selvedge LIBRARY DESTINATION selvedge COMPONENT python)
