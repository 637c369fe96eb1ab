# RISC-V boards under QEMU. The toolchain file of a board sets LABIAL_BOARD, LABIAL_BOARD_MACHINE (QEMU's name of the
# board), LABIAL_BOARD_CPU (compiler options) and LABIAL_BOARD_LINK (linker script), and includes this one.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR riscv32)

include("${CMAKE_CURRENT_LIST_DIR}/tools.cmake")
labial_board_tools(
  PREFIX riscv64-unknown-elf- COMPILER_PACKAGE gcc-riscv64-unknown-elf
  QEMU qemu-system-riscv32 QEMU_PACKAGE qemu-system-misc
  ICOUNT shift=0)
