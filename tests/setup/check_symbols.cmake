# Checks the symbols of a static library of Labial:
#
#   cmake -D NM=nm -D LIBRARY=liblabial.a -D NAMES=REGEX -P check_symbols.cmake
#
# - every global symbol matches NAMES, so that a program's own names are safe;
# - .data, .bss and common are empty: the library has no state, its tables stay in flash;
# - nothing is called but memcpy, memmove, memset, memcmp and the compiler's own helpers.
cmake_minimum_required(VERSION 3.22...3.31)

# Functions that compilers call implicitly: division and shifts, stack protection, checked copies, position
# independence.
set(helpers "memcpy|memmove|memset|memcmp|__mem(cpy|move|set)_chk|__aeabi_[a-z0-9_]+|__[a-z]+[sdt]i[23]")
string(APPEND helpers "|__gnu_thumb1_case_[a-z]+|__stack_chk_(fail|guard)|_GLOBAL_OFFSET_TABLE_")

execute_process(COMMAND "${NM}" --format=sysv "${LIBRARY}" OUTPUT_VARIABLE table RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${NM} could not read ${LIBRARY}.")
endif()
string(REPLACE ";" "," table "${table}")
string(REPLACE "\n" ";" rows "${table}")

set(defined "")
set(undefined "")
set(faults "")
foreach(row IN LISTS rows)
  # name | value | class | type | size | line | section
  if(NOT row MATCHES "^([^| ]+) *\\|[^|]*\\| *([A-Za-z?]) *\\|[^|]*\\|[^|]*\\|[^|]*\\|(.*)$")
    continue()
  endif()
  set(name "${CMAKE_MATCH_1}")
  set(class "${CMAKE_MATCH_2}")
  set(section "${CMAKE_MATCH_3}")
  if(class STREQUAL "U")
    list(APPEND undefined "${name}")
    continue()
  endif()
  # .data.rel.ro holds constants with addresses in them, which a position-independent program's loader fills in.
  if(section MATCHES "^\\*COM\\*|^\\.(bss|data|tbss|tdata)" AND NOT section MATCHES "^\\.data\\.rel\\.ro")
    list(APPEND faults "${name} lies in ${section}: it is writable")
  endif()
  if(class MATCHES "[A-Z]")
    list(APPEND defined "${name}")
    if(NOT name MATCHES "^(${NAMES})$")
      list(APPEND faults "${name} is global and does not match ${NAMES}")
    endif()
  endif()
endforeach()
foreach(name IN LISTS undefined)
  if(NOT name IN_LIST defined AND NOT name MATCHES "^(${helpers})$")
    list(APPEND faults "${name} is called and not defined in the library")
  endif()
endforeach()

if(NOT defined)
  list(APPEND faults "no global symbol was found")
endif()
if(faults)
  list(REMOVE_DUPLICATES faults)
  string(REPLACE ";" "\n  " faults "${faults}")
  message(FATAL_ERROR "${LIBRARY}:\n  ${faults}")
endif()
