# Arm MPS2 with AN500: Cortex-M7 with double-precision floating point.
set(LABIAL_BOARD m7)
set(LABIAL_BOARD_MACHINE mps2-an500)
set(LABIAL_BOARD_CPU "-mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard")
set(LABIAL_BOARD_LINK arm/mps2.ld)
# What the figures name: the core, and the clock in MHz of a usual chip that has it.
set(LABIAL_BOARD_CORE "Cortex-M7")
set(LABIAL_BOARD_CLOCK 216)
set(LABIAL_BOARD_CHIP "STM32F746")
include("${CMAKE_CURRENT_LIST_DIR}/arm.cmake")
