# Unity, the test framework of the device tests: where it is, or why it is not there.
#
# In this order: the folder LABIAL_UNITY_DIR; a package that find_package() knows, on the host; the release below, by
# git. Sets LABIAL_UNITY to the library to link, or to the empty string after a sentence that says what is left out:
# nothing else depends on Unity.
include(FetchContent)

set(LABIAL_UNITY_DIR "" CACHE PATH "Folder of ThrowTheSwitch's Unity, which holds src/unity.c; looked for when empty")
set(unity_repository https://github.com/ThrowTheSwitch/Unity.git)
set(unity_commit cbcd08fa7de711053a3deec6339ee89cad5d2697) # v2.6.1
set(LABIAL_UNITY "")

# The library, from the framework's own sources in `directory`, with unity_config.h.
function(labial_add_unity directory)
  add_library(labial_unity STATIC "${directory}/src/unity.c")
  target_include_directories(labial_unity SYSTEM PUBLIC "${directory}/src")
  target_include_directories(labial_unity PUBLIC "${CMAKE_CURRENT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/boards")
  target_compile_definitions(labial_unity PUBLIC UNITY_INCLUDE_CONFIG_H)
  labial_sections(labial_unity)
endfunction()

if(LABIAL_UNITY_DIR)
  if(NOT EXISTS "${LABIAL_UNITY_DIR}/src/unity.c")
    message(FATAL_ERROR "LABIAL_UNITY_DIR is ${LABIAL_UNITY_DIR}, which has no src/unity.c.")
  endif()
  labial_add_unity("${LABIAL_UNITY_DIR}")
  set(LABIAL_UNITY labial_unity)
  return()
endif()

if(NOT LABIAL_BOARD) # what is installed is compiled for the host
  find_package(unity CONFIG QUIET)
  if(TARGET unity::framework)
    set(LABIAL_UNITY unity::framework)
    return()
  endif()
endif()

# FetchContent ends everything when it fails, so whether it can succeed is asked first, and not for long.
set(reachable TRUE)
if(NOT FETCHCONTENT_SOURCE_DIR_LABIAL_UNITY AND NOT FETCHCONTENT_FULLY_DISCONNECTED
   AND NOT EXISTS "${FETCHCONTENT_BASE_DIR}/labial_unity-src/src/unity.c")
  set(reachable FALSE)
  find_package(Git QUIET)
  if(GIT_FOUND)
    execute_process(COMMAND "${CMAKE_COMMAND}" -E env GIT_TERMINAL_PROMPT=0
        "${GIT_EXECUTABLE}" ls-remote "${unity_repository}" HEAD
      TIMEOUT 10 RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(NOT failed)
      set(reachable TRUE)
    endif()
  endif()
endif()
if(NOT reachable)
  message(STATUS "The device tests are left out, ${unity_repository} cannot be reached: "
                 "fetch it by other means and name its folder by -DLABIAL_UNITY_DIR=.")
  return()
endif()
# A folder without a CMakeLists.txt: Unity's own would set options and warnings that are not those of the board.
FetchContent_Declare(labial_unity GIT_REPOSITORY ${unity_repository} GIT_TAG ${unity_commit} SOURCE_SUBDIR src)
FetchContent_MakeAvailable(labial_unity)
labial_add_unity("${labial_unity_SOURCE_DIR}")
set(LABIAL_UNITY labial_unity)
