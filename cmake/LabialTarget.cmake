# labial_target(<target>) sets how every target of Labial is compiled. Options stay on the targets, so that a program
# that includes Labial keeps its own.

set(LABIAL_WARNINGS
    -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wundef -Wcast-qual -Wdouble-promotion)
set(LABIAL_C_WARNINGS -Wstrict-prototypes -Wmissing-prototypes)

# Undefined behaviour aborts the test instead of only being reported.
set(LABIAL_SANITIZERS -fsanitize=address,undefined,alignment -fno-sanitize-recover=all -fno-omit-frame-pointer)

if(LABIAL_INSTRUMENT STREQUAL "sanitize")
  set(LABIAL_INSTRUMENT_OPTIONS ${LABIAL_SANITIZERS} -DLABIAL_CHECKED) # lib/fixed.h
elseif(LABIAL_INSTRUMENT STREQUAL "fuzz")
  set(LABIAL_INSTRUMENT_OPTIONS -fsanitize=fuzzer-no-link ${LABIAL_SANITIZERS} -DLABIAL_CHECKED)
elseif(LABIAL_INSTRUMENT STREQUAL "memcheck")
  set(LABIAL_INSTRUMENT_OPTIONS -fsanitize=memory -fno-omit-frame-pointer)
elseif(LABIAL_INSTRUMENT STREQUAL "coverage")
  set(LABIAL_INSTRUMENT_OPTIONS --coverage)
elseif(LABIAL_INSTRUMENT MATCHES "^(none|prove|mutate)$")
  set(LABIAL_INSTRUMENT_OPTIONS "")
else()
  message(FATAL_ERROR "LABIAL_INSTRUMENT is none, sanitize, memcheck, fuzz, prove, coverage or mutate, "
                      "not \"${LABIAL_INSTRUMENT}\".")
endif()

function(labial_target target)
  set_target_properties(${target} PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
  if(CMAKE_C_COMPILER_ID MATCHES "GNU|Clang")
    target_compile_options(${target} PRIVATE
      ${LABIAL_WARNINGS} ${LABIAL_C_WARNINGS} $<$<BOOL:${LABIAL_WERROR}>:-Werror>)
  endif()
  target_compile_options(${target} PRIVATE ${LABIAL_INSTRUMENT_OPTIONS})
  target_link_options(${target} PRIVATE ${LABIAL_INSTRUMENT_OPTIONS})
endfunction()

# One section per function and table, so that the linker drops what a program does not use.
function(labial_sections target)
  if(CMAKE_C_COMPILER_ID MATCHES "GNU|Clang")
    target_compile_options(${target} PRIVATE -ffunction-sections -fdata-sections)
  endif()
endfunction()

# labial_stream_library(<name> <definition>...): what a stream needs, for limits or a lock of its own, on which it and its
# programs agree.
function(labial_stream_library name)
  get_target_property(sources labial LABIAL_STREAM_SOURCES)
  add_library(${name} STATIC EXCLUDE_FROM_ALL ${sources})
  target_compile_definitions(${name} PUBLIC ${ARGN})
  target_include_directories(${name} PUBLIC "${PROJECT_SOURCE_DIR}/include" "${PROJECT_SOURCE_DIR}/lib/models")
  labial_target(${name})
  labial_sections(${name})
endfunction()
