// Any bytes as baked glyphs, and a good file with bytes exchanged and its sums made right, so that the checks behind
// them are reached; what loads must make outlines without harm and bake to bytes that load again.
#include "vector/patch/glyphs.h"
#include "vector/raster/segments.h"

#include <cstdlib>
#include <cstring>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gpgp::vector;
  const auto memory = std::pmr::get_default_resource();
  (void)loadBakedGlyphs(std::as_bytes(std::span(data, size)), memory);
  const GpgpPathVerb verbs[] = {GPGP_PATH_MOVE, GPGP_PATH_QUAD, GPGP_PATH_LINE, GPGP_PATH_CLOSE};
  const float points[] = {0, 0, 0.5f, -0.9f, 0.7f, 0, 0.2f, 0.3f};
  const GpgpPath paths[] = {{verbs, 4, points, 4, GPGP_FILL_NON_ZERO, {0, 0, 0, 1}},
                            {verbs, 4, points, 4, GPGP_FILL_EVEN_ODD, {1, 0, 0, 0.5f}}};
  const GpgpGlyph glyphs[] = {{7, paths, 1, nullptr}, {8, nullptr, 0, nullptr}, {9, paths, 2, nullptr}};
  const auto good = makeGlyphs(glyphs, memory);
  if (!good) std::abort();
  std::pmr::vector<std::byte> bytes = bakeGlyphs(*good, memory);
  constexpr size_t kHeader = 32, kSummedFrom = 16, kSum = 8; // of the glyphs and of the drawing in them
  const size_t drawing = kHeader + std::size(glyphs) * sizeof(Glyphs::Entry);
  for (size_t i = 0; i + 4 <= size; i += 4) { // place, place, how, value
    std::byte& byte = bytes[kSummedFrom + (data[i] | size_t(data[i + 1]) << 8) % (bytes.size() - kSummedFrom)];
    byte = data[i + 2] % 2 ? static_cast<std::byte>(data[i + 3]) : byte ^ static_cast<std::byte>(1u << data[i + 3] % 8);
  }
  for (const size_t at : {drawing, size_t(0)}) {
    const uint64_t sum = checksum(std::span(bytes).subspan(at + kSummedFrom));
    std::memcpy(bytes.data() + at + kSum, &sum, sizeof sum);
  }
  const auto loaded = loadBakedGlyphs(bytes, memory);
  if (!loaded) return 0;
  (void)makeOutlines(loaded->drawing, memory);
  if (!loadBakedGlyphs(bakeGlyphs(*loaded, memory), memory)) std::abort();
  return 0;
}
