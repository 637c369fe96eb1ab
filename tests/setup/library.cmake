# Tests of the library's sources: symbols, code that must not compile, headers and C++11. Included by
# tests/CMakeLists.txt.

if(CMAKE_EXECUTABLE_FORMAT STREQUAL "ELF" AND CMAKE_NM)
  foreach(library IN ITEMS labial ${LABIAL_BUNDLED_MODELS} ${LABIAL_HEARING_MODELS} ${LABIAL_WORDS})
    if(library STREQUAL "labial")
      set(target labial)
      set(names "labial_[a-z0-9_]+")
    else()
      set(target labial_${library})
      set(names "${library}(_names|_classes)?")
    endif()
    add_test(NAME symbols_${library} COMMAND "${CMAKE_COMMAND}" -D "NM=${CMAKE_NM}"
      -D "LIBRARY=$<TARGET_FILE:${target}>" -D "NAMES=${names}" -P "${LABIAL_TEST_SETUP}/check_symbols.cmake")
  endforeach()
else()
  labial_left_out("The check of the library's symbols is left out, it needs nm and the ELF format.")
  labial_disabled_test(symbols)
endif()

# Without its requirements the library must not compile, and the compiler must say why.
function(labial_refused name compiler file sentence)
  add_test(NAME refuses_${name} COMMAND "${compiler}" -fsyntax-only -std=c99 "-I${PROJECT_SOURCE_DIR}/include"
    "-I${PROJECT_SOURCE_DIR}/lib" ${ARGN} -x c "${PROJECT_SOURCE_DIR}/lib/${file}")
  set_tests_properties(refuses_${name} PROPERTIES PASS_REGULAR_EXPRESSION "error: .*${sentence}")
endfunction()

# labial_refused_limit(<limit> <least> <most> <other options>...): refuses numbers beyond the limits, expressions
# without parentheses, unsigned numbers, and empty definitions.
function(labial_refused_limit limit least most)
  math(EXPR below "${least} - 1")
  math(EXPR above "${most} + 1")
  math(EXPR part "${most} - 1")
  set(negative "-${most}")
  if(negative STREQUAL below)
    set(negative "-${above}")
  endif()
  foreach(value IN ITEMS "${below}" "${above}" "${part}+1" "${negative}" "${most}u" "${most}.5" "")
    string(MAKE_C_IDENTIFIER "${limit}_${value}" name)
    string(TOLOWER "${name}" name)
    set(sentence "${limit} must be a number from ${least} to ${most}")
    if(value MATCHES "[.]" OR value STREQUAL "") # the preprocessor has a sentence of its own
      set(sentence "${limit}")
    endif()
    labial_refused(${name} "${CMAKE_C_COMPILER}" stream.c "${sentence}" "-D${limit}=${value}" ${ARGN})
  endforeach()
endfunction()

labial_refused_limit(LABIAL_WINDOW 1 48)
labial_refused_limit(LABIAL_LAG 0 40)
labial_refused_limit(LABIAL_REACH 0 60 -DLABIAL_QUEUE=255)
labial_refused_limit(LABIAL_QUEUE 2 255 -DLABIAL_REACH=0)
labial_refused_limit(LABIAL_MODELS 1 255)
labial_refused_limit(LABIAL_LOCKS 0 2)
labial_refused_limit(LABIAL_HEAR_SUMS 0 1)
labial_refused(labial_paper_2 "${CMAKE_C_COMPILER}" stream.c "LABIAL_PAPER must be a number from 0 to 1" -DLABIAL_PAPER=2)
labial_refused(window_and_lag "${CMAKE_C_COMPILER}" stream.c
  "LABIAL_WINDOW and LABIAL_LAG must not be more than 55 together"
  -DLABIAL_LAG=40 -DLABIAL_WINDOW=16)
labial_refused(short_queue "${CMAKE_C_COMPILER}" stream.c "LABIAL_QUEUE must be LABIAL_REACH . 2 or more"
  -DLABIAL_REACH=20 -DLABIAL_QUEUE=21)

