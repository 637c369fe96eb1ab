# Arm MPS2 with AN500: Cortex-M7 with double-precision floating point.
set(LABIAL_BOARD m7)
set(LABIAL_BOARD_MACHINE mps2-an500)
set(LABIAL_BOARD_CPU "-mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard")
set(LABIAL_BOARD_LINK arm/mps2.ld)
include("${CMAKE_CURRENT_LIST_DIR}/arm.cmake")
