# Runs PROGRAM and compares what it prints, kept in FOUND, with the file WANTED.
#
#   cmake -D PROGRAM=program -D WANTED=expected.txt -D FOUND=found.txt -P check_output.cmake
cmake_minimum_required(VERSION 3.22...3.31)

execute_process(COMMAND "${PROGRAM}" OUTPUT_FILE "${FOUND}" RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${PROGRAM} failed: ${failed}")
endif()
execute_process(COMMAND "${CMAKE_COMMAND}" -E compare_files --ignore-eol "${WANTED}" "${FOUND}" RESULT_VARIABLE differs)
if(differs)
  message(FATAL_ERROR "${PROGRAM} prints other than ${WANTED}; what it prints is in ${FOUND}.")
endif()
