add_library(selvedge_warnings INTERFACE)
target_compile_options(selvedge_warnings INTERFACE -Wall -Wextra -Wno-unknown-pragmas -Wshadow -Wnon-virtual-dtor $<$<BOOL:${SELVEDGE_WERROR}>:-Werror>)
