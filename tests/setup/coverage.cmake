# Coverage: the suites must take every branch of the library. Included by tests/CMakeLists.txt.

# A comment with GCOVR_EXCL_BR_LINE or the like gives the reason for each excluded line.
find_program(LABIAL_GCOVR gcovr)
mark_as_advanced(LABIAL_GCOVR)
if(NOT LABIAL_GCOVR OR NOT CMAKE_C_COMPILER_ID STREQUAL "GNU")
  message(FATAL_ERROR "Coverage needs gcc and gcovr: install the Debian packages gcc and gcovr.")
endif()
file(GLOB_RECURSE counts "${PROJECT_BINARY_DIR}/*.gcda")
if(counts)
  file(REMOVE ${counts}) # of an earlier run
endif()
add_test(NAME coverage WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
  COMMAND "${LABIAL_GCOVR}" --root . --filter "lib/[^/]*\\.[ch]$" --branches --print-summary --fail-under-branch 100
  "${PROJECT_BINARY_DIR}")
get_property(tests DIRECTORY PROPERTY TESTS)
foreach(folder IN ITEMS limits conformance device)
  get_property(more DIRECTORY ${folder} PROPERTY TESTS)
  list(APPEND tests ${more})
endforeach()
list(REMOVE_ITEM tests coverage)
set_tests_properties(coverage PROPERTIES DEPENDS "${tests}" FAIL_REGULAR_EXPRESSION "out of 0\\)")
