# Headers that are compiled once: a build from nothing takes less time, but ccache cannot keep what it compiles.
# Every source includes what it needs all the same, since the default build has none.
option(GPGP_PRECOMPILED_HEADERS "Compile standard headers once a target, for builds without ccache" OFF)

# gpgp_precompile(TARGET HEADER): HEADER is one of precompiled/.
function(gpgp_precompile target header)
  if(GPGP_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} PRIVATE
      "$<$<COMPILE_LANGUAGE:CXX>:${PROJECT_SOURCE_DIR}/src/cmake/precompiled/${header}>")
  endif()
endfunction()

# gpgp_precompiled_from(TARGET OTHER): those of another target. Where options differ, the compiler reads the headers.
function(gpgp_precompiled_from target other)
  get_target_property(sources ${target} SOURCES)
  if(GPGP_PRECOMPILED_HEADERS AND NOT sources MATCHES "\\.c(;|$)") # which would ask for C's
    target_precompile_headers(${target} REUSE_FROM ${other})
    set_target_properties(${target} PROPERTIES PCH_WARN_INVALID OFF)
  endif()
endfunction()
