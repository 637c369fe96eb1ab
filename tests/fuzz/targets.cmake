# Fuzzing: each target gets its share of LABIAL_FUZZ_SECONDS. Included by tests/CMakeLists.txt.

if(NOT CMAKE_C_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "Fuzzing needs clang with libFuzzer, not ${CMAKE_C_COMPILER}: "
                      "install the Debian packages clang and libclang-rt-14-dev.")
endif()
labial_check_sanitizers("-fsanitize=fuzzer;${LABIAL_SANITIZERS}")

set(LABIAL_FUZZ_SECONDS "" CACHE STRING "Seconds that all fuzz targets together run, 60 when empty")
set(seconds "${LABIAL_FUZZ_SECONDS}")
if(seconds STREQUAL "")
  set(seconds 60)
endif()
file(GLOB sources CONFIGURE_DEPENDS fuzz/fuzz_*.c)
list(LENGTH sources count)
if(count EQUAL 0)
  message(FATAL_ERROR "There is no fuzz target in tests/fuzz.")
endif()
# The longest input of each target, bytes. Inputs have this length from the start; if libFuzzer grows them, they stay
# below ten bytes.
set(fuzz_beside_longest 2048)
set(fuzz_blob_longest 45056)
set(fuzz_face_longest 2048)
set(fuzz_hear_longest 2048)
set(fuzz_names_longest 64)
set(fuzz_rig_longest 1024)
set(fuzz_stream_longest 1024)
set(fuzz_timings_longest 2048)
set(fuzz_voice_longest 1024)
set(fuzz_words_longest 1024)
math(EXPR share "(${seconds} + ${count} - 1) / ${count}")
math(EXPR limit "${share} + 120")
foreach(source IN LISTS sources)
  get_filename_component(name "${source}" NAME_WE)
  add_executable(${name} ${source})
  target_link_libraries(${name} PRIVATE labial_test_helpers)
  labial_target(${name})
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)

  # Each run starts from the corpus of the previous one and the seeds.
  set(corpus "${CMAKE_CURRENT_BINARY_DIR}/corpus/${name}")
  set(written "${CMAKE_CURRENT_SOURCE_DIR}/fuzz/seeds/${name}")
  set(seeds "${CMAKE_CURRENT_BINARY_DIR}/seeds/${name}")
  file(MAKE_DIRECTORY "${corpus}" "${seeds}")
  if(EXISTS "${written}")
    set(seeds "${written}")
  endif()
  file(STRINGS fuzz/make_seeds.c made REGEX "\"${name}\"")
  if(NOT made AND NOT EXISTS "${written}" OR NOT ${name}_longest)
    message(FATAL_ERROR "${name} has no seeds, or its longest input is not given.")
  endif()
  add_test(NAME ${name} COMMAND ${name} -max_total_time=${share} -timeout=20 -print_final_stats=1
    -len_control=0 -max_len=${${name}_longest} "-artifact_prefix=${CMAKE_CURRENT_BINARY_DIR}/${name}-"
    "${corpus}" "${seeds}")
  set_tests_properties(${name} PROPERTIES TIMEOUT ${limit} FIXTURES_REQUIRED seeds)
endforeach()

add_executable(make_seeds fuzz/make_seeds.c conformance/player.c conformance/vectors.c)
target_include_directories(make_seeds PRIVATE conformance)
target_link_libraries(make_seeds PRIVATE labial_test_helpers)
labial_target(make_seeds)
add_test(NAME make_seeds COMMAND make_seeds "${CMAKE_CURRENT_BINARY_DIR}/seeds"
  "${CMAKE_CURRENT_SOURCE_DIR}/labels/espeak.tsv")
set_tests_properties(make_seeds PROPERTIES FIXTURES_SETUP seeds)
