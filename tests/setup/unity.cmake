# ThrowTheSwitch's Unity, the test framework of the device tests, as the target labial_unity.
#
# In this order: the folder LABIAL_UNITY_DIR; an installed package, on the host; a release, fetched by its commit; the
# version that Debian's source package cjson contains. Where none can be had, the device tests are left out and
# LABIAL_UNITY_MISSING is set.
include(FetchContent)
include("${PROJECT_SOURCE_DIR}/cmake/DebianPackages.cmake")

set(LABIAL_UNITY_DIR "$ENV{LABIAL_UNITY_DIR}" CACHE PATH
    "Folder of Unity, which holds src/unity.c; looked for when empty")
set(commit cbcd08fa7de711053a3deec6339ee89cad5d2697) # v2.6.1
set(repository https://github.com/ThrowTheSwitch/Unity.git)
set(fetched "${PROJECT_BINARY_DIR}/_deps/labial_unity-src")
set(LABIAL_UNITY_MISSING FALSE)
if(TARGET labial_unity)
  return()
endif()
unset(LABIAL_UNITY_SOURCE CACHE) # of another Unity, that was found before

# The framework's own source in `directory`, for images without a C library: text goes to the board.
function(labial_add_unity directory)
  add_library(labial_unity STATIC "${directory}/src/unity.c")
  target_include_directories(labial_unity SYSTEM PUBLIC "${directory}/src")
  target_include_directories(labial_unity PUBLIC "${PROJECT_SOURCE_DIR}/tests/device" "${PROJECT_SOURCE_DIR}/boards")
  # Included before all else, since not every copy asks for it by UNITY_INCLUDE_CONFIG_H.
  target_compile_options(labial_unity PUBLIC "SHELL:-include \"${PROJECT_SOURCE_DIR}/tests/device/unity_on_board.h\"")
  target_compile_options(labial_unity PRIVATE -w)
  labial_sections(labial_unity)
  set(LABIAL_UNITY_SOURCE "${directory}" CACHE INTERNAL "Folder of the Unity that is compiled")
  message(STATUS "The device tests run on Unity from ${directory}.")
endfunction()

if(LABIAL_UNITY_DIR)
  if(NOT EXISTS "${LABIAL_UNITY_DIR}/src/unity.c")
    message(FATAL_ERROR "LABIAL_UNITY_DIR is ${LABIAL_UNITY_DIR}, which has no src/unity.c.")
  endif()
  labial_add_unity("${LABIAL_UNITY_DIR}")
  return()
endif()

if(NOT LABIAL_BOARD) # what is installed is compiled for the host
  find_package(unity CONFIG QUIET)
  if(TARGET unity::framework)
    add_library(labial_unity INTERFACE)
    target_link_libraries(labial_unity INTERFACE unity::framework)
    message(STATUS "The device tests run on Unity from ${unity_DIR}.")
    return()
  endif()
endif()

# FetchContent ends the configuration when it fails, so ask first whether the repository answers.
set(answers FALSE)
if(EXISTS "${FETCHCONTENT_SOURCE_DIR_LABIAL_UNITY}/src/unity.c" OR EXISTS "${fetched}/src/unity.c")
  set(answers TRUE)
elseif(NOT FETCHCONTENT_FULLY_DISCONNECTED)
  find_package(Git QUIET)
  if(GIT_FOUND)
    execute_process(COMMAND "${CMAKE_COMMAND}" -E env GIT_TERMINAL_PROMPT=0 "${GIT_EXECUTABLE}" ls-remote "${repository}"
        HEAD TIMEOUT 10 RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(failed EQUAL 0)
      set(answers TRUE)
    endif()
  endif()
endif()
if(answers)
  # The source folder has no CMakeLists.txt, since Unity's own would bring options that are not those of a board.
  FetchContent_Declare(labial_unity GIT_REPOSITORY "${repository}" GIT_TAG ${commit} SOURCE_SUBDIR src)
  FetchContent_MakeAvailable(labial_unity)
  labial_add_unity("${labial_unity_SOURCE_DIR}")
  return()
endif()

labial_debian_source(source "${PROJECT_BINARY_DIR}/debian/source" cjson)
if(EXISTS "${source}/tests/unity/src/unity.c")
  labial_add_unity("${source}/tests/unity")
  return()
endif()
set(LABIAL_UNITY_MISSING TRUE)
