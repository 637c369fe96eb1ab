# cmocka, the test framework of the C suites, as the target labial_cmocka: the installed one, that of Debian's package
# or, for the memory sanitizer and for processors that Debian's package does not fit, compiled from its source.
#
# Sets LABIAL_CMOCKA_INCLUDE and LABIAL_CMOCKA_LIBRARY where cmocka was not compiled here. Where it cannot be had, the
# suites of the release build are left out and LABIAL_CMOCKA_MISSING is set; other builds consist of them, and fail.
include("${PROJECT_SOURCE_DIR}/cmake/DebianPackages.cmake")

function(labial_find_cmocka)
  find_path(LABIAL_CMOCKA_INCLUDE cmocka.h HINTS ${ARGN} PATH_SUFFIXES include)
  find_library(LABIAL_CMOCKA_LIBRARY cmocka HINTS ${ARGN} PATH_SUFFIXES lib "lib/${CMAKE_LIBRARY_ARCHITECTURE}")
  mark_as_advanced(LABIAL_CMOCKA_INCLUDE LABIAL_CMOCKA_LIBRARY)
endfunction()

# The memory sanitizer takes what a library writes that it did not compile for memory that was never written.
if(NOT CMAKE_CROSSCOMPILING AND NOT LABIAL_INSTRUMENT STREQUAL "memcheck")
  labial_find_cmocka()
  if(NOT LABIAL_CMOCKA_INCLUDE OR NOT LABIAL_CMOCKA_LIBRARY)
    labial_debian_packages(root "${PROJECT_BINARY_DIR}/debian" libcmocka-dev libcmocka0)
    if(root)
      labial_find_cmocka("${root}/usr")
    endif()
  endif()
  if(LABIAL_CMOCKA_INCLUDE AND LABIAL_CMOCKA_LIBRARY)
    add_library(labial_cmocka UNKNOWN IMPORTED)
    set_target_properties(labial_cmocka PROPERTIES
      IMPORTED_LOCATION "${LABIAL_CMOCKA_LIBRARY}"
      INTERFACE_INCLUDE_DIRECTORIES "${LABIAL_CMOCKA_INCLUDE}")
    return()
  endif()
endif()

set(LABIAL_CMOCKA_DIR "" CACHE PATH "Folder of cmocka's source, which holds src/cmocka.c; fetched when empty")
set(source "${LABIAL_CMOCKA_DIR}")
if(NOT source)
  labial_debian_source(source "${PROJECT_BINARY_DIR}/debian/source" cmocka)
endif()
set(LABIAL_CMOCKA_MISSING FALSE)
if(NOT EXISTS "${source}/src/cmocka.c")
  set(reason "The C suites need cmocka: install the Debian package libcmocka-dev, or let LABIAL_CMOCKA_DIR name ")
  string(APPEND reason "the folder of its source.")
  if(CMAKE_CROSSCOMPILING OR NOT LABIAL_INSTRUMENT STREQUAL "none")
    message(FATAL_ERROR "${reason}")
  endif()
  labial_left_out("${reason}")
  set(LABIAL_CMOCKA_MISSING TRUE)
  return()
endif()
# Its own build would look for all of this by compiling; the targets that come here have POSIX.
add_library(labial_cmocka STATIC "${source}/src/cmocka.c")
target_compile_definitions(labial_cmocka PRIVATE
  _GNU_SOURCE HAVE_INTTYPES_H HAVE_MALLOC_H HAVE_SIGNAL_H HAVE_STRINGS_H HAVE_SIGLONGJMP HAVE_STRSIGNAL
  HAVE_STRUCT_TIMESPEC HAVE_CLOCK_REALTIME HAVE_GCC_THREAD_LOCAL_STORAGE)
target_include_directories(labial_cmocka SYSTEM PUBLIC "${source}/include")
target_compile_options(labial_cmocka PRIVATE -w)
message(STATUS "The C suites run on cmocka from ${source}.")
