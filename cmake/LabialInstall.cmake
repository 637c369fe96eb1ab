# What `cmake --install` puts below the prefix: the libraries, their headers, programs, and what find_package(labial)
# and pkg-config read. The headers of the models lie in a folder of their own, so that they take no names from others.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(labial_models_include "${CMAKE_INSTALL_INCLUDEDIR}/labial/models")
set(labial_cmake "${CMAKE_INSTALL_LIBDIR}/cmake/labial")

# ---- Libraries and headers -----------------------------------------------------------------------------------------

set(labial_installed_models ${LABIAL_BUNDLED_MODELS} ${LABIAL_HEARING_MODELS})
set(labial_tables ${labial_installed_models} ${LABIAL_WORDS})
list(TRANSFORM labial_tables PREPEND labial_ OUTPUT_VARIABLE labial_model_targets)
install(TARGETS labial EXPORT labial-targets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(TARGETS ${labial_model_targets} EXPORT labial-targets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" INCLUDES DESTINATION "${labial_models_include}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/labial" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
  FILES_MATCHING PATTERN "*.h")
foreach(model IN LISTS labial_installed_models)
  install(FILES "${PROJECT_SOURCE_DIR}/lib/models/${model}.h" DESTINATION "${labial_models_include}")
endforeach()
foreach(words IN LISTS LABIAL_WORDS)
  install(FILES "${PROJECT_SOURCE_DIR}/lib/words/${words}.h" DESTINATION "${labial_models_include}")
endforeach()
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/NOTICE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
if(TARGET labial-say)
  install(TARGETS labial-say labial-hear RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
endif()

# ---- find_package(labial) ------------------------------------------------------------------------------------------

install(EXPORT labial-targets NAMESPACE labial:: DESTINATION "${labial_cmake}")
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/labial-config.cmake.in"
  "${PROJECT_BINARY_DIR}/labial-config.cmake"
  INSTALL_DESTINATION "${labial_cmake}" NO_SET_AND_CHECK_MACRO)
# Before 1.0 a new minor version may change the interface.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/labial-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/labial-config.cmake" "${PROJECT_BINARY_DIR}/labial-config-version.cmake"
  DESTINATION "${labial_cmake}")

# ---- pkg-config ----------------------------------------------------------------------------------------------------

# Limits that this build overrides must reach whoever compiles against it.
get_target_property(definitions labial INTERFACE_COMPILE_DEFINITIONS)
set(labial_pc_definitions "")
if(definitions)
  foreach(definition IN LISTS definitions)
    string(APPEND labial_pc_definitions " -D${definition}")
  endforeach()
endif()

# Paths are relative to the file, so that an installed tree can be moved, unless they were given as absolute ones.
set(labial_pc_includedir "\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}")
if(IS_ABSOLUTE "${CMAKE_INSTALL_INCLUDEDIR}")
  set(labial_pc_includedir "${CMAKE_INSTALL_INCLUDEDIR}")
endif()
set(labial_pc_libdir "\${prefix}/${CMAKE_INSTALL_LIBDIR}")
set(labial_pc_folder "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
  set(labial_pc_libdir "${CMAKE_INSTALL_LIBDIR}")
  set(labial_pc_prefix "${CMAKE_INSTALL_PREFIX}")
else()
  file(RELATIVE_PATH labial_pc_prefix "/${labial_pc_folder}" "/")
  string(REGEX REPLACE "/$" "" labial_pc_prefix "\${pcfiledir}/${labial_pc_prefix}")
endif()

function(labial_pkg_config name description requires library cflags)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/${name}.pc" @ONLY CONTENT [[
prefix=@labial_pc_prefix@
includedir=@labial_pc_includedir@
libdir=@labial_pc_libdir@

Name: @name@
Description: @description@
Version: @PROJECT_VERSION@
Requires: @requires@
Cflags: @cflags@
Libs: -L${libdir} -l@library@
]])
  install(FILES "${PROJECT_BINARY_DIR}/${name}.pc" DESTINATION "${labial_pc_folder}")
endfunction()

labial_pkg_config(labial "Lip motion from phonemes, on a fixed amount of memory" "" labial
  "-I\${includedir}${labial_pc_definitions}")
foreach(words IN LISTS LABIAL_WORDS)
  labial_pkg_config(labial_${words} "Labial's table of words ${words}" "labial = ${PROJECT_VERSION}" labial_${words}
    "-I\${includedir}/labial/models")
endforeach()
foreach(model IN LISTS labial_installed_models)
  labial_pkg_config(labial_${model} "Labial's model ${model}" "labial = ${PROJECT_VERSION}" labial_${model}
    "-I\${includedir}/labial/models")
endforeach()
