# labial_bundled_models(<variable>): the names of the models in lib/models, those of speech first, since the first one is
# what programs take where none is named.
function(labial_bundled_models variable)
  set(folder "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../lib/models")
  file(GLOB models RELATIVE "${folder}" CONFIGURE_DEPENDS "${folder}/*_names.c")
  list(TRANSFORM models REPLACE "_names\\.c$" "")
  set(speech ${models})
  list(FILTER speech INCLUDE REGEX "^speech_")
  list(FILTER models EXCLUDE REGEX "^speech_")
  set(${variable} ${speech} ${models} PARENT_SCOPE)
endfunction()

# labial_hearing_models(<variable>): the names of the models of hearing in lib/models, which begin with hear_.
function(labial_hearing_models variable)
  set(folder "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../lib/models")
  file(GLOB models RELATIVE "${folder}" CONFIGURE_DEPENDS "${folder}/hear_*.h")
  list(TRANSFORM models REPLACE "\\.h$" "")
  set(${variable} ${models} PARENT_SCOPE)
endfunction()

# labial_models_header(<file> [<model> ...]): writes a header with LABIAL_BUNDLED, the rows of all models as { name, model,
# names }. A program that is given models links the tables of those alone; of the others there are only the names.
function(labial_models_header file)
  labial_bundled_models(models)
  set(text "/* The bundled models; written by cmake/BundledModels.cmake. */\n")
  set(rows "")
  foreach(model IN LISTS models)
    string(APPEND text "#include \"${model}.h\"\n")
    set(tables "&${model}")
    if(ARGN AND NOT model IN_LIST ARGN)
      set(tables "0")
    endif()
    string(APPEND rows " \\\n    { \"${model}\", ${tables}, &${model}_names },")
  endforeach()
  file(CONFIGURE OUTPUT "${file}" CONTENT "${text}#define LABIAL_BUNDLED${rows}\n" @ONLY)
endfunction()

# labial_hearing_header(<file> [<model> ...]): writes a header with LABIAL_BUNDLED_HEARING, the rows of the models of
# hearing, or of those that are given, as { name, model, names of its classes }.
function(labial_hearing_header file)
  labial_hearing_models(models)
  if(ARGN)
    set(models ${ARGN})
  endif()
  set(text "/* The bundled models of hearing; written by cmake/BundledModels.cmake. */\n")
  set(rows "")
  foreach(model IN LISTS models)
    string(APPEND text "#include \"${model}.h\"\n")
    string(APPEND rows " \\\n    { \"${model}\", &${model}, ${model}_classes },")
  endforeach()
  file(CONFIGURE OUTPUT "${file}" CONTENT "${text}#define LABIAL_BUNDLED_HEARING${rows}\n" @ONLY)
endfunction()
