# Mutation: small changes of the library that the suites must notice; beside the sanitizers' suites only a few, so that
# the whole does not rot. Included by tests/CMakeLists.txt.

find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter)
labial_check_sanitizers("${LABIAL_SANITIZERS}")
if(NOT LABIAL_CMOCKA_LIBRARY)
  message(FATAL_ERROR "Mutation needs cmocka: install the Debian package libcmocka-dev.")
endif()
set(count 300)
if(LABIAL_INSTRUMENT STREQUAL "sanitize")
  set(count 2)
endif()
add_test(NAME mutate COMMAND "${Python3_EXECUTABLE}" -u "${CMAKE_CURRENT_SOURCE_DIR}/mutation/mutate.py"
  --build "${CMAKE_CURRENT_BINARY_DIR}/mutation" --compiler "${CMAKE_C_COMPILER}" --count ${count}
  --cmocka "${LABIAL_CMOCKA_INCLUDE}" "${LABIAL_CMOCKA_LIBRARY}")
set_tests_properties(mutate PROPERTIES TIMEOUT 14400)
