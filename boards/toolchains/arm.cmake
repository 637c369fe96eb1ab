# Cortex-M boards under QEMU. The toolchain file of a board sets LABIAL_BOARD, LABIAL_BOARD_MACHINE (QEMU's name of the
# board), LABIAL_BOARD_CPU (compiler options) and LABIAL_BOARD_LINK (linker script), and includes this one.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)

include("${CMAKE_CURRENT_LIST_DIR}/tools.cmake")
labial_board_tools(
  PREFIX arm-none-eabi- COMPILER_PACKAGE gcc-arm-none-eabi
  QEMU qemu-system-arm QEMU_PACKAGE qemu-system-arm
  # One instruction takes 2^6 ns of the board's time: the system timer then counts instructions (board_count()).
  ICOUNT shift=6)
