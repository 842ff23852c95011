# wex_library(NAME SOURCES ... [DEPS ...] [PRIVATE_DEPS ...]) and wex_test(NAME [DEPS ...] [LABELS ...]).
# All project flags live here.
include(GoogleTest)

add_library(wex_flags INTERFACE)
target_compile_options(wex_flags INTERFACE -Wall -Wextra -Wconversion -Wno-sign-conversion -Werror ${WEX_ARCH_FLAGS})
if(WEX_SANITIZE)
  target_compile_options(wex_flags INTERFACE -fsanitize=${WEX_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all
                                             # instrumented code makes g++ 12 see ghosts here:
                                             -Wno-maybe-uninitialized)
  target_link_options(wex_flags INTERFACE -fsanitize=${WEX_SANITIZE})
endif()

function(wex_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;PRIVATE_DEPS" ${ARGN})
  add_library(wex_${name} STATIC ${ARG_SOURCES})
  add_library(wex::${name} ALIAS wex_${name})
  target_include_directories(wex_${name} PUBLIC "${CMAKE_SOURCE_DIR}")
  target_link_libraries(wex_${name} PUBLIC ${ARG_DEPS} PRIVATE ${ARG_PRIVATE_DEPS} wex_flags)
endfunction()

add_custom_target(unit_tests COMMENT "The tests labelled unit are built")

# tests/AREA/NAME.cpp becomes the executable NAME; labels: unit (default), integration, end_to_end.
function(wex_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "DEPS;LABELS" ${ARGN})
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_executable(${name} ${name}.cpp)
  target_link_libraries(${name} PRIVATE ${ARG_DEPS} wex_flags GTest::gmock_main)
  if("unit" IN_LIST ARG_LABELS)
    add_dependencies(unit_tests ${name})
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST
    PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT} ENVIRONMENT "OPENBLAS_NUM_THREADS=1")
endfunction()
