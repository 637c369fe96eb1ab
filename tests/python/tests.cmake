# Python: the exporter, and library and exporter together. Included by tests/CMakeLists.txt.

# Debian's Python comes without ensurepip; what takes its place is the wheel of pip that Debian packages for others.
find_package(Python3 3.9 COMPONENTS Interpreter)
set(have_pip FALSE)
set(pip_wheel "")
if(Python3_Interpreter_FOUND)
  execute_process(COMMAND "${Python3_EXECUTABLE}" -c "import ensurepip" RESULT_VARIABLE failed ERROR_QUIET)
  if(failed)
    labial_debian_packages(root "${PROJECT_BINARY_DIR}/debian" python3-pip-whl)
    file(GLOB pip_wheel "${root}/usr/share/python-wheels/pip-*.whl")
  endif()
  if(pip_wheel OR NOT failed)
    set(have_pip TRUE)
  endif()
endif()
if(NOT have_pip)
  labial_left_out("The Python tests are left out, they need Python 3.9 or later with venv and pip: "
                  "install the Debian packages python3 and python3-venv, or connect to the network.")
  labial_disabled_test(pytest)
  labial_disabled_test(ruff)
  return()
endif()

# SPTK's mlpg and lbg are oracles for the trajectory and the codebook.
function(labial_find_sptk)
  find_path(LABIAL_SPTK mlpg HINTS ${ARGN} PATHS /usr/libexec/sptk /usr/lib/sptk /usr/local/SPTK PATH_SUFFIXES bin)
  mark_as_advanced(LABIAL_SPTK)
endfunction()

labial_find_sptk()
if(NOT LABIAL_SPTK)
  labial_debian_packages(root "${PROJECT_BINARY_DIR}/debian" sptk)
  if(root)
    labial_find_sptk("${root}/usr/libexec/sptk" "${root}/usr/lib/sptk")
  endif()
endif()
if(NOT LABIAL_SPTK)
  labial_left_out("The comparisons with SPTK are left out: install the Debian package sptk.")
endif()

find_program(LABIAL_CHROMIUM NAMES chromium chromium-browser google-chrome)
mark_as_advanced(LABIAL_CHROMIUM)
if(NOT LABIAL_CHROMIUM)
  labial_left_out("The tests of pages in a browser are left out: install the Debian package chromium.")
endif()

option(LABIAL_TRACKING "Track a face with MediaPipe in the tests, which fetches 300 MB" "${LABIAL_REQUIRE_ALL}")

# A test and not a part of the build, so that the C suites run where the packages cannot be had. The lock `setup` lets
# them run beside what prepares other tests, one of which mostly waits for the network.
set(environment "${PROJECT_BINARY_DIR}/python")
set(python "${environment}/bin/python")
add_test(NAME python_environment COMMAND "${CMAKE_COMMAND}" -D "PYTHON=${Python3_EXECUTABLE}"
  -D "REQUIREMENTS=${CMAKE_CURRENT_SOURCE_DIR}/requirements.lock" -D "DIRECTORY=${environment}"
  -D "PIP_WHEEL=${pip_wheel}" -P "${LABIAL_TEST_SETUP}/python_environment.cmake")
set_tests_properties(python_environment PROPERTIES FIXTURES_SETUP python RESOURCE_LOCK setup TIMEOUT 1800)

add_test(NAME ruff WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
  COMMAND "${python}" -m ruff check --no-cache bench examples export packaging tests)
set_tests_properties(ruff PROPERTIES LABELS sources FIXTURES_REQUIRED python)

