# gpgp::glyph_cache of an installed gpgp: glyphs of libgpgp_text in a canvas. It lies there as sources and is compiled by
# the project that links it, as a C++ interface fits one compiler only. A project without C++ has no such target.
get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
if(NOT "CXX" IN_LIST languages OR NOT TARGET gpgp::text OR TARGET gpgp::glyph_cache)
  return()
endif()
add_library(gpgp_glyph_cache STATIC EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/glyph_cache/glyph_cache.cpp
  ${CMAKE_CURRENT_LIST_DIR}/glyph_cache/glyph_pictures.cpp)
add_library(gpgp::glyph_cache ALIAS gpgp_glyph_cache)
set_target_properties(gpgp_glyph_cache PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_include_directories(gpgp_glyph_cache PUBLIC ${CMAKE_CURRENT_LIST_DIR}/glyph_cache)
target_compile_features(gpgp_glyph_cache PUBLIC cxx_std_20)
target_link_libraries(gpgp_glyph_cache PUBLIC gpgp::text)
if(TARGET gpgp::gpgp)
  target_link_libraries(gpgp_glyph_cache PUBLIC gpgp::gpgp)
else()
  target_link_libraries(gpgp_glyph_cache PUBLIC gpgp::gpgp_static)
endif()
