# Arduino Uno: ATmega328P, 16 MHz, 32 KB of flash, 2 KB of RAM. Labial itself needs an int of 32 bits; here its baked
# motion is played (examples/uno), under simavr.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR avr)
set(LABIAL_BOARD uno)

find_program(LABIAL_BOARD_COMPILER avr-gcc)
mark_as_advanced(LABIAL_BOARD_COMPILER)
if(NOT LABIAL_BOARD_COMPILER)
  message(FATAL_ERROR "The board uno needs avr-gcc: install from Debian gcc-avr avr-libc.")
endif()
set(CMAKE_C_COMPILER "${LABIAL_BOARD_COMPILER}")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_C_FLAGS_INIT "-mmcu=atmega328p")
set(CMAKE_C_FLAGS_RELEASE_INIT "-Os")
set(CMAKE_EXECUTABLE_SUFFIX_C .elf)
