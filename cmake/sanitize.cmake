# SELVEDGE_SANITIZE is a list for -fsanitize, such as address;undefined. SELVEDGE_NO_SANITIZE lists checks to leave out
# of it: those that gcc takes longest to compile are left to the full build. A finding ends the program. The flags go
# where compile checks see them too.
if(SELVEDGE_SANITIZE)
  list(JOIN SELVEDGE_SANITIZE "," sanitizers)
  string(APPEND CMAKE_CXX_FLAGS " -fsanitize=${sanitizers} -fno-omit-frame-pointer -fno-sanitize-recover=all")
  if(SELVEDGE_NO_SANITIZE)
    list(JOIN SELVEDGE_NO_SANITIZE "," left_out)
    string(APPEND CMAKE_CXX_FLAGS " -fno-sanitize=${left_out}")
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # Through the sanitizers' code gcc sees std::regex read what was never written; without them it does not.
    string(APPEND CMAKE_CXX_FLAGS " -Wno-maybe-uninitialized")
  endif()
endif()
