# cmake --install: the libraries collision and physics with their headers below include/selvedge, for
# find_package(selvedge); and the program, where it is built, with its scenes, which it finds beside itself.
include(CMakePackageConfigHelpers)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/include/selvedge SYMBOLIC)

set(package lib/cmake/selvedge)
foreach(name collision physics)
  set_target_properties(selvedge_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS selvedge_${name} EXPORT selvedge ARCHIVE DESTINATION lib)
endforeach()
if(TARGET selvedge_fcl)
  install(TARGETS selvedge_fcl EXPORT selvedge)
endif()
install(EXPORT selvedge FILE selvedgeTargets.cmake NAMESPACE selvedge:: DESTINATION ${package})
configure_package_config_file(cmake/selvedgeConfig.cmake.in ${PROJECT_BINARY_DIR}/selvedgeConfig.cmake
  INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/selvedgeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/selvedgeConfig.cmake ${PROJECT_BINARY_DIR}/selvedgeConfigVersion.cmake
  DESTINATION ${package})
install(CODE "set(source \"${PROJECT_SOURCE_DIR}\")")
install(SCRIPT cmake/install-headers.cmake)
if(SELVEDGE_PROGRAM)
  install(TARGETS selvedge RUNTIME DESTINATION bin)
  install(DIRECTORY configs DESTINATION share/selvedge)
endif()
