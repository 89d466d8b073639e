// Any bytes as a style sheet, as media, as an address, as a style attribute, as the value of each property and as
// entities: what comes out of it
// is within its range.
#include "vector/import/svg/data_uri.h"
#include "vector/import/svg/entities.h"
#include "vector/import/svg/media.h"
#include "vector/import/svg/style.h"
#include "vector/import/svg/stylesheet.h"

#include <cmath>
#include <cstdlib>

namespace {
using namespace gpgp::vector::svg;

void check(const Style& style) {
  for (const double part : {style.fillOpacity, style.strokeOpacity, style.opacity, style.stopOpacity})
    if (!(part >= 0 && part <= 1)) std::abort();
  for (const Color& c :
       {style.fill.color, style.stroke.color, style.color, style.stopColor.color, style.background.color.color})
    for (const double part : {c.r, c.g, c.b, c.a})
      if (!(part >= 0 && part <= 1)) std::abort();
  if (!(style.strokeWidth >= 0 && style.miterLimit >= 1 && style.fontSize >= 0)) std::abort();
  double sum = 0;
  for (const double dash : style.dashes)
    if (sum += dash; !(dash >= 0)) std::abort();
  if (style.dashes.size() % 2 || (!style.dashes.empty() && !(sum > 0 && std::isfinite(sum)))) std::abort();
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Reporter quiet(nullptr, nullptr, "");
  StyleSheet sheet;
  sheet.parse(text, {}, quiet, [](std::string_view uri, const Place& place) {
    if (uri.empty() || !(place.line > 0 && place.column > 0)) std::abort();
  });
  (void)evaluateMedia(text);
  if (percentDecoded(text).size() > size || decodeDataUri(text).size() > size) std::abort();
  Style style;
  const Style parent;
  size_t work = 0;
  const auto apply = [&](const Declaration& d) {
    if (applyProperty(style, parent, d.name, d.value, {}) == Applied::Unknown && isPresentationAttribute(d.name) &&
        !isUnsupported(d.name, {}))
      std::abort();
    (void)isUnsupported(d.name, d.value);
    (void)isUnsupportedOnRoot(d.name, d.value);
    (void)hasUnsupported(d.value);
    check(style);
  };
  Document document;
  constexpr std::string_view kDrawing =
      "<svg><g id='b' class='a st0'/><g id='c' x='1'><path id='a' class='a b st0 st1' d='M0 0' "
      "style='fill:red'/></g></svg>";
  if (!document.load(std::as_bytes(std::span(kDrawing)))) std::abort();
  for (const Declaration* d : sheet.match(document, document.find("#a"), work, 1 << 20)) apply(*d);
  for (const Declaration& d : parseDeclarations(text)) apply(d);
  for (const char* name : {"fill", "stroke", "opacity", "stroke-width", "stroke-dasharray", "stroke-miterlimit",
                           "font-size", "font", "stop-color", "paint-order", "clip-path", "marker", "background",
                           "background-color", "display", "overflow", "vector-effect"})
    apply({name, std::string(text), false});
  check(style.inherited());
  std::string expanded(text);
  constexpr size_t kMax = 1 << 16;
  if (expandEntities(expanded, kMax) && expanded.size() > std::max(kMax, size)) std::abort();
  return 0;
}
