// A chain of fonts is shaped and laid out by libgpgp_text; each glyph that is new becomes curves in a
// glyph set (integrations/common).
#include "text.h"

#include <gpgp_glyph_cache.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace mini {
namespace {

void GPGP_CALL onTextMessage(void*, const GpgpMessage* message) {
  std::fprintf(stderr, "text: %s: %s\n", message->label, message->text);
}

} // namespace

struct Text::Fonts {
  std::vector<gpgp::Font> fonts;
  std::vector<GpgpFont> regular, bold; // chains: a character takes the first font that has it
  gpgp::Shaper shaper;
  gpgp::Layout layout;
  gpgp::integration::GlyphCache cache;              // layouts to glyphs of a set, which it converts when they are new
  std::deque<gpgp::integration::PlacedText> placed; // of texts that were laid out
  float capHeight = 0.7f;                           // em, of the first font

  void open(Gpgp& gpgp, const std::string& file, std::initializer_list<std::vector<GpgpFont>*> chains,
            float weight = 0) {
    if (!fileExists(file)) {
      std::fprintf(stderr, "mini_engine: %s is not there (tests/data/fetch.sh fetches fonts); going on without it\n",
                   file.c_str());
      return;
    }
    const GpgpFontAxisValue axis{GPGP_TAG('w', 'g', 'h', 't'), weight};
    auto info = gpgp::init<GpgpFontCreateInfo>();
    info.filePath = file.c_str();
    info.axes = &axis;
    info.axisCount = weight > 0 ? 1 : 0;
    info.messageFn = onTextMessage;
    fonts.push_back(gpgp.take(gpgp::Font::create(info), "gpgpCreateFont"));
    for (auto* chain : chains) chain->push_back(fonts.back());
  }
};

Text::Text(Device& device, Gpgp& gpgp, const std::string& folder) : gpgp_(gpgp), fonts_(std::make_unique<Fonts>()) {
  Fonts& f = *fonts_;
  f.open(gpgp, folder + "/Inter-roman.var.ttf", {&f.regular}, 450);
  f.open(gpgp, folder + "/Inter-roman.var.ttf", {&f.bold}, 700);
  f.open(gpgp, folder + "/NotoSansArabic-Regular.ttf", {&f.regular, &f.bold});
  f.open(gpgp, folder + "/NotoSansCJK-Regular.ttc", {&f.regular, &f.bold});
  f.open(gpgp, folder + "/NotoColorEmoji.ttf", {&f.regular, &f.bold});
  if (f.fonts.empty()) {
    std::fprintf(stderr, "mini_engine: no font in %s; the screen goes without text\n", folder.c_str());
    return;
  }
  f.capHeight = gpgp.take(f.fonts.front().info(), "gpgpGetFontInfo").capHeight;
  auto shaper = gpgp::init<GpgpShaperCreateInfo>();
  shaper.messageFn = onTextMessage;
  f.shaper = gpgp.take(gpgp::Shaper::create(shaper), "gpgpCreateShaper");
  f.layout = gpgp.take(f.shaper.layout(), "gpgpCreateLayout");
  // Large enough for all that is ever shown: nothing is evicted, and indices stay as they are.
  gpgp::integration::GlyphCacheInfo cache;
  cache.context = gpgp.context;
  cache.label = "screen glyphs";
  cache.maxGlyphs = 1024;
  cache.maxBytes = VkDeviceSize{4} << 20;
  cache.maxPictures = 16;
  cache.pictureDevice.device = device.device;
  cache.pictureDevice.getDeviceProcAddr = vkGetDeviceProcAddr;
  vkGetPhysicalDeviceMemoryProperties(device.physical, &cache.pictureDevice.memory);
  gpgp_.check(f.cache.create(cache), "gpgpCreateGlyphSet");
  glyphs_ = f.cache.set();
}

Text::~Text() = default;

const TextBlock& Text::layOut(std::string_view text, const TextStyle& style) {
  for (const Entry& entry : entries_)
    if (entry.text == text && entry.style == style) return entry.block;
  Entry& entry = entries_.emplace_back(Entry{std::string(text), style, {}});
  if (glyphs_) set(entry, entry.block);
  return entry.block;
}

void Text::set(const Entry& entry, TextBlock& block) {
  const TextStyle& style = entry.style;
  const std::vector<GpgpFont>& chain = style.bold && !fonts_->bold.empty() ? fonts_->bold : fonts_->regular;
  auto info = gpgp::init<GpgpTextInfo>();
  info.text = entry.text.data();
  info.size = entry.text.size();
  info.style.fonts = chain.data();
  info.style.fontCount = static_cast<uint32_t>(chain.size());
  info.style.size = style.size;
  std::copy(std::begin(style.color), std::end(style.color), info.style.color);
  info.align = style.align;
  info.width = style.width;
  info.height = style.height;
  info.maxLines = style.maxLines;
  info.lineHeight = std::round(style.size * 1.45f); // whole pixels: every baseline is as sharp as the first
  gpgp_.check(fonts_->layout.set(info), "gpgpSetLayoutText");
  const GpgpLayoutInfo layout = gpgp_.take(fonts_->layout.info(), "gpgpGetLayoutInfo");
  block.width = layout.width;
  block.baseline = layout.lines[0].baseline;
  block.capHeight = fonts_->capHeight * style.size;
  block.placed = fonts_->placed.size();
  if (gpgp_.check(fonts_->cache.place(layout, 0, 0, 1, fonts_->placed.emplace_back()), "gpgpAddGlyphs") != GPGP_SUCCESS)
    throw std::runtime_error("the set of glyphs is full");
}

void Text::forget() {
  entries_.clear();
  fonts_->placed.clear();
}

void Text::add(gpgp::List& list, const TextBlock& block, uint32_t image, uint64_t id) {
  if (glyphs_) gpgp_.check(fonts_->cache.addTo(list, fonts_->placed[block.placed], image, id), "gpgpAddText");
}

void Text::upload(VkCommandBuffer commands, const GpgpFrame& frame) {
  if (glyphs_) gpgp_.check(fonts_->cache.recordUpload(commands, frame), "the upload of pictures");
}

std::optional<GpgpCanvasImage> Text::image() const { return glyphs_ ? fonts_->cache.image() : std::nullopt; }

} // namespace mini
