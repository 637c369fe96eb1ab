# Arm MPS2 with AN385: Cortex-M3.
set(LABIAL_BOARD m3)
set(LABIAL_BOARD_MACHINE mps2-an385)
set(LABIAL_BOARD_CPU "-mcpu=cortex-m3 -mthumb")
set(LABIAL_BOARD_LINK arm/mps2.ld)
# What the figures name: the core, and the clock in MHz of a usual chip that has it.
set(LABIAL_BOARD_CORE "Cortex-M3")
set(LABIAL_BOARD_CLOCK 72)
set(LABIAL_BOARD_CHIP "STM32F103")
include("${CMAKE_CURRENT_LIST_DIR}/arm.cmake")
