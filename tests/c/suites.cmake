# Each c/test_*.c is a C suite; with them the builds of other limits and the parser of timings. Included by
# tests/CMakeLists.txt.

# A day in the life of a face reaches no line that the other suites do not, and takes minutes where every instruction is
# checked or counted.
if(LABIAL_INSTRUMENT MATCHES "^(memcheck|coverage)$")
  list(FILTER suites EXCLUDE REGEX "/test_soak\\.c$")
endif()
foreach(source IN LISTS suites)
  get_filename_component(name "${source}" NAME_WE)
  add_executable(${name} ${source})
  target_link_libraries(${name} PRIVATE labial_test_helpers labial_cmocka)
  labial_target(${name})
  add_test(NAME ${name} COMMAND ${runner} $<TARGET_FILE:${name}>)
  set_tests_properties(${name} PROPERTIES TIMEOUT 1800 ENVIRONMENT UBSAN_OPTIONS=print_stacktrace=1)
  if(LABIAL_REQUIRE_ALL)
    set_tests_properties(${name} PROPERTIES FAIL_REGULAR_EXPRESSION "SKIPPED")
  endif()
endforeach()

if(NOT CMAKE_CROSSCOMPILING)
  if(LABIAL_INSTRUMENT STREQUAL "none")
    message(STATUS "Builds for other limits are left to the presets `sanitize` and `memcheck`.")
  else()
    add_subdirectory(limits)
  endif()

  # labial-say's parser of timings; the same cases hold Python's and JavaScript's readers (python/test_grammar.py).
  file(GLOB timings_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/examples/say/timings*.c")
  add_executable(check_timings grammar/check_timings.c ${timings_sources})
  target_include_directories(check_timings PRIVATE "${PROJECT_SOURCE_DIR}/examples/say")
  labial_target(check_timings)
  add_test(NAME grammar COMMAND ${runner} $<TARGET_FILE:check_timings> "${CMAKE_CURRENT_SOURCE_DIR}/grammar/cases.tsv")
endif()
