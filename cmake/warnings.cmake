add_library(selvedge_warnings INTERFACE)
target_compile_options(selvedge_warnings INTERFACE -Wall -Wextra -Wno-unknown-pragmas -Wshadow -Wnon-virtual-dtor
  $<$<BOOL:${SELVEDGE_WERROR}>:-Werror>)
if(SELVEDGE_UNITY)
  # A file that another includes is no header here.
  target_compile_options(selvedge_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
# Boxes are compared without branches.
target_compile_options(selvedge_warnings INTERFACE
  "$<$<CXX_COMPILER_ID:Clang>:-Wno-unknown-warning-option;-Wno-bitwise-instead-of-logical>")
