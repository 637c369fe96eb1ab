# BBC micro:bit: Cortex-M0, 256 KB of flash, 16 KB of RAM.
set(LABIAL_BOARD m0)
set(LABIAL_BOARD_MACHINE microbit)
set(LABIAL_BOARD_CPU "-mcpu=cortex-m0 -mthumb")
set(LABIAL_BOARD_LINK arm/microbit.ld)
include("${CMAKE_CURRENT_LIST_DIR}/arm.cmake")
