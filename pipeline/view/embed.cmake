# cmake -DFOLDER=... -DSCRIPTS=a.js,b.js -DOUTPUT=... -P embed.cmake
# Writes the page's sources as string literals; the scripts share one scope, in the order given.
file(READ ${FOLDER}/page.html html)
file(READ ${FOLDER}/page.css style)
string(REPLACE "," ";" SCRIPTS "${SCRIPTS}")
set(script "")
foreach(name IN LISTS SCRIPTS)
  file(READ ${FOLDER}/${name} text)
  string(APPEND script "${text}\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"pipeline/view/page_sources.hpp\"

namespace selvedge {

PageSources page_sources() {
  return {R\"__page__(${html})__page__\", R\"__page__(${style})__page__\", R\"__page__(${script})__page__\"};
}

}  // namespace selvedge
")
