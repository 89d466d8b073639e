# The shaders of the vector service: one table from which the build rules are made, what "shaders/vector_shaders.h"
# declares, and the one source that defines it.
#
#   gpgp_vector_shader(NAME FILE [SUBGROUPS] [DRAWINGS] [OPERATIONS] [TARGETS] DEFINES A=1 ...)
#
# Each axis multiplies the shader. In C++ vector_NAME is the module, or an array of them by axis, in this order:
#
#   SUBGROUPS   [0] for any device, [1] for devices with subgroup arithmetic             SUBGROUPS=0|1
#   DRAWINGS    [0] one drawing, [1] several drawings, [2] projective items              ONE_DRAWING=1|0, PROJECTIVE=1
#   OPERATIONS  by what an operation of layers needs (operate.comp)                      OPERATIONS=0...
#   TARGETS     [0] the history alone, [1] R8G8B8A8_UNORM, [2] R16G16B16A16_SFLOAT       TARGET=0|1|2
set(vector_includes)
set(vector_declarations)
set(vector_definitions)
function(gpgp_vector_shader name file)
  cmake_parse_arguments(arg "SUBGROUPS;DRAWINGS;TARGETS;OPERATIONS" "" "DEFINES" ${ARGN})
  set(names vector_${name}) # name|define|define...
  set(type)
  macro(multiply axis size)
    if(arg_${axis})
      set(next)
      foreach(entry IN LISTS names)
        foreach(suffix ${ARGN})
          string(REPLACE "|" ";" parts "${entry}")
          list(POP_FRONT parts own)
          string(REPLACE "," ";" suffix_parts "${suffix}")
          list(POP_FRONT suffix_parts ending)
          list(APPEND parts ${suffix_parts})
          list(PREPEND parts ${own}_${ending})
          string(REPLACE ";" "|" joined "${parts}")
          list(APPEND next "${joined}")
        endforeach()
      endforeach()
      set(names ${next})
      list(APPEND type ${size})
    endif()
  endmacro()
  multiply(SUBGROUPS 2 any,SUBGROUPS=0 subgroups,SUBGROUPS=1)
  multiply(DRAWINGS 3 one,ONE_DRAWING=1 several,ONE_DRAWING=0 projective,ONE_DRAWING=0,PROJECTIVE=1)
  multiply(OPERATIONS 6 composite,OPERATIONS=0 blur,OPERATIONS=1 colors,OPERATIONS=2 neighbourhoods,OPERATIONS=3
    noise,OPERATIONS=4 light,OPERATIONS=5)
  multiply(TARGETS 3 history,TARGET=0 rgba8,TARGET=1 rgba16f,TARGET=2)
  set(includes ${vector_includes})
  set(values)
  foreach(entry IN LISTS names)
    string(REPLACE "|" ";" defines "${entry}")
    list(POP_FRONT defines own)
    gpgp_add_shader(gpgp_vector_objects ${own} vector/${file} DEFINES ${defines} ${arg_DEFINES})
    string(APPEND includes "#include \"shaders/${own}.spv.h\"\n")
    list(APPEND values ${own})
  endforeach()
  set(vector_includes "${includes}" PARENT_SCOPE)
  set(spirv "core::ShaderCode")
  list(TRANSFORM values PREPEND "::")
  list(LENGTH type depth)
  if(depth EQUAL 2) # braces around each inner array
    list(GET type 1 inner)
    set(rows)
    list(LENGTH values count)
    math(EXPR last "${count} - 1")
    foreach(begin RANGE 0 ${last} ${inner})
      list(SUBLIST values ${begin} ${inner} row)
      list(JOIN row ", " row)
      list(APPEND rows "{{${row}}}")
    endforeach()
    set(values ${rows})
  endif()
  list(JOIN values ", " values)
  if(type)
    set(values "{{${values}}}")
  endif()
  list(REVERSE type)
  foreach(size IN LISTS type)
    set(spirv "std::array<${spirv}, ${size}>")
  endforeach()
  set(vector_declarations "${vector_declarations}extern const ${spirv} vector_${name};\n" PARENT_SCOPE)
  set(vector_definitions "${vector_definitions}constinit const ${spirv} vector_${name} = ${values};\n" PARENT_SCOPE)
endfunction()

# ---------------------------------------------------------------- table

