// The screen without text: libgpgp_text was not built.
#include "text.h"

#include <cstdio>

namespace mini {

struct Text::Fonts {};

Text::Text(Gpgp& gpgp, const std::string&) : gpgp_(gpgp) {
  std::fprintf(stderr, "mini_engine: built without libgpgp_text; the screen goes without text\n");
}

Text::~Text() = default;

const TextBlock& Text::layOut(std::string_view, const TextStyle&) {
  if (entries_.empty()) entries_.emplace_back();
  return entries_.front().block;
}

} // namespace mini
