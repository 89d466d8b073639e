#include "cli/text/page.h"

#include "cli/shared/common.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace gpgp::cli {

std::vector<GpgpFontAxisValue> parseAxes(const std::string& list) {
  std::vector<GpgpFontAxisValue> axes;
  std::istringstream parts(list);
  for (std::string part; std::getline(parts, part, ',');) {
    char* end = nullptr;
    const bool named = part.size() > 5 && part[4] == '=';
    const float value = named ? std::strtof(part.c_str() + 5, &end) : 0;
    if (!named || *end != 0) throw Usage("--axes '" + part + "' is not an axis; write for example wght=650,wdth=80");
    axes.push_back({GPGP_TAG(part[0], part[1], part[2], part[3]), value});
  }
  return axes;
}

void GPGP_CALL TextPage::onMessage(void* userData, const GpgpMessage* message) {
  const std::string text = (message->label[0] ? std::string(message->label) + ": " : std::string()) + message->text;
  if (message->severity == GPGP_SEVERITY_ERROR)
    static_cast<TextPage*>(userData)->error_ = text; // thrown, and so printed, by check
  else
    std::fprintf(stderr, "gpgp text: warning: %s\n", text.c_str());
}

void TextPage::check(GpgpResult result, const char* what) {
  if (result < 0) throw Failure(error_.empty() ? std::string(what) + ": " + gpgpResultString(result) : error_);
}

TextPage::TextPage(const PageOptions& options) {
  std::vector<GpgpFont> chain;
  for (const std::string& file : options.fonts) {
    GpgpFontCreateInfo info = GPGP_FONT_CREATE_INFO_INIT;
    info.filePath = file.c_str();
    if (chain.empty()) {
      info.face = options.face;
      info.axes = options.axes.data();
      info.axisCount = static_cast<uint32_t>(options.axes.size());
    }
    info.messageFn = onMessage;
    info.messageUserData = this;
    Result<Font> font = Font::create(info);
    check(font.code(), "gpgpCreateFont"); // the message names the file
    chain.push_back(fonts_.emplace_back(std::move(*font)));
  }
  GpgpShaperCreateInfo shaperInfo = GPGP_SHAPER_CREATE_INFO_INIT;
  shaperInfo.messageFn = onMessage;
  shaperInfo.messageUserData = this;
  Result<Shaper> shaper = Shaper::create(shaperInfo);
  check(shaper.code(), "gpgpCreateShaper");
  shaper_ = std::move(*shaper);
  Result<Layout> layout = shaper_.layout();
  check(layout.code(), "gpgpCreateLayout");
  layout_ = std::move(*layout);

  GpgpTextInfo text = GPGP_TEXT_INFO_INIT;
  text.text = options.text.data();
  text.size = options.text.size();
  text.style.fonts = chain.data();
  text.style.fontCount = static_cast<uint32_t>(chain.size());
  text.style.size = options.size;
  std::copy(std::begin(options.color), std::end(options.color), text.style.color);
  text.style.language = options.language.empty() ? nullptr : options.language.c_str();
  text.style.features = options.features.data();
  text.style.featureCount = static_cast<uint32_t>(options.features.size());
  text.style.letterSpacing = options.letterSpacing;
  text.style.underline = options.underline ? VK_TRUE : VK_FALSE;
  text.style.strike = options.strike ? VK_TRUE : VK_FALSE;
  text.style.outlineWidth = options.outlineWidth;
  std::copy(std::begin(options.outlineColor), std::end(options.outlineColor), text.style.outlineColor);
  stroke_.width = options.outlineWidth / options.size;
  stroke_.join = GPGP_JOIN_ROUND;
  stroke_.scale = options.size;
  text.direction = options.direction;
  text.align = options.align;
  text.width = options.width;
  text.height = options.height;
  text.maxLines = options.maxLines;
  text.lineSpacing = options.lineSpacing;
  text.lineHeight = options.lineHeight;
  text.tabWidth = options.tabWidth;
  text.ellipsis = options.ellipsis ? options.ellipsis->c_str() : nullptr;
  const auto start = std::chrono::steady_clock::now();
  check(layout_.set(text), "gpgpSetLayoutText");
  shapeMilliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  check(gpgpGetLayoutInfo(layout_, &layoutInfo_), "gpgpGetLayoutInfo");

  std::string list;
  for (uint32_t i = 0; i < layoutInfo_.missingCount; ++i) {
    char name[16];
    std::snprintf(name, sizeof name, "U+%04X", layoutInfo_.missing[i].character);
    if (std::find(missing_.begin(), missing_.end(), name) != missing_.end()) continue;
    list += (missing_.empty() ? "" : ", ") + std::string(name);
    missing_.emplace_back(name);
  }
  if (!missing_.empty()) std::fprintf(stderr, "gpgp text: warning: no font has %s\n", list.c_str());
  if (layoutInfo_.invalidCount > 0)
    std::fprintf(stderr, "gpgp text: warning: the text is not UTF-8 in %u places, the first at byte %u\n",
                 layoutInfo_.invalidCount, layoutInfo_.invalid[0]);
}

uint32_t TextPage::fontNumber(GpgpFont font) const {
  return static_cast<uint32_t>(
      std::find_if(fonts_.begin(), fonts_.end(), [font](const Font& f) { return f.get() == font; }) - fonts_.begin());
}

} // namespace gpgp::cli
