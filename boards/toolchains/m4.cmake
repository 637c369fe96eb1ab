# Arm MPS2 with AN386: Cortex-M4 with single-precision floating point.
set(LABIAL_BOARD m4)
set(LABIAL_BOARD_MACHINE mps2-an386)
set(LABIAL_BOARD_CPU "-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard")
set(LABIAL_BOARD_LINK arm/mps2.ld)
include("${CMAKE_CURRENT_LIST_DIR}/arm.cmake")
