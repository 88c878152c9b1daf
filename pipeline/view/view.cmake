# The viewer page: its sources become part of the program; three.js is read from its package when a page is written.
find_path(SELVEDGE_THREE_DIR three.min.js HINTS /usr/share/javascript/three /usr/share/nodejs/three
  DOC "Folder of three.js r111 (Debian: libjs-three) with three.min.js and examples/js/controls")
set(three ${SELVEDGE_THREE_DIR})
if(NOT three)
  message(STATUS "three.js not found: `selvedge view` needs the package libjs-three")
  set(three /usr/share/javascript/three)
endif()

set(scripts data.js palette.js cloth.js stage.js plots.js panels.js controls.js maps.js probe.js main.js)
set(page ${CMAKE_CURRENT_BINARY_DIR}/page_sources.cpp)
set(inputs ${scripts} page.html page.css embed.cmake)
list(TRANSFORM inputs PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/view/)
list(JOIN scripts "," script_list)
add_custom_command(OUTPUT ${page} DEPENDS ${inputs} VERBATIM
  COMMAND ${CMAKE_COMMAND} -DFOLDER=${CMAKE_CURRENT_SOURCE_DIR}/view -DSCRIPTS=${script_list} -DOUTPUT=${page}
    -P ${CMAKE_CURRENT_SOURCE_DIR}/view/embed.cmake)
target_sources(selvedge_pipeline PRIVATE ${page})
target_compile_definitions(selvedge_pipeline PRIVATE SELVEDGE_THREE_DIR="${three}")
