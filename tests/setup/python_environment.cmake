# Makes a Python environment with the packages that requirements.lock names, whose hashes pip checks; does nothing when it
# is there already.
#
#   cmake -D PYTHON=/path/of/python3 -D REQUIREMENTS=requirements.lock -D DIRECTORY=where [-D PIP_WHEEL=pip.whl]
#         -P python_environment.cmake
#
# The interpreter is then DIRECTORY/bin/python. pip comes from Python's ensurepip or runs from the wheel that is given.
cmake_minimum_required(VERSION 3.22...3.31)

function(run description)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${description} failed.")
  endif()
endfunction()

execute_process(COMMAND "${PYTHON}" -VV OUTPUT_VARIABLE version)
file(READ "${REQUIREMENTS}" requirements)
string(SHA256 key "${PYTHON} ${version} ${requirements}")
set(stamp "${DIRECTORY}/stamp")
if(EXISTS "${stamp}")
  file(READ "${stamp}" found)
  if(found STREQUAL key)
    message(STATUS "The Python environment is up to date.")
    return()
  endif()
endif()

file(REMOVE_RECURSE "${DIRECTORY}")
run("Making a Python environment" "${PYTHON}" -m venv --without-pip "${DIRECTORY}")
set(python "${DIRECTORY}/bin/python")
if(PIP_WHEEL)
  set(pip "${python}" "${PIP_WHEEL}/pip")
else()
  run("Installing pip" "${python}" -m ensurepip)
  set(pip "${python}" -m pip)
endif()
# Python compiles what it imports, which is a small part.
execute_process(COMMAND ${pip} install --quiet --disable-pip-version-check --no-input --no-compile --prefer-binary
  --no-deps --require-hashes -r "${REQUIREMENTS}" RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(failed)
  file(WRITE "${DIRECTORY}/pip.log" "${output}")
  get_filename_component(folder "${REQUIREMENTS}" DIRECTORY)
  get_filename_component(folder "${folder}" NAME)
  message(FATAL_ERROR "The Python tests are left out, they need the packages of ${folder}/requirements.lock, which pip "
    "could not install: see ${DIRECTORY}/pip.log. Is there a network?")
endif()
file(WRITE "${stamp}" "${key}")
