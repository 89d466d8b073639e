# Compiles GLSL to SPIR-V at build time, validates it and turns it into a header that C++ includes.
#
#   gpgp_add_shader(TARGET NAME SOURCE [DEFINES A=1 B ...])
#
# SOURCE is a path below shaders/, or an absolute one. The header is included as "shaders/NAME.spv.h" and defines
# `static const uint32_t NAME[]`. A shader that does not validate fails the build.
set(GPGP_SHADERS_FROM "" CACHE PATH "generated/ of another build of the same sources, whose shaders are taken; for tests")
find_program(GPGP_GLSLANG glslangValidator REQUIRED)
find_program(GPGP_SPIRV_VAL spirv-val REQUIRED)

function(gpgp_add_shader target name source)
  cmake_parse_arguments(arg "" "" "DEFINES" ${ARGN})
  set_property(GLOBAL APPEND_STRING PROPERTY gpgp_shader_files "${name} ${source}\n") # for tests/docs
  if(GPGP_SHADERS_FROM)
    target_include_directories(${target} PRIVATE ${GPGP_SHADERS_FROM})
    return()
  endif()
  cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${PROJECT_SOURCE_DIR}/shaders)
  set(dir ${PROJECT_BINARY_DIR}/generated/shaders)
  file(MAKE_DIRECTORY ${dir})
  list(TRANSFORM arg_DEFINES PREPEND "-D" OUTPUT_VARIABLE defines)
  set(glslang ${GPGP_GLSLANG} -V --target-env vulkan1.2 --quiet -I${PROJECT_SOURCE_DIR}/shaders -I${PROJECT_SOURCE_DIR}/include ${defines})
  add_custom_command(OUTPUT ${dir}/${name}.spv ${dir}/${name}.spv.h # the first is what the depfile names
    COMMAND ${glslang} --depfile ${dir}/${name}.d -o ${dir}/${name}.spv ${source}
    COMMAND ${GPGP_SPIRV_VAL} --target-env vulkan1.2 ${dir}/${name}.spv
    COMMAND ${glslang} --vn ${name} -o ${dir}/${name}.spv.h ${source}
    DEPENDS ${source}
    DEPFILE ${dir}/${name}.d
    COMMENT "Shader ${name}" VERBATIM)
  target_sources(${target} PRIVATE ${dir}/${name}.spv.h)
  target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/generated)
endfunction()
