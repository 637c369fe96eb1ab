# WebAssembly: clang and wasm-ld, no libc, images run by node.
set(LABIAL_BOARD wasm)
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)

find_program(LABIAL_BOARD_COMPILER NAMES clang clang-19 clang-18 clang-17 clang-16 clang-15 clang-14)
find_program(LABIAL_BOARD_LINKER NAMES wasm-ld wasm-ld-19 wasm-ld-18 wasm-ld-17 wasm-ld-16 wasm-ld-15 wasm-ld-14)
find_program(LABIAL_NODE node)
mark_as_advanced(LABIAL_BOARD_COMPILER LABIAL_BOARD_LINKER LABIAL_NODE)
if(NOT LABIAL_BOARD_COMPILER OR NOT LABIAL_BOARD_LINKER OR NOT LABIAL_NODE)
  message(FATAL_ERROR "WebAssembly needs clang, wasm-ld and node: install from Debian clang lld nodejs.")
endif()

set(CMAKE_C_COMPILER "${LABIAL_BOARD_COMPILER}")
set(CMAKE_C_COMPILER_TARGET wasm32)
# Nothing links before memcpy() is there, so checks of the compiler do not link.
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
get_filename_component(wasm_boards "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
set(CMAKE_C_FLAGS_INIT "-ffreestanding -isystem ${wasm_boards}/include")
# The stack lies below all variables: one that overflows leaves the memory and ends the image.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-nostdlib -fuse-ld=${LABIAL_BOARD_LINKER} -Wl,--stack-first -Wl,-z,stack-size=16384")
set(CMAKE_EXECUTABLE_SUFFIX_C .wasm)
set(CMAKE_CROSSCOMPILING_EMULATOR "${LABIAL_NODE}" "${wasm_boards}/wasm/run.mjs")
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
