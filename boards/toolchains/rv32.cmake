# SiFive E: RV32IMAC, 16 KB of RAM, programs run from serial flash.
set(LABIAL_BOARD rv32)
set(LABIAL_BOARD_MACHINE sifive_e)
set(LABIAL_BOARD_CPU "-march=rv32imac -mabi=ilp32")
set(LABIAL_BOARD_LINK riscv/sifive_e.ld)
include("${CMAKE_CURRENT_LIST_DIR}/riscv.cmake")
