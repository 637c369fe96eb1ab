# PowerPC Linux, which is big-endian, 32 bits wide and has unsigned char: programs of the host's kind under qemu-ppc.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR powerpc)

find_program(LABIAL_PPC_COMPILER powerpc-linux-gnu-gcc)
find_program(LABIAL_PPC_QEMU qemu-ppc)
mark_as_advanced(LABIAL_PPC_COMPILER LABIAL_PPC_QEMU)
if(NOT LABIAL_PPC_COMPILER OR NOT LABIAL_PPC_QEMU)
  message(FATAL_ERROR "A big-endian processor needs a compiler and an emulator: install from Debian "
                      "gcc-powerpc-linux-gnu libc6-dev-powerpc-cross qemu-user.")
endif()

set(CMAKE_C_COMPILER "${LABIAL_PPC_COMPILER}")
set(CMAKE_EXE_LINKER_FLAGS_INIT -static) # so that the emulator needs no C library of its own
set(CMAKE_CROSSCOMPILING_EMULATOR "${LABIAL_PPC_QEMU}")
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
