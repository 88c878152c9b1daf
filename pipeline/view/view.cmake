# The viewer page: its sources and those of three.js become part of the program.
find_path(SELVEDGE_THREE_DIR three.min.js HINTS /usr/share/javascript/three /usr/share/nodejs/three
  DOC "Folder of three.js r111 (Debian: libjs-three) with three.min.js and examples/js/controls")
if(SELVEDGE_THREE_DIR)
  set(three_files ${SELVEDGE_THREE_DIR}/three.min.js ${SELVEDGE_THREE_DIR}/examples/js/controls/OrbitControls.js)
else()
  message(STATUS "three.js not found: a program with `selvedge view` needs the package libjs-three")
  set(three_files "")
endif()

set(scripts data.js palette.js cloth.js stage.js plots.js panels.js controls.js maps.js probe.js main.js)
set(page ${CMAKE_CURRENT_BINARY_DIR}/page_sources.cpp)
set(inputs ${scripts} page.html page.css embed.cmake)
list(TRANSFORM inputs PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/view/)
list(JOIN scripts "," script_list)
add_custom_command(OUTPUT ${page} DEPENDS ${inputs} ${three_files} VERBATIM
  COMMAND ${CMAKE_COMMAND} -DFOLDER=${CMAKE_CURRENT_SOURCE_DIR}/view -DSCRIPTS=${script_list}
    -DTHREE=${SELVEDGE_THREE_DIR} -DOUTPUT=${page} -P ${CMAKE_CURRENT_SOURCE_DIR}/view/embed.cmake)
target_sources(selvedge_pipeline PRIVATE ${page})
