// The screen without text: libgpgp_text was not built.
#include "text.h"

#include <cstdio>

namespace mini {

struct Text::Fonts {};

Text::Text(Device&, Gpgp& gpgp, const std::string&) : gpgp_(gpgp) {
  std::fprintf(stderr, "mini_engine: built without libgpgp_text; the screen goes without text\n");
}

Text::~Text() = default;

const TextBlock& Text::layOut(std::string_view, const TextStyle&) {
  if (entries_.empty()) entries_.emplace_back();
  return entries_.front().block;
}

void Text::forget() {}
void Text::add(gpgp::List&, const TextBlock&, uint32_t, uint64_t) {}
void Text::upload(VkCommandBuffer, const GpgpFrame&) {}
std::optional<GpgpCanvasImage> Text::image() const { return std::nullopt; }

} // namespace mini