gpgp_vector_shader(begin place/begin.comp)
gpgp_vector_shader(begin_alone place/begin.comp DEFINES ALONE=1)
gpgp_vector_shader(begin_software place/begin.comp DEFINES ONE_DRAWING=1 SOFTWARE=1)
gpgp_vector_shader(place place/place.comp DRAWINGS)

gpgp_vector_shader(small_glyphs glyphs/small_glyphs.comp SUBGROUPS DEFINES ONE_DRAWING=0)
gpgp_vector_shader(small_glyphs_one glyphs/small_glyphs.comp SUBGROUPS DEFINES ONE_DRAWING=1)
gpgp_vector_shader(small_glyphs_alone glyphs/small_glyphs.comp SUBGROUPS DEFINES ONE_DRAWING=0 ALONE=1)
gpgp_vector_shader(small_glyphs_alone_one glyphs/small_glyphs.comp SUBGROUPS DEFINES ONE_DRAWING=1 ALONE=1)
gpgp_vector_shader(small_glyphs_alone_sixteen glyphs/small_glyphs.comp SUBGROUPS
  DEFINES ONE_DRAWING=1 ALONE=1 SAMPLES=16)

# More invocations a workgroup than segments.glsl has: mark waits for memory.
gpgp_vector_shader(mark mark/mark.comp DRAWINGS DEFINES LANES=128)
gpgp_vector_shader(mark_sixteen mark/mark.comp DEFINES ONE_DRAWING=1 SAMPLES=16 LANES=128)
gpgp_vector_shader(allocate mark/allocate.comp SUBGROUPS DEFINES ONE_DRAWING=1)
gpgp_vector_shader(pack mark/pack.comp SUBGROUPS DEFINES ONE_DRAWING=1)
gpgp_vector_shader(split mark/split.comp DEFINES ONE_DRAWING=0)
gpgp_vector_shader(split_one mark/split.comp DEFINES ONE_DRAWING=1)

gpgp_vector_shader(fill fill/fill.comp DRAWINGS)
gpgp_vector_shader(fill_rows fill/fill_rows.comp DEFINES ONE_DRAWING=1 SCISSORS=1)
gpgp_vector_shader(fill_rows_one fill/fill_rows.comp DEFINES ONE_DRAWING=1)
gpgp_vector_shader(fill_rows_sixteen fill/fill_rows.comp DEFINES ONE_DRAWING=1 SAMPLES=16)

gpgp_vector_shader(patch_tiles patches/tiles.comp DEFINES ONE_DRAWING=0 BLOCKS=0)
gpgp_vector_shader(patch_tiles_one patches/tiles.comp DEFINES ONE_DRAWING=1 BLOCKS=0)
gpgp_vector_shader(patch_blocks patches/tiles.comp DEFINES ONE_DRAWING=0 BLOCKS=1)
gpgp_vector_shader(patch_blocks_one patches/tiles.comp DEFINES ONE_DRAWING=1 BLOCKS=1)
gpgp_vector_shader(patch_fill patches/fill.comp DEFINES ONE_DRAWING=0)
gpgp_vector_shader(patch_fill_one patches/fill.comp DEFINES ONE_DRAWING=1)

# What a tile may hold: plain colours; gradients; all of it (groups, clips, projective items); images beside either.
set(plain PAINTS=0 ONE_DRAWING=1)
set(paints PAINTS=1 ONE_DRAWING=0)
set(paints_one PAINTS=1 ONE_DRAWING=1)
set(images PAINTS=1 IMAGES=1 ONE_DRAWING=0)
set(rich PAINTS=1 RICH=1 PROJECTIVE=1 ONE_DRAWING=0)
set(rich_one PAINTS=1 RICH=1 PROJECTIVE=1 ONE_DRAWING=1)
set(rich_images PAINTS=1 RICH=1 PROJECTIVE=1 IMAGES=1 ONE_DRAWING=0)
foreach(form plain paints paints_one images)
  gpgp_vector_shader(raster_${form} raster/raster.comp TARGETS DEFINES ${${form}})
endforeach()
foreach(form rich rich_one rich_images)
  gpgp_vector_shader(raster_${form} raster/raster.comp TARGETS DEFINES ${${form}} KEPT=1)
  gpgp_vector_shader(aside_${form} raster/raster.comp DEFINES ${${form}} ASIDE=1)
endforeach()
gpgp_vector_shader(raster_glyphs glyphs/raster_glyphs.comp TARGETS DEFINES ${plain})

