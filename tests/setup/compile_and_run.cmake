# Compiles FILES to PROGRAM and runs it.
#
#   cmake -D COMPILER=cc -D "OPTIONS=-O0;-Iinclude" -D "FILES=a.c;b.c" -D PROGRAM=name -P compile_and_run.cmake
cmake_minimum_required(VERSION 3.22...3.31)

execute_process(COMMAND "${COMPILER}" ${OPTIONS} ${FILES} -o "${PROGRAM}" RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${COMPILER} could not compile ${PROGRAM}.")
endif()
execute_process(COMMAND "${PROGRAM}" RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${PROGRAM} failed: ${failed}")
endif()
