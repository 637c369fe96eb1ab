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

# Without its requirements the library must not compile, and the compiler must say why: refuses.cmake has the table.
find_program(LABIAL_AVR_GCC avr-gcc)
mark_as_advanced(LABIAL_AVR_GCC)
foreach(rule IN ITEMS limits combinations int_of_16_bits)
  set(compiler "${CMAKE_C_COMPILER}")
  if(rule STREQUAL "int_of_16_bits")
    set(compiler "${LABIAL_AVR_GCC}")
  endif()
  if(NOT compiler)
    labial_left_out("The check that int of 16 bits is refused is left out, it needs avr-gcc: "
                    "install the Debian package gcc-avr.")
    labial_disabled_test(refuses_${rule})
    continue()
  endif()
  add_test(NAME refuses_${rule} COMMAND "${CMAKE_COMMAND}" -D "COMPILER=${compiler}" -D "SOURCE=${PROJECT_SOURCE_DIR}"
    -D "FILES=${library_sources}" -D RULE=${rule} -P "${LABIAL_TEST_SETUP}/refuses.cmake")
endforeach()

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
