# Headers of collision and physics go below include/selvedge and name each other by that path there. Needs `source`.
foreach(module collision physics)
  file(GLOB_RECURSE headers RELATIVE ${source} ${source}/${module}/*.hpp)
  foreach(header IN LISTS headers)
    file(READ ${source}/${header} text)
    string(REGEX REPLACE "#include \"(collision|physics)/([^\"]+)\"" "#include <selvedge/\\1/\\2>" text "${text}")
    file(WRITE "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/include/selvedge/${header}" "${text}")
  endforeach()
endforeach()
