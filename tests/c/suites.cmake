# Each c/test_*.c is a C suite; with them the builds of other limits and the parser of timings. Included by
# tests/CMakeLists.txt.

# Skip the soak test with instrumentation: it covers no further line, and takes minutes where every instruction is checked
# or counted.
if(LABIAL_INSTRUMENT MATCHES "^(memcheck|coverage)$")
  list(FILTER suites EXCLUDE REGEX "/test_soak\\.c$")
endif()
# These compare with the sine of the C library, in which qemu-ppc meets an instruction that it does not know.
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "powerpc")
  list(FILTER suites EXCLUDE REGEX "/test_hear_parts\\.c$")
endif()
# labial_suite_label(<variable> <suite>): the part of the library that a suite tests, which is its label in ctest.
function(labial_suite_label variable name)
  set(label core)
  if(name MATCHES "^test_(hear|voice|words)")
    set(label ${CMAKE_MATCH_1})
  endif()
  set(${variable} ${label} PARENT_SCOPE)
endfunction()
add_custom_target(suites) # all of them, and nothing else
foreach(source IN LISTS suites)
  get_filename_component(name "${source}" NAME_WE)
  if(LABIAL_CMOCKA_MISSING)
    labial_disabled_test(${name})
    continue()
  endif()
  add_executable(${name} ${source})
  add_dependencies(suites ${name})
  target_link_libraries(${name} PRIVATE labial_test_helpers labial_cmocka)
  labial_target(${name})
  if(name STREQUAL "test_soak" AND NOT CMAKE_CROSSCOMPILING AND
      NOT (LABIAL_REQUIRE_ALL AND LABIAL_INSTRUMENT STREQUAL "none"))
    target_compile_definitions(${name} PRIVATE LABIAL_TEST_SHARE=8) # an hour; eight where everything is required
  endif()
  add_test(NAME ${name} COMMAND ${runner} $<TARGET_FILE:${name}>)
  labial_suite_label(label ${name})
  set_tests_properties(${name} PROPERTIES LABELS ${label} TIMEOUT 1800 ENVIRONMENT UBSAN_OPTIONS=print_stacktrace=1)
  if(LABIAL_REQUIRE_ALL)
    set_tests_properties(${name} PROPERTIES FAIL_REGULAR_EXPRESSION "SKIPPED")
  endif()
endforeach()

# What failures say: each line must be there, with all of its numbers.
if(NOT LABIAL_CMOCKA_MISSING)
  add_executable(suite_fails "${CMAKE_CURRENT_SOURCE_DIR}/c/messages/suite_fails.c")
  add_dependencies(suites suite_fails)
  target_link_libraries(suite_fails PRIVATE labial_test_helpers labial_cmocka)
  labial_target(suite_fails)
  set(said "frames.. . 0 is 950, not 800\n" "fap is -7, not 3\n" "most is 4294967295, not -1\n"
    "frames.. is 950\n" "-frames.. is -950, not from -900 to 900\n" "frames.. is 950, not from -900 to 900\n"
    "frames.. is 950, not 800 .seed 77.\n" "frames.. is 950, not 801\n")
  list(JOIN said ".*" said)
  add_test(NAME suite_fails COMMAND ${runner} $<TARGET_FILE:suite_fails>)
  set_tests_properties(suite_fails PROPERTIES LABELS core PASS_REGULAR_EXPRESSION "${said}.*PASSED  . 1 test.*8 FAILED TEST")
endif()

if(NOT CMAKE_CROSSCOMPILING)
  if(LABIAL_INSTRUMENT STREQUAL "none")
    message(STATUS "Builds for other limits are left to the preset `sanitize`.")
  else()
    add_subdirectory(limits)
  endif()
endif()
