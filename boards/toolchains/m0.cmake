# BBC micro:bit: Cortex-M0, 256 KB of flash, 16 KB of RAM.
set(LABIAL_BOARD m0)
set(LABIAL_BOARD_MACHINE microbit)
set(LABIAL_BOARD_CPU "-mcpu=cortex-m0 -mthumb")
set(LABIAL_BOARD_LINK arm/microbit.ld)
# What the figures name: the core, and the clock in MHz of a usual chip that has it.
set(LABIAL_BOARD_CORE "Cortex-M0")
set(LABIAL_BOARD_CLOCK 16)
set(LABIAL_BOARD_CHIP "nRF51822 of the micro:bit")
include("${CMAKE_CURRENT_LIST_DIR}/arm.cmake")
