# Mutation: small changes of the library that the suites must detect. With the sanitizers only two are tried, in one
# file with its own suite, to test the program itself. Included by tests/CMakeLists.txt.

find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter)
labial_check_sanitizers("${LABIAL_SANITIZERS}")
if(NOT LABIAL_CMOCKA_LIBRARY)
  message(FATAL_ERROR "Mutation needs cmocka: install the Debian package libcmocka-dev.")
endif()
include("${PROJECT_SOURCE_DIR}/tests/setup/unity.cmake")
if(NOT LABIAL_UNITY_SOURCE)
  if(LABIAL_INSTRUMENT STREQUAL "sanitize")
    labial_left_out("The mutants are left out: they need the source of Unity (ThrowTheSwitch). Set LABIAL_UNITY_DIR.")
    labial_disabled_test(mutate)
    return()
  endif()
  message(FATAL_ERROR "Mutation needs the source of Unity (ThrowTheSwitch): set LABIAL_UNITY_DIR to a copy.")
endif()
# labial_mutate(<name> <option of mutate.py>...)
function(labial_mutate name)
  add_test(NAME ${name} COMMAND "${Python3_EXECUTABLE}" -u "${CMAKE_CURRENT_SOURCE_DIR}/mutation/mutate.py"
    --build "${CMAKE_CURRENT_BINARY_DIR}/${name}" --compiler "${CMAKE_C_COMPILER}" ${ARGN}
    --cmocka "${LABIAL_CMOCKA_INCLUDE}" "${LABIAL_CMOCKA_LIBRARY}"
    --unity "${LABIAL_UNITY_SOURCE}")
  set_tests_properties(${name} PROPERTIES TIMEOUT 14400)
endfunction()

if(LABIAL_INSTRUMENT STREQUAL "sanitize")
  labial_mutate(mutate --count 2 --files viterbi.c --suites test_viterbi)
else()
  labial_mutate(mutate --count 300 --kinds sign number condition statement)
  labial_mutate(mutate_users --count 120 --kinds argument constant reset) # what users would notice
endif()