find_program(LABIAL_AVR_GCC avr-gcc)
mark_as_advanced(LABIAL_AVR_GCC)
if(LABIAL_AVR_GCC)
  foreach(source IN LISTS library_sources)
    get_filename_component(name "${source}" NAME)
    if(name MATCHES "^(beside|clock|result)\\.c$") # for small boards, which play what a server computed
      add_test(NAME compiles_with_int_of_16_bits_${name} COMMAND "${LABIAL_AVR_GCC}" -std=c99 -mmcu=atmega328p
        "-I${PROJECT_SOURCE_DIR}/include" -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Werror -fsyntax-only "${source}")
      continue()
    endif()
    labial_refused(int_of_16_bits_${name} "${LABIAL_AVR_GCC}" ${name} "Labial needs an int of 32 bits" -mmcu=atmega2560)
  endforeach()
else()
  labial_left_out("The check that int of 16 bits is refused is left out, it needs avr-gcc: "
                  "install the Debian package gcc-avr.")
  labial_disabled_test(refuses_int_of_16_bits)
endif()

file(GLOB public_headers CONFIGURE_DEPENDS
  "${PROJECT_SOURCE_DIR}/include/labial/*.h" "${PROJECT_SOURCE_DIR}/lib/models/*.h"
  "${PROJECT_SOURCE_DIR}/lib/words/*.h")
file(GLOB private_headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/lib/*.h")
set(include_paths "-I${PROJECT_SOURCE_DIR}/include" "-I${PROJECT_SOURCE_DIR}/lib")

# Each file by itself, without keeping the result.
function(labial_source_check name compiler language options)
  add_test(NAME ${name} COMMAND "${compiler}" -fsyntax-only -Werror ${options} ${LABIAL_WARNINGS} ${include_paths}
    -x ${language} ${ARGN})
endfunction()

labial_source_check(headers_c99 "${CMAKE_C_COMPILER}" c -std=c99 ${public_headers} ${private_headers})
if(LABIAL_CXX)
  labial_source_check(headers_cxx11 "${LABIAL_CXX}" c++ -std=c++11 ${public_headers})
  labial_source_check(library_cxx11 "${LABIAL_CXX}" c++ -std=c++11 ${library_sources})
else()
  labial_left_out("The check that Labial compiles as C++11 is left out, it needs a C++ compiler: "
                  "install the Debian package g++.")
  labial_disabled_test(headers_cxx11)
  labial_disabled_test(library_cxx11)
endif()

# Checks the layout of the C by .clang-format; other versions of clang-format differ in some lines. Generated files are
# excluded.
find_program(LABIAL_CLANG_FORMAT NAMES clang-format-14 clang-format)
mark_as_advanced(LABIAL_CLANG_FORMAT)
set(format_version "")
if(LABIAL_CLANG_FORMAT)
  execute_process(COMMAND "${LABIAL_CLANG_FORMAT}" --version OUTPUT_VARIABLE format_version)
endif()
if(format_version MATCHES "version 14\\.")
  set(laid_out "")
  foreach(folder IN ITEMS bench boards examples flat include lib tests tools)
    file(GLOB_RECURSE files CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${folder}/*.[ch]")
    list(APPEND laid_out ${files})
  endforeach()
  list(FILTER laid_out EXCLUDE REGEX
    "/lib/(models|words)/|/examples/(faces|talk)/|/microbit/face\\.|_table\\.h|/(vectors\\.c|laughs\\.h|hears\\.h|hear_fixture\\.[ch]|words_cases\\.h)")
  add_test(NAME layout_of_c COMMAND "${LABIAL_CLANG_FORMAT}" --dry-run --Werror ${laid_out})
else()
  labial_left_out("The check of the layout of C is left out, it needs clang-format 14: "
                  "install the Debian package clang-format-14.")
  labial_disabled_test(layout_of_c)
endif()
