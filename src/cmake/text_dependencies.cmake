# PkgConfig::GPGP_TEXT: what libgpgp_text links. Not there where a package is missing. Installed, too: whoever links the
# static library needs the same.
set(GPGP_TEXT_PACKAGES freetype2 harfbuzz fribidi icu-uc)
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND AND NOT TARGET PkgConfig::GPGP_TEXT)
  pkg_check_modules(GPGP_TEXT QUIET IMPORTED_TARGET GLOBAL ${GPGP_TEXT_PACKAGES})
endif()
