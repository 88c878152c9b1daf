add_library(selvedge_warnings INTERFACE)
target_compile_options(selvedge_warnings INTERFACE -Wall -Wextra -Wno-unknown-pragmas -Wshadow -Wnon-virtual-dtor $<$<BOOL:${SELVEDGE_WERROR}>:-Werror>)
if(SELVEDGE_UNITY)
  # A file that another includes is no header here.
  target_compile_options(selvedge_warnings INTERFACE -Wno-subobject-linkage)
endif()
