# What a person may choose at configure time.
option(WEX_BUILD_TESTS "Build the tests" ON)
set(WEX_ARCH_FLAGS "-mavx2;-mfma" CACHE STRING "Instruction set flags (x86-64-v3 by default)")
set(WEX_SANITIZE "" CACHE STRING "Sanitizers, e.g. address,undefined or thread")

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Paths relative to the source folder, so that a fresh clone elsewhere finds what was compiled here.
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1
      "${CCACHE_PROGRAM}")
endif()
