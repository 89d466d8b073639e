# gpgp_add_assets(TARGET FILES... [DESTINATION folder] [SET NAME=VALUE...] [NO_KERNEL] [RANGES list...]
#   [CHARACTERS_FILES files...] [OUTLINE width] [OUTPUTS variable])
#
# Bakes grammars (.pga), drawings (.svg, .svgz) and fonts (.ttf, .otf, .ttc, .otc) when TARGET is built, with `gpgp bake`: each file becomes
# folder/FILE.gpgp (drawings .gpgpv, fonts .gpgpf), below the path that it has in the source folder, and is baked again when
# it or the command changes.
# An error in one of them fails the build, with its place.
#
#   DESTINATION  where the baked files go; relative to the build folder; without it: assets
#   SET          overrides `var` of the grammars
#   NO_KERNEL    grammars run on the interpreter: smaller files, faster builds, slower derivation
#   RANGES, CHARACTERS_FILES
#                which characters of the fonts, as U+0020-007E and as files that have them, baked again when these
#                change; without either: all glyphs
#   OUTLINE      the fonts' glyphs with an outline, too, as wide in em
#   OUTPUTS      a variable for the list of baked files, to install or to pack
#
# The command is the target gpgp::command (an installed gpgp, or GPGP_BUILD_CLI=ON), or what GPGP_COMMAND names, as for
# cross-compiling: baked files are the same whichever machine they are made on.
function(gpgp_add_assets target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "NO_KERNEL" "DESTINATION;OUTPUTS;OUTLINE" "SET;RANGES;CHARACTERS_FILES")
  if(NOT TARGET ${target})
    message(FATAL_ERROR "gpgp_add_assets: there is no target ${target}")
  endif()
  if(arg_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "gpgp_add_assets: no value after ${arg_KEYWORDS_MISSING_VALUES}")
  endif()
  if(NOT arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "gpgp_add_assets: there are no files; expected grammars, drawings and fonts after ${target}")
  endif()
  if(GPGP_COMMAND)
    set(command ${GPGP_COMMAND})
  elseif(TARGET gpgp::command)
    set(command gpgp::command)
  else()
    message(FATAL_ERROR "gpgp_add_assets needs the gpgp command: install it, set GPGP_COMMAND to one, or set "
      "GPGP_BUILD_CLI=ON where gpgp is a subdirectory")
  endif()
  if(NOT arg_DESTINATION)
    set(arg_DESTINATION assets)
  endif()
  cmake_path(ABSOLUTE_PATH arg_DESTINATION BASE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR} NORMALIZE)
  set(options)
  if(arg_NO_KERNEL)
    list(APPEND options --no-kernel)
  endif()
  set(ofFonts)
  foreach(list IN LISTS arg_RANGES)
    list(APPEND ofFonts --ranges ${list})
  endforeach()
  set(characters)
  foreach(file IN LISTS arg_CHARACTERS_FILES)
    cmake_path(ABSOLUTE_PATH file NORMALIZE)
    list(APPEND characters ${file})
    list(APPEND ofFonts --characters-file ${file})
  endforeach()
  if(arg_OUTLINE)
    list(APPEND ofFonts --outline ${arg_OUTLINE})
  endif()
  set(outputs)
  foreach(file IN LISTS arg_UNPARSED_ARGUMENTS)
    cmake_path(ABSOLUTE_PATH file NORMALIZE)
    cmake_path(IS_PREFIX CMAKE_BINARY_DIR ${file} made) # by another command, perhaps
    if(NOT EXISTS ${file} AND NOT made)
      message(FATAL_ERROR "gpgp_add_assets: there is no file ${file}")
    endif()
    cmake_path(IS_PREFIX CMAKE_CURRENT_SOURCE_DIR ${file} inside)
    if(inside)
      cmake_path(RELATIVE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE name)
    else()
      cmake_path(GET file FILENAME name)
    endif()
    string(TOLOWER ${name} type)
    set(output ${arg_DESTINATION}/${name}.gpgp)
    if(type MATCHES "\\.svgz?$")
      string(APPEND output v)
    elseif(type MATCHES "\\.[to]t[fc]$")
      string(APPEND output f)
    endif()
    if(output IN_LIST outputs)
      message(FATAL_ERROR "gpgp_add_assets: two files would become ${output}")
    endif()
    set(own ${options})
    if(file MATCHES "\\.pga$")
      foreach(variable IN LISTS arg_SET)
        list(APPEND own --set ${variable})
      endforeach()
    endif()
    set(needed ${file})
    if(type MATCHES "\\.[to]t[fc]$")
      list(APPEND own ${ofFonts})
      list(APPEND needed ${characters})
    endif()
    cmake_path(GET output PARENT_PATH folder)
    add_custom_command(OUTPUT ${output} COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}
      COMMAND ${command} bake ${file} -o ${output} ${own} DEPENDS ${needed} ${command} COMMENT "Baking ${name}" VERBATIM)
    list(APPEND outputs ${output})
  endforeach()
  # A target of its own, so that any kind of target can wait for it; one for each call.
  set(number 1)
  while(TARGET ${target}_assets_${number})
    math(EXPR number "${number} + 1")
  endwhile()
  add_custom_target(${target}_assets_${number} DEPENDS ${outputs})
  add_dependencies(${target} ${target}_assets_${number})
  if(arg_OUTPUTS)
    set(${arg_OUTPUTS} ${outputs} PARENT_SCOPE)
  endif()
endfunction()
