# gpgp_build: how all our own code is compiled, by compiler. Not exported: a consumer's flags are its own.
add_library(gpgp_build INTERFACE)
if(MSVC) # spelled and not tried yet: no build of ours has had it
  target_compile_options(gpgp_build INTERFACE /W4 /permissive- /utf-8 /EHsc /bigobj /Zc:__cplusplus /Zc:preprocessor
    /wd5030 # attributes of other compilers
    /fp:precise # which contracts nothing, from Visual Studio 2022 on; CPU references of shaders must round as the shaders do
    $<$<BOOL:${GPGP_WERROR}>:/WX>)
  target_compile_definitions(gpgp_build INTERFACE NOMINMAX _CRT_SECURE_NO_WARNINGS)
else()
  target_compile_options(gpgp_build INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-missing-field-initializers
    # GCC 12 sees overlaps and overruns in sums of strings and in growing vectors where none are (bugs 105651, 105329).
    "$<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>"
    -ffp-contract=off # CPU references of shaders must round as the shaders do
    -fno-fast-math
    -fvisibility=hidden $<$<COMPILE_LANGUAGE:CXX>:-fvisibility-inlines-hidden>
    $<$<BOOL:${GPGP_WERROR}>:-Werror>)
endif()
if(MINGW)
  target_compile_definitions(gpgp_build INTERFACE __USE_MINGW_ANSI_STDIO=1) # printf as the standard has it, %zu and all;
  target_compile_options(gpgp_build INTERFACE -Wno-format # the attribute of that name still means msvcrt's
    -Wa,-mbig-obj) # tests have more sections than the usual form holds
endif()
if(GPGP_SANITIZE)
  target_compile_options(gpgp_build INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
    -fno-omit-frame-pointer)
  target_link_options(gpgp_build INTERFACE -fsanitize=address,undefined)
endif()
