# Compiles GLSL to SPIR-V at build time, validates it and turns it into a header that C++ includes.
#
#   gpgp_add_shader(TARGET NAME SOURCE [DEFINES A=1 B ...])
#
# SOURCE is a path below shaders/, or an absolute one. The header is included as "shaders/NAME.spv.h" and defines
# `static const uint32_t NAME[]`. A shader that does not validate fails the build.
#
#   gpgp_pack_shaders(TARGET)
#
# Before the shaders of TARGET, a part of the library: they go without debug names into packs of zstd, those of one
# source together, and a header defines `constexpr gpgp::core::ShaderCode NAME` (src/core/shader_code.h).
#
# Also a script: with GPGP_PACK set, it makes one pack of modules.
if(GPGP_PACK)
  string(REPLACE "|" ";" names "${GPGP_PACK_NAMES}")
  list(TRANSFORM names APPEND .spv OUTPUT_VARIABLE modules)
  execute_process(COMMAND ${CMAKE_COMMAND} -E cat ${modules} OUTPUT_FILE ${GPGP_PACK}.bin COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${GPGP_ZSTD} -q -f -19 ${GPGP_PACK}.bin -o ${GPGP_PACK}.zst COMMAND_ERROR_IS_FATAL ANY)
  file(SIZE ${GPGP_PACK}.bin size)
  math(EXPR words "${size} / 4")
  file(SIZE ${GPGP_PACK}.zst size)
  file(READ ${GPGP_PACK}.zst bytes HEX)
  file(REMOVE ${GPGP_PACK}.bin ${GPGP_PACK}.zst)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  set(line "0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,")
  string(REGEX REPLACE "(${line}${line}${line})" "\\1\n" bytes "${bytes}")
  file(WRITE ${GPGP_PACK}.cpp "#include \"core/shader_pack.h\"
namespace gpgp::core::packs {
constexpr unsigned char bytes[] = {
${bytes}};
extern const ShaderPack ${GPGP_PACK};
const ShaderPack ${GPGP_PACK}{bytes, ${size}, ${words}};
} // namespace gpgp::core::packs
")
  set(first 0)
  foreach(name IN LISTS names)
    file(SIZE ${name}.spv size)
    math(EXPR words "${size} / 4")
    file(CONFIGURE OUTPUT ${name}.spv.h CONTENT "#pragma once // written where it has changed
#include \"core/shader_code.h\"
namespace gpgp::core::packs {
extern const ShaderPack ${GPGP_PACK};
}
inline constexpr gpgp::core::ShaderCode ${name}{gpgp::core::packs::${GPGP_PACK}, ${first}, ${words}};
")
    math(EXPR first "${first} + ${words}")
  endforeach()
  return()
endif()

set(GPGP_SHADERS_FROM "" CACHE PATH "generated/ of another build of the same sources, whose shaders are taken; for tests")
find_program(GPGP_GLSLANG glslangValidator REQUIRED)
find_program(GPGP_SPIRV_VAL spirv-val REQUIRED)
find_program(GPGP_ZSTD zstd REQUIRED)
set(GPGP_SHADERS_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(gpgp_add_shader target name source)
  cmake_parse_arguments(arg "" "" "DEFINES" ${ARGN})
  set_property(GLOBAL APPEND_STRING PROPERTY gpgp_shader_files "${name} ${source}\n") # for tests/docs
  get_target_property(packed ${target} GPGP_PACKED)
  if(packed)
    set_property(TARGET ${target} APPEND PROPERTY GPGP_SHADERS "${name}|${source}")
  endif()
  if(GPGP_SHADERS_FROM)
    target_include_directories(${target} PRIVATE ${GPGP_SHADERS_FROM})
    return()
  endif()
  cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${PROJECT_SOURCE_DIR}/shaders)
  set(dir ${PROJECT_BINARY_DIR}/generated/shaders)
  file(MAKE_DIRECTORY ${dir})
  list(TRANSFORM arg_DEFINES PREPEND "-D" OUTPUT_VARIABLE defines)
  set(glslang ${GPGP_GLSLANG} -V --target-env vulkan1.2 --quiet -I${PROJECT_SOURCE_DIR}/shaders -I${PROJECT_SOURCE_DIR}/include ${defines})
  if(packed)
    set(outputs ${dir}/${name}.spv)
    list(APPEND glslang -g0)
    set(header)
  else()
    set(outputs ${dir}/${name}.spv ${dir}/${name}.spv.h) # the first is what the depfile names
    set(header COMMAND ${glslang} --vn ${name} -o ${dir}/${name}.spv.h ${source})
    target_sources(${target} PRIVATE ${dir}/${name}.spv.h)
  endif()
  add_custom_command(OUTPUT ${outputs}
    COMMAND ${glslang} --depfile ${dir}/${name}.d -o ${dir}/${name}.spv ${source}
    COMMAND ${GPGP_SPIRV_VAL} --target-env vulkan1.2 ${dir}/${name}.spv
    ${header}
    DEPENDS ${source}
    DEPFILE ${dir}/${name}.d
    COMMENT "Shader ${name}" VERBATIM)
  target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/generated)
endfunction()

function(gpgp_pack_shaders target)
  set_target_properties(${target} PROPERTIES GPGP_PACKED ON)
  cmake_language(EVAL CODE "cmake_language(DEFER CALL gpgp_make_packs ${target})")
endfunction()

# At most 8 modules a pack: whoever needs one unpacks all.
function(gpgp_make_packs target)
  get_target_property(shaders ${target} GPGP_SHADERS)
  list(SORT shaders COMPARE NATURAL)
  set(packs)
  foreach(shader IN LISTS shaders)
    string(REPLACE "|" ";" parts "${shader}")
    list(GET parts 0 name)
    list(GET parts 1 source)
    string(MAKE_C_IDENTIFIER "${source}" pack)
    list(LENGTH all_${pack} count)
    math(EXPR number "${count} / 8")
    list(APPEND all_${pack} ${name})
    list(APPEND ${pack}_${number} ${name})
    list(APPEND packs ${pack}_${number})
  endforeach()
  list(REMOVE_DUPLICATES packs)
  set(dir ${PROJECT_BINARY_DIR}/generated/shaders)
  foreach(pack IN LISTS packs)
    if(GPGP_SHADERS_FROM)
      target_sources(${target} PRIVATE ${GPGP_SHADERS_FROM}/shaders/${pack}.cpp)
      continue()
    endif()
    list(TRANSFORM ${pack} APPEND .spv OUTPUT_VARIABLE modules)
    list(TRANSFORM modules PREPEND ${dir}/)
    list(TRANSFORM modules APPEND .h OUTPUT_VARIABLE headers)
    string(REPLACE ";" "|" names "${${pack}}")
    add_custom_command(OUTPUT ${dir}/${pack}.cpp ${headers}
      COMMAND ${CMAKE_COMMAND} -DGPGP_PACK=${pack} -DGPGP_PACK_NAMES=${names} -DGPGP_ZSTD=${GPGP_ZSTD} -P ${GPGP_SHADERS_SCRIPT}
      WORKING_DIRECTORY ${dir}
      DEPENDS ${modules} ${GPGP_SHADERS_SCRIPT}
      COMMENT "Shaders ${pack}" VERBATIM)
    target_sources(${target} PRIVATE ${dir}/${pack}.cpp ${headers})
    set_source_files_properties(${dir}/${pack}.cpp PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  endforeach()
endfunction()
