# labial_board_tools(PREFIX p COMPILER_PACKAGE d QEMU q QEMU_PACKAGE d ICOUNT i) finds the compiler and the emulator of
# a board, or ends with one sentence that names what Debian calls them.
macro(labial_board_tools)
  cmake_parse_arguments(tools "" "PREFIX;COMPILER_PACKAGE;QEMU;QEMU_PACKAGE;ICOUNT" "" ${ARGN})
  find_program(LABIAL_BOARD_COMPILER "${tools_PREFIX}gcc")
  find_program(LABIAL_BOARD_QEMU "${tools_QEMU}")
  mark_as_advanced(LABIAL_BOARD_COMPILER LABIAL_BOARD_QEMU)

  set(missing "")
  set(packages "")
  if(NOT LABIAL_BOARD_COMPILER)
    list(APPEND missing "${tools_PREFIX}gcc")
    list(APPEND packages "${tools_COMPILER_PACKAGE}")
  endif()
  if(NOT LABIAL_BOARD_QEMU)
    list(APPEND missing "${tools_QEMU}")
    list(APPEND packages "${tools_QEMU_PACKAGE}")
  endif()
  if(missing)
    list(JOIN missing " and " missing)
    list(JOIN packages " " packages)
    message(FATAL_ERROR "The board ${LABIAL_BOARD} needs ${missing}: install from Debian ${packages}.")
  endif()

  set(CMAKE_C_COMPILER "${LABIAL_BOARD_COMPILER}")
  # Without a C library nothing links until the board's start-up code is there, so checks of the compiler do not link.
  set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
  get_filename_component(tools_include "${CMAKE_CURRENT_LIST_DIR}/../include" ABSOLUTE)
  set(CMAKE_C_FLAGS_INIT "${LABIAL_BOARD_CPU} -ffreestanding -isystem ${tools_include}")
  set(CMAKE_ASM_FLAGS_INIT "${LABIAL_BOARD_CPU}")
  set(CMAKE_EXE_LINKER_FLAGS_INIT "-nostdlib")
  set(CMAKE_C_STANDARD_LIBRARIES_INIT "-lgcc") # the compiler's own: division, 64-bit products
  set(CMAKE_EXECUTABLE_SUFFIX_C .elf)
  # Text goes to the standard output, main's result becomes the exit status, and instructions are counted exactly, so
  # that a run can be repeated to the instruction.
  set(CMAKE_CROSSCOMPILING_EMULATOR
      "${LABIAL_BOARD_QEMU}" -M "${LABIAL_BOARD_MACHINE}" -display none -monitor none -serial none
      -chardev stdio,id=text -semihosting-config enable=on,target=native,chardev=text
      -icount "${tools_ICOUNT},align=off,sleep=off" -kernel)
  set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
  set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
endmacro()
