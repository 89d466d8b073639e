// gpgpCompileGlyphs: glyphs to their baked form.
#include "vector/patch/glyphs.h"
#include "core/blob.h"

#include <algorithm>

using namespace gpgp;

namespace {
core::Result<void> compile(const GpgpGlyphSource& source, GpgpBlob& blob) {
  using core::makeError;
  if (source.glyphCount && !source.glyphs)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "glyphs is NULL, but glyphCount is %u", source.glyphCount);
  std::pmr::memory_resource* memory = std::pmr::new_delete_resource();
  std::pmr::vector<uint64_t> keys(memory);
  for (uint32_t i = 0; i < source.glyphCount; ++i) keys.push_back(source.glyphs[i].key);
  std::sort(keys.begin(), keys.end());
  if (const auto twice = std::adjacent_find(keys.begin(), keys.end()); twice != keys.end())
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "two glyphs have the key %llu",
                     static_cast<unsigned long long>(*twice));
  const auto glyphs = vector::makeGlyphs({source.glyphs, source.glyphCount}, memory, source.jobSystem);
  if (!glyphs) return glyphs.error();
  const auto bytes = vector::bakeGlyphs(*glyphs, memory);
  const GpgpBlob made = core::copyToBlob(std::as_bytes(std::span(bytes)));
  if (!made.data) throw std::bad_alloc();
  blob = made;
  return {};
}
} // namespace

GpgpResult GPGP_CALL gpgpCompileGlyphs(const GpgpGlyphSource* source, GpgpBlob* blob) {
  if (!source || !blob) return GPGP_ERROR_INVALID_ARGUMENT;
  if (source->sType != GPGP_STRUCTURE_GLYPH_SOURCE || source->pNext) return GPGP_ERROR_INVALID_STRUCT;
  core::Error error;
  try {
    const auto done = compile(*source, *blob);
    if (done) return GPGP_SUCCESS;
    error = done.error();
  } catch (...) {
    error = core::makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of memory");
  }
  const GpgpMessage message{GPGP_SEVERITY_ERROR, error.code, "gpgpCompileGlyphs", source->name ? source->name : "",
                            error.text};
  if (source->messageFn) source->messageFn(source->messageUserData, &message);
  return error.code;
}
