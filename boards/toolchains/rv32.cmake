# SiFive E: RV32IMAC, 16 KB of RAM, programs run from serial flash.
set(LABIAL_BOARD rv32)
set(LABIAL_BOARD_MACHINE sifive_e)
set(LABIAL_BOARD_CPU "-march=rv32imac -mabi=ilp32")
set(LABIAL_BOARD_LINK riscv/sifive_e.ld)
# What the figures name: the core, and the clock in MHz of a usual chip that has it.
set(LABIAL_BOARD_CORE "RV32IMAC")
set(LABIAL_BOARD_CLOCK 108)
set(LABIAL_BOARD_CHIP "GD32VF103")
include("${CMAKE_CURRENT_LIST_DIR}/riscv.cmake")
