# Mutation: small changes of the library that the suites must notice; beside the sanitizers' suites only two, in one file
# and for its own suite, so that the program does not rot. Included by tests/CMakeLists.txt.

find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter)
labial_check_sanitizers("${LABIAL_SANITIZERS}")
if(NOT LABIAL_CMOCKA_LIBRARY)
  message(FATAL_ERROR "Mutation needs cmocka: install the Debian package libcmocka-dev.")
endif()
set(which --count 300)
if(LABIAL_INSTRUMENT STREQUAL "sanitize")
  set(which --count 2 --files viterbi.c --suites test_viterbi)
endif()
add_test(NAME mutate COMMAND "${Python3_EXECUTABLE}" -u "${CMAKE_CURRENT_SOURCE_DIR}/mutation/mutate.py"
  --build "${CMAKE_CURRENT_BINARY_DIR}/mutation" --compiler "${CMAKE_C_COMPILER}" ${which}
  --cmocka "${LABIAL_CMOCKA_INCLUDE}" "${LABIAL_CMOCKA_LIBRARY}")
set_tests_properties(mutate PROPERTIES TIMEOUT 14400)
