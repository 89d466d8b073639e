// A line of text of a sample, laid out once and placed in each frame.
#pragma once
#include "gpgp_glyph_cache.hpp"
#include "sample.h"

#include <algorithm>
#include <cstdio>

namespace gpgp::sample {

class TextLine {
public:
  TextLine(const integration::PictureDevice& pictures, GpgpContext context, const Options& options, float size)
      : fonts_(options) {
    if (fonts_.empty()) return;
    shaper_ = take(Shaper::create(), "gpgpCreateShaper");
    layout_ = take(shaper_.layout(), "gpgpCreateLayout");
    auto textInfo = init<GpgpTextInfo>();
    textInfo.text = options.text.data();
    textInfo.size = options.text.size();
    fonts_.set(textInfo.style);
    textInfo.style.size = size;
    std::fill_n(textInfo.style.color, 4, 1.0f);
    need(layout_.set(textInfo), "gpgpSetLayoutText");
    info = take(layout_.info(), "gpgpGetLayoutInfo");
    for (uint32_t i = 0; i < info.missingCount; ++i)
      std::fprintf(stderr, "no font has U+%04X\n", info.missing[i].character);
    integration::GlyphCacheInfo cacheInfo;
    cacheInfo.context = context;
    cacheInfo.pictureDevice = pictures;
    need(glyphs.create(cacheInfo), "gpgpCreateGlyphSet");
    list_ = take(List::create(context), "gpgpCreateList");
  }
  /// The list, filled anew; NULL without a font.
  GpgpList at(float x, float y) {
    if (!layout_) return nullptr;
    placed_.clear();
    if (need(glyphs.place(info, x, y, 1, placed_), "gpgpAddGlyphs") == GPGP_BUDGET_EXCEEDED && !told_) {
      std::fprintf(stderr, "%u glyphs found no room and are not shown\n", placed_.dropped);
      told_ = true;
    }
    need(list_.clear(), "gpgpResetList");
    need(glyphs.addTo(list_, placed_), "gpgpAddText");
    return list_;
  }

  GpgpLayoutInfo info = GPGP_LAYOUT_INFO_INIT;
  integration::GlyphCache glyphs;

private:
  FontChain fonts_;
  Shaper shaper_;
  Layout layout_;
  integration::PlacedText placed_;
  List list_;
  bool told_ = false; // that not all has found room
};

} // namespace gpgp::sample
