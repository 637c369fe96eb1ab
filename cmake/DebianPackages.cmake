# labial_debian_packages(<variable> <directory> <package>...)
#
# Unpacks Debian packages below <directory>, for tests on machines where they are not installed: nothing outside
# <directory> changes, so that it needs no rights. Sets <variable> to the folder that stands for `/`, or to the empty
# string, after a message that says why, where that is not possible. What is unpacked already is not fetched again.
function(labial_debian_packages variable directory)
  set(root "${directory}/root")
  set(${variable} "" PARENT_SCOPE)

  set(missing "")
  foreach(package IN LISTS ARGN)
    if(NOT EXISTS "${root}/.unpacked/${package}")
      list(APPEND missing ${package})
    endif()
  endforeach()
  if(NOT missing)
    set(${variable} "${root}" PARENT_SCOPE)
    return()
  endif()

  string(REPLACE ";" " " names "${missing}")
  find_program(LABIAL_APT_GET apt-get)
  find_program(LABIAL_DPKG_DEB dpkg-deb)
  mark_as_advanced(LABIAL_APT_GET LABIAL_DPKG_DEB)
  if(NOT LABIAL_APT_GET OR NOT LABIAL_DPKG_DEB)
    message(STATUS "Not installed, and apt is unavailable; install the Debian packages: ${names}")
    return()
  endif()

  # The lists of packages that the machine has may be missing, too old or not readable; then a private copy is made.
  # apt's own user could not write to it where the build directory lies in a private folder, so apt keeps the caller's.
  set(private_lists
      -o "Dir::State::lists=${directory}/lists" -o "Dir::Cache=${directory}/cache" -o APT::Sandbox::User=root
      -o Acquire::Languages=none -o Acquire::Retries=3 -o Acquire::http::Timeout=30 -o Acquire::https::Timeout=30)
  file(MAKE_DIRECTORY "${directory}/lists/partial" "${directory}/cache/archives/partial" "${root}/.unpacked")
  message(STATUS "Fetching Debian packages into the build directory: ${names}")
  set(download "${LABIAL_APT_GET}" -q download ${missing})
  execute_process(COMMAND ${download} WORKING_DIRECTORY "${directory}"
    RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed)
    execute_process(COMMAND "${LABIAL_APT_GET}" -q ${private_lists} update WORKING_DIRECTORY "${directory}"
      OUTPUT_VARIABLE update_output ERROR_VARIABLE update_output)
    execute_process(COMMAND ${download} ${private_lists} WORKING_DIRECTORY "${directory}"
      RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
    file(REMOVE_RECURSE "${directory}/lists" "${directory}/cache")
  endif()
  if(failed)
    message(STATUS "apt could not fetch ${names}:\n${update_output}${output}")
    return()
  endif()

  foreach(package IN LISTS missing)
    file(GLOB archive "${directory}/${package}_*.deb")
    execute_process(COMMAND "${LABIAL_DPKG_DEB}" -x "${archive}" "${root}"
      RESULT_VARIABLE failed ERROR_VARIABLE output)
    if(failed)
      message(STATUS "${archive} could not be unpacked: ${output}")
      return()
    endif()
    file(TOUCH "${root}/.unpacked/${package}")
    file(REMOVE "${archive}")
  endforeach()
  set(${variable} "${root}" PARENT_SCOPE)
endfunction()
