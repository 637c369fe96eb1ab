# Debian's packages and their sources below the build directory, for tests on machines where they are not installed.

# Options of apt for lists and a cache of its own below <directory>. apt's own user could not write to them where the
# build directory lies in a private folder, so apt keeps the caller's.
function(labial_private_apt variable directory)
  set(${variable}
      -o "Dir::State::lists=${directory}/lists" -o "Dir::Cache=${directory}/cache" -o APT::Sandbox::User=root
      -o Acquire::Languages=none -o Acquire::Retries=3 -o Acquire::http::Timeout=30 -o Acquire::https::Timeout=30
      PARENT_SCOPE)
endfunction()

# labial_debian_packages(<variable> <directory> <package>...)
#
# Unpacks Debian packages below <directory>: nothing outside it changes, so that it needs no rights. Sets <variable> to
# the folder that stands for `/`, or to the empty string, after a message that says why, where that is not possible. What
# is unpacked already is not fetched again.
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
  labial_private_apt(private_lists "${directory}")
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

# labial_debian_source(<variable> <directory> <package>)
#
# Unpacks the upstream source of a Debian package below <directory>, as labial_debian_packages() does with binary ones.
# Sets <variable> to its folder, or to the empty string after a message that says why. What is unpacked already is not
# fetched again. Machines seldom list source packages, so the archives of their binary packages are asked for those.
function(labial_debian_source variable directory package)
  set(folder "${directory}/${package}")
  set(${variable} "" PARENT_SCOPE)
  if(EXISTS "${folder}.unpacked")
    set(${variable} "${folder}" PARENT_SCOPE)
    return()
  endif()
  find_program(LABIAL_APT_GET apt-get)
  mark_as_advanced(LABIAL_APT_GET)
  if(NOT LABIAL_APT_GET)
    message(STATUS "apt is unavailable, so the source of the Debian package ${package} cannot be fetched.")
    return()
  endif()

  file(REMOVE_RECURSE "${directory}/download" "${folder}")
  file(MAKE_DIRECTORY "${directory}/lists/partial" "${directory}/cache/archives/partial" "${directory}/download")
  labial_private_apt(private_lists "${directory}")
  set(targets indextargets --format "deb-src $(REPO_URI) $(RELEASE) $(COMPONENT)" "Created-By: Packages"
      "Origin: Debian")
  execute_process(COMMAND "${LABIAL_APT_GET}" ${targets} OUTPUT_VARIABLE archives ERROR_QUIET)
  if(archives STREQUAL "") # the machine has no lists, and apt tells of no archive without them
    execute_process(COMMAND "${LABIAL_APT_GET}" -q ${private_lists} update OUTPUT_QUIET ERROR_QUIET)
    execute_process(COMMAND "${LABIAL_APT_GET}" ${private_lists} ${targets} OUTPUT_VARIABLE archives ERROR_QUIET)
  endif()
  string(REGEX REPLACE "\n$" "" archives "${archives}")
  string(REPLACE "\n" ";" archives "${archives}")
  list(REMOVE_DUPLICATES archives)
  list(JOIN archives "\n" archives)
  file(WRITE "${directory}/sources.list" "${archives}\n")
  list(APPEND private_lists -o "Dir::Etc::sourcelist=${directory}/sources.list" -o Dir::Etc::sourceparts=/dev/null)
  message(STATUS "Fetching the source of the Debian package ${package} into the build directory")
  if(NOT EXISTS "${directory}/lists/updated")
    execute_process(COMMAND "${LABIAL_APT_GET}" -q ${private_lists} update
      RESULT_VARIABLE failed OUTPUT_VARIABLE update_output ERROR_VARIABLE update_output)
    if(NOT failed)
      file(TOUCH "${directory}/lists/updated")
    endif()
  endif()
  execute_process(COMMAND "${LABIAL_APT_GET}" -q ${private_lists} source --download-only ${package}
    WORKING_DIRECTORY "${directory}/download"
    RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  file(GLOB archive "${directory}/download/*.orig.tar.*")
  list(FILTER archive EXCLUDE REGEX "\\.asc$")
  if(failed OR NOT archive)
    message(STATUS "apt could not fetch the source of ${package}:\n${update_output}${output}")
    return()
  endif()
  # By a relative name: in the C locale CMake opens no archive whose path has other than ASCII letters, and tells nobody.
  get_filename_component(name "${archive}" NAME)
  file(MAKE_DIRECTORY "${directory}/download/unpacked")
  execute_process(COMMAND "${CMAKE_COMMAND}" -E tar xf "../${name}" WORKING_DIRECTORY "${directory}/download/unpacked"
    RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  file(GLOB unpacked "${directory}/download/unpacked/*")
  list(LENGTH unpacked count)
  if(failed OR NOT count EQUAL 1)
    message(STATUS "${archive} could not be unpacked: ${output}")
    return()
  endif()
  file(RENAME "${unpacked}" "${folder}")
  file(REMOVE_RECURSE "${directory}/download")
  file(TOUCH "${folder}.unpacked")
  set(${variable} "${folder}" PARENT_SCOPE)
endfunction()
