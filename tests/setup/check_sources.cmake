# Compiles each file by itself, without keeping the result; a header as the first thing that a source file includes.
#
#   cmake -D COMPILER=c++ -D LANGUAGE=c++ -D "OPTIONS=-std=c++11;-Iinclude" -D "FILES=a.h;b.c" -P check_sources.cmake
cmake_minimum_required(VERSION 3.22...3.31)

if(NOT FILES)
  message(FATAL_ERROR "There is no file to check.")
endif()
set(faults "")
foreach(file IN LISTS FILES)
  if(file MATCHES "\\.h$")
    set(input -include "${file}" -x ${LANGUAGE} /dev/null)
  else()
    set(input -x ${LANGUAGE} "${file}")
  endif()
  execute_process(COMMAND "${COMPILER}" -fsyntax-only -Werror ${OPTIONS} ${input} RESULT_VARIABLE failed)
  if(failed)
    list(APPEND faults "${file}")
  endif()
endforeach()
if(faults)
  string(REPLACE ";" "\n  " faults "${faults}")
  message(FATAL_ERROR "These do not compile by themselves:\n  ${faults}")
endif()
