# Boards under QEMU: LABIAL_BOARD names one of these rows. In its columns: QEMU's name of the board, the compiler's
# options, the linker script; and for figures (bench/measure/boards.py) the core, the clock in MHz of a usual chip that
# has it, and that chip.
set(rows
  "m0|microbit|-mcpu=cortex-m0 -mthumb|arm/microbit.ld|Cortex-M0|16|nRF51822 of the micro:bit"
  "m3|mps2-an385|-mcpu=cortex-m3 -mthumb|arm/mps2.ld|Cortex-M3|72|STM32F103"
  "m4|mps2-an386|-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard|arm/mps2.ld|Cortex-M4F|64|nRF52840"
  "m7|mps2-an500|-mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard|arm/mps2.ld|Cortex-M7|216|STM32F746"
  "rv32|sifive_e|-march=rv32imac -mabi=ilp32|riscv/sifive_e.ld|RV32IMAC|108|GD32VF103")
set(names "")
foreach(row IN LISTS rows)
  string(REPLACE "|" ";" row "${row}")
  list(GET row 0 name)
  list(APPEND names ${name})
  if(name STREQUAL "${LABIAL_BOARD}")
    list(GET row 1 LABIAL_BOARD_MACHINE)
    list(GET row 2 LABIAL_BOARD_CPU)
    list(GET row 3 LABIAL_BOARD_LINK)
  endif()
endforeach()
if(NOT LABIAL_BOARD_MACHINE)
  list(JOIN names ", " names)
  message(FATAL_ERROR "LABIAL_BOARD must be one of ${names}, but is \"${LABIAL_BOARD}\".")
endif()
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES LABIAL_BOARD)

set(CMAKE_SYSTEM_NAME Generic)
if(LABIAL_BOARD_LINK MATCHES "^arm/")
  set(CMAKE_SYSTEM_PROCESSOR arm)
  set(compiler arm-none-eabi-gcc)
  set(emulator qemu-system-arm)
  set(packages gcc-arm-none-eabi qemu-system-arm)
  # One instruction takes 2^6 ns of the board's time: the system timer then counts instructions (board_count()).
  set(icount shift=6)
else()
  set(CMAKE_SYSTEM_PROCESSOR riscv32)
  set(compiler riscv64-unknown-elf-gcc)
  set(emulator qemu-system-riscv32)
  set(packages gcc-riscv64-unknown-elf qemu-system-misc)
  set(icount shift=0)
endif()

find_program(LABIAL_BOARD_COMPILER "${compiler}")
find_program(LABIAL_BOARD_QEMU "${emulator}")
mark_as_advanced(LABIAL_BOARD_COMPILER LABIAL_BOARD_QEMU)
set(missing "")
if(NOT LABIAL_BOARD_COMPILER)
  list(APPEND missing "${compiler}")
endif()
if(NOT LABIAL_BOARD_QEMU)
  list(APPEND missing "${emulator}")
endif()
if(missing)
  list(JOIN missing " and " missing)
  list(JOIN packages " " packages)
  message(FATAL_ERROR "The board ${LABIAL_BOARD} needs ${missing}: install from Debian ${packages}.")
endif()

set(CMAKE_C_COMPILER "${LABIAL_BOARD_COMPILER}")
# Without a C library nothing links until the board's start-up code is there, so checks of the compiler do not link.
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
get_filename_component(include "${CMAKE_CURRENT_LIST_DIR}/../include" ABSOLUTE)
set(CMAKE_C_FLAGS_INIT "${LABIAL_BOARD_CPU} -ffreestanding -isystem ${include}")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-nostdlib")
set(CMAKE_C_STANDARD_LIBRARIES_INIT "-lgcc") # the compiler's own: division, 64-bit products
set(CMAKE_EXECUTABLE_SUFFIX_C .elf)
# Text goes to the standard output, main's result becomes the exit status, and instructions are counted exactly, so
# that a run can be repeated to the instruction.
set(CMAKE_CROSSCOMPILING_EMULATOR
    "${LABIAL_BOARD_QEMU}" -M "${LABIAL_BOARD_MACHINE}" -display none -monitor none -serial none
    -chardev stdio,id=text -semihosting-config enable=on,target=native,chardev=text
    -icount "${icount},align=off,sleep=off" -kernel)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
foreach(name IN ITEMS rows row names compiler emulator packages icount missing include)
  unset(${name})
endforeach()
unset(name)
