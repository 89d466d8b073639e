# Shader sources as text in a library that compiles shaders itself.
#
#   gpgp_embed_shaders(TARGET NAME FILES...)
#
# FILES are paths below shaders/. The header is included as "shaders/NAME.h" and defines `struct EmbeddedShader { const
# char* path; const char* text; };` and `constexpr EmbeddedShader NAME[]`. Also a script: with GPGP_EMBED_OUTPUT set, it
# writes the header.
if(GPGP_EMBED_OUTPUT)
  set(text "struct EmbeddedShader {\n  const char* path;\n  const char* text;\n};\n")
  string(APPEND text "constexpr EmbeddedShader ${GPGP_EMBED_NAME}[] = {\n")
  string(REPLACE "|" ";" files "${GPGP_EMBED_FILES}")
  foreach(file ${files})
    file(READ ${GPGP_EMBED_ROOT}/${file} content)
    string(APPEND text "{\"${file}\", R\"gpgp(${content})gpgp\"},\n")
  endforeach()
  file(WRITE ${GPGP_EMBED_OUTPUT} "${text}};\n")
  return()
endif()

set(GPGP_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
function(gpgp_embed_shaders target name)
  set(output ${PROJECT_BINARY_DIR}/generated/shaders/${name}.h)
  set(root ${PROJECT_SOURCE_DIR}/shaders)
  list(TRANSFORM ARGN PREPEND ${root}/ OUTPUT_VARIABLE depends)
  string(REPLACE ";" "|" files "${ARGN}")
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DGPGP_EMBED_OUTPUT=${output} -DGPGP_EMBED_NAME=${name} -DGPGP_EMBED_ROOT=${root}
            -DGPGP_EMBED_FILES=${files} -P ${GPGP_EMBED_SCRIPT}
    DEPENDS ${depends} ${GPGP_EMBED_SCRIPT}
    COMMENT "Shader sources ${name}" VERBATIM)
  target_sources(${target} PRIVATE ${output})
  target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/generated)
endfunction()
