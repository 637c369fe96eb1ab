# Labial as a component of ESP-IDF: the library and all bundled models, of which the linker keeps what is used.
file(GLOB labial_sources "${CMAKE_CURRENT_LIST_DIR}/../lib/*.c" "${CMAKE_CURRENT_LIST_DIR}/../lib/models/*.c"
  "${CMAKE_CURRENT_LIST_DIR}/../lib/words/*.c")
idf_component_register(SRCS ${labial_sources} INCLUDE_DIRS include lib/models lib/words)
