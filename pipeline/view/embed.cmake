# cmake -DFOLDER=... -DSCRIPTS=a.js,b.js -DTHREE=... -DOUTPUT=... -P embed.cmake
# Writes the page's sources as string literals; the scripts share one scope, in the order given. Those of three.js are
# empty where its folder has none.
file(READ ${FOLDER}/page.html html)
file(READ ${FOLDER}/page.css style)
string(REPLACE "," ";" SCRIPTS "${SCRIPTS}")
set(script "")
foreach(name IN LISTS SCRIPTS)
  file(READ ${FOLDER}/${name} text)
  string(APPEND script "${text}\n")
endforeach()
set(three "")
set(orbit "")
if(EXISTS ${THREE}/three.min.js)
  file(READ ${THREE}/three.min.js three)
  file(READ ${THREE}/examples/js/controls/OrbitControls.js orbit)
endif()
file(WRITE ${OUTPUT} "#include \"pipeline/view/page_sources.hpp\"

namespace selvedge {

PageSources page_sources() {
  return {R\"__page__(${html})__page__\",   R\"__page__(${style})__page__\", R\"__page__(${script})__page__\",
          R\"__page__(${three})__page__\", R\"__page__(${orbit})__page__\"};
}

}  // namespace selvedge
")
