# Arm MPS2 with AN386: Cortex-M4 with single-precision floating point.
set(LABIAL_BOARD m4)
set(LABIAL_BOARD_MACHINE mps2-an386)
set(LABIAL_BOARD_CPU "-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard")
set(LABIAL_BOARD_LINK arm/mps2.ld)
# What the figures name: the core, and the clock in MHz of a usual chip that has it.
set(LABIAL_BOARD_CORE "Cortex-M4F")
set(LABIAL_BOARD_CLOCK 64)
set(LABIAL_BOARD_CHIP "nRF52840")
include("${CMAKE_CURRENT_LIST_DIR}/arm.cmake")
