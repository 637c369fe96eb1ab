# The npm package: built for WebAssembly beside this build, and run by node. Included by tests/CMakeLists.txt.

find_program(LABIAL_ANY_CLANG NAMES clang clang-19 clang-18 clang-17 clang-16 clang-15 clang-14)
find_program(LABIAL_WASM_LINKER NAMES wasm-ld wasm-ld-19 wasm-ld-18 wasm-ld-17 wasm-ld-16 wasm-ld-15 wasm-ld-14)
find_program(LABIAL_NODE node)
mark_as_advanced(LABIAL_ANY_CLANG LABIAL_WASM_LINKER LABIAL_NODE)
if(LABIAL_ANY_CLANG AND LABIAL_WASM_LINKER AND LABIAL_NODE)
  add_test(NAME npm_package COMMAND "${CMAKE_CTEST_COMMAND}" --build-and-test
    "${PROJECT_SOURCE_DIR}" "${PROJECT_BINARY_DIR}/wasm" --build-generator "${CMAKE_GENERATOR}" --build-target npm
    --build-options "-DCMAKE_TOOLCHAIN_FILE=${PROJECT_SOURCE_DIR}/boards/toolchains/wasm.cmake"
      -DLABIAL_BUILD_TESTS=OFF -DLABIAL_BUILD_EXAMPLES=OFF "-DLABIAL_WERROR=${LABIAL_WERROR}")
  set_tests_properties(npm_package PROPERTIES LABELS web FIXTURES_SETUP npm RESOURCE_LOCK setup TIMEOUT 300)
  set(LABIAL_NPM_PACKAGE "${PROJECT_BINARY_DIR}/wasm/npm")
  add_subdirectory(npm)
else()
  labial_left_out("The tests of the npm package are left out, they need clang, wasm-ld and node: "
                  "install the Debian packages clang, lld and nodejs.")
  labial_disabled_test(npm_package)
endif()
