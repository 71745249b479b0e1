if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()

# With ccache, no build folder compiles the same source again.
find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER
    ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

# Equal seeds must give equal trajectories on every machine, so the compiler may not fuse multiply
# and add.
add_compile_options(-ffp-contract=off)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  add_compile_options("SHELL:-include ${CMAKE_SOURCE_DIR}/cmake/unfused_neon.h")
endif()

# Programs with sanitizers are large, and lld links them faster.
find_program(LLD ld.lld)
if(LLD AND CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  add_link_options(-fuse-ld=lld)
endif()

option(ERGOCAST_WERROR "Treat warnings as errors (continuous integration sets this)" OFF)
add_library(ergocast_warnings INTERFACE)
add_library(ergocast::warnings ALIAS ergocast_warnings)
target_compile_options(ergocast_warnings INTERFACE
  -Wall -Wextra -Wpedantic $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local> -Wnon-virtual-dtor $<$<BOOL:${ERGOCAST_WERROR}>:-Werror>)
# The page is one long string literal.
target_compile_options(ergocast_warnings INTERFACE $<$<CXX_COMPILER_ID:Clang>:-Wno-overlength-strings>)
# GCC 12 wrongly warns of overlaps in "text" + std::string (its bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(ergocast_warnings INTERFACE -Wno-restrict)
endif()
