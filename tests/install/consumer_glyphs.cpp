// gpgp::glyph_cache of an installed gpgp.
#include <gpgp_glyph_cache.hpp>

#include <cstdio>

int main() {
  gpgp::integration::GlyphCache cache;
  gpgp::integration::GlyphCacheInfo info; // without a context
  if (cache.create(info) >= 0) return 1;
  std::puts("no glyph cache without a context");
  return 0;
}