# Colours of images, where there are more than a shader can name
set(colors PAINTS=1 IMAGES=1 PROJECTIVE=1 ONE_DRAWING=0 COLORS_ALONE=1)
gpgp_vector_shader(images raster/images.comp DEFINES ${colors})
gpgp_vector_shader(images_software raster/images.comp DEFINES ${colors} SOFTWARE=1)

# Layers
gpgp_vector_shader(operate layers/operate.comp OPERATIONS DEFINES ONE_DRAWING=0)
gpgp_vector_shader(present layers/present.comp TARGETS DEFINES ONE_DRAWING=0)

# Software devices
gpgp_vector_shader(clear_words software/clear.comp DEFINES ONE_DRAWING=1 SOFTWARE=1 WORDS=1)
gpgp_vector_shader(clear_entries software/clear.comp DEFINES ONE_DRAWING=1 SOFTWARE=1 WORDS=0)
gpgp_vector_shader(mark_pieces software/mark_pieces.comp SUBGROUPS DRAWINGS DEFINES SOFTWARE=1)
gpgp_vector_shader(allocate_rows software/allocate_rows.comp DEFINES ONE_DRAWING=1 SOFTWARE=1)
gpgp_vector_shader(allocate_software mark/allocate.comp DEFINES ONE_DRAWING=1 SOFTWARE=1)
gpgp_vector_shader(fill_pieces software/fill_pieces.comp SUBGROUPS DEFINES ONE_DRAWING=1 SCISSORS=1 SOFTWARE=1)
gpgp_vector_shader(fill_pieces_one software/fill_pieces.comp SUBGROUPS DEFINES ONE_DRAWING=1 SOFTWARE=1)
gpgp_vector_shader(fill_backdrop software/fill_backdrop.comp DEFINES ONE_DRAWING=1 SOFTWARE=1)
gpgp_vector_shader(fill_software fill/fill.comp DRAWINGS DEFINES SOFTWARE=1)
gpgp_vector_shader(sift software/sift.comp DEFINES ONE_DRAWING=1 SOFTWARE=1 SPLIT=0)
gpgp_vector_shader(sift_split software/sift.comp DEFINES ONE_DRAWING=0 SOFTWARE=1 SPLIT=1)
gpgp_vector_shader(tiles_solid software/raster_tiles.comp TARGETS DEFINES ${plain} TILES=0 SOFTWARE=1)
gpgp_vector_shader(tiles_rows software/raster_rows.comp TARGETS DEFINES ${plain} SOFTWARE=1)
foreach(form plain paints paints_one images rich rich_images)
  gpgp_vector_shader(tiles_${form} software/raster_tiles.comp TARGETS DEFINES ${${form}} TILES=1 SOFTWARE=1)
  gpgp_vector_shader(crowded_${form} raster/raster.comp TARGETS DEFINES ${${form}} CROWDED=1 SOFTWARE=1)
endforeach()

foreach(stage vert frag)
  gpgp_add_shader(gpgp_vector_objects vector_draw_${stage} vector/raster/draw.${stage} DEFINES MULTIVIEW=0)
  gpgp_add_shader(gpgp_vector_objects vector_draw_${stage}_multiview vector/raster/draw.${stage} DEFINES MULTIVIEW=1)
endforeach()

# Inside a render pass: from one drawing or glyph set, or from several.
foreach(stage vert frag)
  foreach(multiview 0 1)
    foreach(one 0 1)
      gpgp_add_shader(gpgp_vector_objects vector_patches_${stage}_${one}${multiview} vector/in_pass/patches.${stage}
        DEFINES ONE_DRAWING=${one} MULTIVIEW=${multiview})
    endforeach()
  endforeach()
endforeach()

set(generated ${PROJECT_BINARY_DIR}/generated/shaders)
file(CONFIGURE OUTPUT ${generated}/vector_shaders.h CONTENT [[
// By src/vector/shaders.cmake.
#pragma once
#include "core/shader_code.h"

#include <array>

namespace gpgp::vector {
@vector_declarations@} // namespace gpgp::vector
]] @ONLY)
file(CONFIGURE OUTPUT ${generated}/vector_shaders.cpp CONTENT [[
// By src/vector/shaders.cmake.
#include "shaders/vector_shaders.h"

@vector_includes@
namespace gpgp::vector {
@vector_definitions@} // namespace gpgp::vector
]] @ONLY)
target_sources(gpgp_vector_objects PRIVATE ${generated}/vector_shaders.cpp)