# What may import what, and types: pyproject.toml. Neither tool runs on the oldest Python.
if(Python3_VERSION VERSION_GREATER_EQUAL 3.10)
  add_test(NAME imports WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
    COMMAND "${environment}/bin/lint-imports" --no-cache)
  set(checks imports)
  if(LABIAL_REQUIRE_ALL)
    add_test(NAME types WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
      COMMAND "${python}" -m mypy --cache-dir "${PROJECT_BINARY_DIR}/mypy")
    list(APPEND checks types)
  endif()
  set_tests_properties(${checks} PROPERTIES FIXTURES_REQUIRED python
    ENVIRONMENT "PYTHONPATH=${PROJECT_SOURCE_DIR}/export;PYTHONDONTWRITEBYTECODE=1")
  set_tests_properties(imports PROPERTIES LABELS sources)
endif()

# That the oldest Python has what the package uses.
add_test(NAME oldest_python WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
  COMMAND "${environment}/bin/vermin" --target=3.9- --violations --no-tips export/labial)
set_tests_properties(oldest_python PROPERTIES LABELS sources FIXTURES_REQUIRED python)

set(libraries "")
foreach(model IN LISTS LABIAL_BUNDLED_MODELS LABIAL_HEARING_MODELS LABIAL_WORDS)
  list(APPEND libraries "$<TARGET_FILE:labial_${model}>")
endforeach()
list(JOIN libraries ":" libraries)
set(variables
  "PYTHONPATH=${PROJECT_SOURCE_DIR}/export"
  "PYTHONPYCACHEPREFIX=${PROJECT_BINARY_DIR}/pycache" # nothing compiled beside the sources
  PYTHONDONTWRITEBYTECODE= # some images set it, and then each process compiles all that it imports
  "MPLCONFIGDIR=${PROJECT_BINARY_DIR}/matplotlib"
  OMP_NUM_THREADS=1 # the tests themselves run in parallel
  "LABIAL_SOURCE=${PROJECT_SOURCE_DIR}"
  "LABIAL_CC=${CMAKE_C_COMPILER}"
  "LABIAL_CXX=${LABIAL_CXX}"
  "LABIAL_CMAKE=${CMAKE_COMMAND}"
  "LABIAL_LIBRARIES=${libraries}:$<TARGET_FILE:labial>")
if(LABIAL_REQUIRE_ALL)
  list(APPEND variables LABIAL_REQUIRE_ALL=ON)
endif()
foreach(name IN ITEMS LABIAL_SPTK LABIAL_UNITY_SOURCE)
  if(${name})
    list(APPEND variables "${name}=${${name}}")
  endif()
endforeach()
if(TARGET labial-say)
  list(APPEND variables "LABIAL_SAY=$<TARGET_FILE:labial-say>" "LABIAL_HEAR=$<TARGET_FILE:labial-hear>"
    "LABIAL_DEMO_PAGE=${LABIAL_DEMO_PAGE}"
    "LABIAL_PROGRAMS=$<TARGET_FILE_DIR:labial-say>:$<TARGET_FILE_DIR:labial-demo>:$<TARGET_FILE_DIR:labial-bench>")
endif()
if(TARGET labial-python)
  list(APPEND variables "LABIAL_RUNTIME=$<TARGET_FILE:labial-python>"
    "LABIAL_RUNTIME_PAPER=$<TARGET_FILE:labial-python-paper>")
endif()
if(TARGET labial-rig-jaw)
  list(APPEND variables "LABIAL_RIG_EXAMPLES=$<TARGET_FILE_DIR:labial-rig-jaw>")
endif()
foreach(synthesiser IN ITEMS flite espeak)
  if(TARGET labial-say-${synthesiser})
    string(TOUPPER ${synthesiser} name)
    list(APPEND variables "LABIAL_SAY_${name}=$<TARGET_FILE:labial-say-${synthesiser}>")
  endif()
endforeach()
if(LABIAL_NPM_PACKAGE)
  list(APPEND variables "LABIAL_NPM_PACKAGE=${LABIAL_NPM_PACKAGE}" "LABIAL_BUNDLERS=${PROJECT_BINARY_DIR}/bundlers")
