# Without its requirements the library must not compile, and the compiler must say why.
#
#   cmake -D COMPILER=cc -D SOURCE=DIR -D "FILES=lib/x.c;..." -D RULE=limits -P refuses.cmake
#
# RULE is `limits`, `combinations` of them, or `int_of_16_bits`, for which COMPILER is avr-gcc and FILES are all of lib.
cmake_minimum_required(VERSION 3.22...3.31)

set(faults "")
set(tried 0)

# Compiles a file; `failed` is then the compiler's result, `said` what it printed.
macro(compile file)
  execute_process(COMMAND "${COMPILER}" -fsyntax-only -std=c99 "-I${SOURCE}/include" "-I${SOURCE}/lib" ${ARGN} -x c "${file}"
    RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
  math(EXPR tried "${tried} + 1")
endmacro()

# refused(<file> <regular expression of the sentence> <option>...)
macro(refused file sentence)
  compile("${file}" ${ARGN})
  if(NOT failed OR NOT said MATCHES "error: [^\n]*${sentence}")
    string(REPLACE ";" " " options "${ARGN}")
    list(APPEND faults "${file} ${options}: does not say: ${sentence}")
  endif()
endmacro()

# refused_limit(<limit> <least> <most> <other option>...): numbers beyond the limits, expressions without parentheses,
# unsigned numbers, fractions and empty definitions.
function(refused_limit limit least most)
  math(EXPR below "${least} - 1")
  math(EXPR above "${most} + 1")
  math(EXPR part "${most} - 1")
  set(negative "-${most}")
  if(negative STREQUAL below)
    set(negative "-${above}")
  endif()
  foreach(value IN ITEMS "${below}" "${above}" "${part}+1" "${negative}" "${most}u" "${most}.5" "")
    set(sentence "${limit} must be a number from ${least} to ${most}")
    if(value MATCHES "[.]" OR value STREQUAL "") # the preprocessor has a sentence of its own
      set(sentence ".*${limit}")
    endif()
    refused("${SOURCE}/lib/stream.c" "${sentence}" "-D${limit}=${value}" ${ARGN})
  endforeach()
  set(faults "${faults}" PARENT_SCOPE)
  set(tried "${tried}" PARENT_SCOPE)
endfunction()

if(RULE STREQUAL "limits")
  refused_limit(LABIAL_WINDOW 1 48)
  refused_limit(LABIAL_LAG 0 40)
  refused_limit(LABIAL_REACH 0 60 -DLABIAL_QUEUE=255)
  refused_limit(LABIAL_QUEUE 2 255 -DLABIAL_REACH=0)
  refused_limit(LABIAL_MODELS 1 255)
  refused_limit(LABIAL_LOCKS 0 2)
  refused_limit(LABIAL_HEAR_SUMS 0 1)
  refused_limit(LABIAL_HEAR_UNITS_MAX 80 252)
  set(wanted 56)
elseif(RULE STREQUAL "combinations")
  set(stream "${SOURCE}/lib/stream.c")
  refused("${stream}" "LABIAL_PAPER must be a number from 0 to 1" -DLABIAL_PAPER=2)
  refused("${stream}" "LABIAL_WINDOW and LABIAL_LAG must not be more than 55 together" -DLABIAL_LAG=40 -DLABIAL_WINDOW=16)
  refused("${stream}" "LABIAL_QUEUE must be LABIAL_REACH . 2 or more" -DLABIAL_REACH=20 -DLABIAL_QUEUE=21)
  refused("${stream}" "LABIAL_HEAR_UNITS_MAX must be a multiple of four" -DLABIAL_HEAR_UNITS_MAX=130)
  set(wanted 4)
elseif(RULE STREQUAL "int_of_16_bits")
  list(LENGTH FILES wanted)
  foreach(file IN LISTS FILES)
    if(file MATCHES "/(beside|clock|result)\\.c$") # for small boards, which play what a server computed
      compile("${file}" -mmcu=atmega328p -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Werror)
      if(failed)
        list(APPEND faults "${said}")
      endif()
    else()
      refused("${file}" "Labial needs an int of 32 bits" -mmcu=atmega2560)
    endif()
  endforeach()
endif()

if(faults OR NOT tried EQUAL wanted OR tried EQUAL 0)
  string(REPLACE ";" "\n  " faults "${faults}")
  message(FATAL_ERROR "${tried} of ${wanted} compilations were tried. Wrong are:\n  ${faults}")
endif()
message("${tried} compilations went as they should")
