# A file must not compile, and the compiler must say why.
#
#   cmake -D COMPILER=cc -D "OPTIONS=-std=c99;-Iinclude;-DLABIAL_LAG=41" -D FILE=stream.c
#         -D "REASON=LABIAL_LAG must be a number" -P check_refused.cmake
cmake_minimum_required(VERSION 3.22...3.31)

execute_process(COMMAND "${COMPILER}" -fsyntax-only ${OPTIONS} -x c "${FILE}"
  RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT failed)
  message(FATAL_ERROR "${FILE} compiles, although it should not.")
endif()
if(NOT said MATCHES "${REASON}")
  message(FATAL_ERROR "${FILE} does not compile, but not because of \"${REASON}\":\n${said}")
endif()