endif()
add_test(NAME pytest WORKING_DIRECTORY "${PROJECT_BINARY_DIR}"
  COMMAND "${python}" -m pytest -p no:cacheprovider -n 2 --dist loadgroup -ra --durations=10
    "--junitxml=${PROJECT_BINARY_DIR}/pytest.xml" --rootdir "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}/python")
set_tests_properties(pytest PROPERTIES LABELS python FIXTURES_REQUIRED "python;npm" PROCESSORS 2 TIMEOUT 1800
  ENVIRONMENT "${variables}")
if(LABIAL_REQUIRE_ALL)
  set_tests_properties(pytest PROPERTIES FAIL_REGULAR_EXPRESSION "[0-9]+ skipped")
else()
  message(STATUS "Python tests marked `slow` are left to .ci/run: -DLABIAL_REQUIRE_ALL=ON runs them, too.")
endif()

# Training a network of hearing needs PyTorch, which is too large to fetch for it.
set(LABIAL_TORCH "" CACHE FILEPATH "Python with PyTorch, soundfile, soxr and pytest, to test the training of hearing")
if(LABIAL_TORCH)
  add_test(NAME hearing_training WORKING_DIRECTORY "${PROJECT_BINARY_DIR}"
    COMMAND "${LABIAL_TORCH}" -m pytest -p no:cacheprovider
      --rootdir "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}/hearing")
  set_tests_properties(hearing_training PROPERTIES TIMEOUT 600 ENVIRONMENT "${variables}")
else()
  message(STATUS "The tests of training a network of hearing are left out: -DLABIAL_TORCH=PYTHON names one with PyTorch.")
endif()

# Pipecat and LiveKit's agents are too large to fetch for their examples.
foreach(framework IN ITEMS pipecat livekit)
  string(TOUPPER ${framework} name)
  set(LABIAL_${name} "" CACHE FILEPATH "Python with ${framework} and pytest, to test its example in examples/voices")
  if(LABIAL_${name})
    add_test(NAME ${framework} WORKING_DIRECTORY "${PROJECT_BINARY_DIR}"
      COMMAND "${LABIAL_${name}}" -m pytest -p no:cacheprovider
        --rootdir "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}/agents/test_${framework}.py")
    set_tests_properties(${framework} PROPERTIES TIMEOUT 120 ENVIRONMENT "${variables}")
  else()
    message(STATUS "The tests of examples/voices with ${framework} are left out: -DLABIAL_${name}=PYTHON names one.")
  endif()
endforeach()

# Face tracking has an environment of its own, see tracking/requirements.txt.
if(NOT LABIAL_TRACKING)
  message(STATUS "The tests of face tracking are left out, they fetch 300 MB: -DLABIAL_TRACKING=ON runs them.")
elseif(Python3_VERSION VERSION_GREATER_EQUAL 3.13)
  labial_left_out("The tests of face tracking are left out, they need Python 3.9 to 3.12.")
  labial_disabled_test(tracking)
else()
  set(environment "${PROJECT_BINARY_DIR}/tracking")
  add_test(NAME tracking_environment COMMAND "${CMAKE_COMMAND}" -D "PYTHON=${Python3_EXECUTABLE}"
    -D "REQUIREMENTS=${CMAKE_CURRENT_SOURCE_DIR}/tracking/requirements.lock" -D "DIRECTORY=${environment}"
    -D "PIP_WHEEL=${pip_wheel}" -P "${LABIAL_TEST_SETUP}/python_environment.cmake")
  set_tests_properties(tracking_environment PROPERTIES FIXTURES_SETUP tracking RESOURCE_LOCK setup TIMEOUT 1800)
  add_test(NAME tracking WORKING_DIRECTORY "${PROJECT_BINARY_DIR}"
    COMMAND "${environment}/bin/python" -m pytest -p no:cacheprovider
      --rootdir "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}/tracking")
  set_tests_properties(tracking PROPERTIES FIXTURES_REQUIRED tracking TIMEOUT 600 ENVIRONMENT "${variables}")
endif()
labial_label(python)
