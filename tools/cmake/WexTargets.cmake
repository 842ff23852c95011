# wex_library(NAME SOURCES ... [DEPS ...] [PRIVATE_DEPS ...]), wex_test(NAME [DEPS ...] [LABELS ...])
# and wex_vcan_test(NAME [FAULTS] [DEPS ...] [TIMEOUT seconds]).
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
# Every test of it is one of ctest's; ONE_PROCESS: the executable is, for tests that share what takes
# long to build.
function(wex_test name)
  cmake_parse_arguments(ARG "ONE_PROCESS" "TIMEOUT" "DEPS;LABELS" ${ARGN})
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
  set(properties LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT} ENVIRONMENT "OPENBLAS_NUM_THREADS=1")
  if(ARG_ONE_PROCESS)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES ${properties})
  else()
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES ${properties})
  endif()
endfunction()

# A test that needs a CAN bus: the executable NAME through tools/with_vcan, as one test (one boot of
# User-Mode Linux), alone on the machine. Where no CAN can be had it fails; skipping fails too.
# FAULTS: with_vcan --faults.
function(wex_vcan_test name)
  cmake_parse_arguments(ARG "FAULTS" "TIMEOUT" "DEPS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  set(options "")
  if(ARG_FAULTS)
    set(options --faults)
  endif()
  math(EXPR kill_after "${ARG_TIMEOUT} + 15") # with_vcan says more about a time-out than ctest
  set(environment OPENBLAS_NUM_THREADS=1 WITH_VCAN_TIMEOUT=${ARG_TIMEOUT})
  add_executable(${name} ${name}.cpp)
  target_link_libraries(${name} PRIVATE ${ARG_DEPS} wex_flags GTest::gmock_main)
  add_test(NAME ${name} COMMAND "${CMAKE_SOURCE_DIR}/tools/with_vcan" ${options} -- $<TARGET_FILE:${name}>)
  set_tests_properties(${name} PROPERTIES LABELS vcan TIMEOUT ${kill_after} RUN_SERIAL TRUE
    ENVIRONMENT "${environment}" FAIL_REGULAR_EXPRESSION "\\[  SKIPPED \\];DISABLED TEST")
endfunction()
