// The page's part on properties: what a declaration changes.
#include "svg_support.h"

namespace gpgp::test::support {
namespace {

struct PropertyCase {
  const char *name, *value;
  const std::string* subject; ///< with a place for a style, which is "@"
};

} // namespace

std::string properties() {
  static const std::string
      block = "<rect x='20' y='20' width='60' height='60' @/>",
      stroke = "<path d='M20 80L50 20L80 80' fill='none' stroke='red' stroke-width='9' @/>",
      dashed = "<path d='M20 80L50 20' stroke='red' stroke-dasharray='9 5' @/>",
      bare = "<path d='M10 10H70V60H30V30H90V90H10Z' @/>", bordered = kBlock + "@/>",
      text = "<text y='50' @>a  VV</text>", inner = "<text y='50'>a<tspan @>b</tspan></text>",
      vertical = "<text x='50' writing-mode='tb' @>a</text>",
      server = painted("<linearGradient id='p' @>" + kStops + "</linearGradient>"),
      end = painted("<linearGradient id='p'><stop/><stop offset='1' @/></linearGradient>"),
      faint = "<g @><rect width='9' height='9'/><rect x='5' width='9' height='9'/></g>",
      clip = "<clipPath id='c'><path d='M10 10H90V90H10ZM30 30H70V70H30Z' @/></clipPath>" + kBlock +
             "clip-path='url(#c)'/>",
      referring = "<clipPath id='c'><path d='M0 0h50v50'/></clipPath><mask id='m'><path d='M0 0h50v50' "
                  "fill='#fff'/></mask>" +
                  kBlock + "@/>",
      masking = "<mask id='m' @><path d='M0 0h50v50' fill='#fff'/></mask>" + kBlock + "mask='url(#m)'/>",
      flood = filtered("<feFlood @/>"), light = filtered("<feDiffuseLighting @><feDistantLight/></feDiffuseLighting>"),
      colour = filtered("<feOffset @/>"), image = "<image width='9' height='9' " + kImage + "@/>",
      markers = "<marker id='m'><path d='M0 0h3v3'/></marker><path d='M0 0L9 9L20 9' @/>",
      current = "<path d='M0 0h9v9' fill='currentColor' @/>",
      inside = "<svg width='9' height='9' @><path d='M0 0h99v9'/></svg>", shape = "<rect width='9' height='9' @/>",
      round = "<circle r='9' @/>", path = "<path d='M0 0h9v9' @/>",
      mixed =
          "<rect width='90' height='90' fill='red'/><g><rect width='9' height='9' style='mix-blend-mode:screen'/></g>"
          "<g @><rect width='9' height='9' style='mix-blend-mode:screen'/></g>";
  const PropertyCase all[] = {
      {"all", "unset", &bordered},
      {"alignment-baseline", "middle", &inner},
      {"animation", "a 3s", &block},
      {"backdrop-filter", "blur(3px)", &block},
      {"baseline-shift", "super", &inner},
      {"clip", "rect(0 1px 1px 0)", &inside},
      {"clip-path", "url(#c)", &referring},
      {"clip-rule", "evenodd", &clip},
      {"color", "red", &current},
      {"color-interpolation", "linearRGB", &server},
      {"color-interpolation-filters", "linearRGB", &colour},
      {"color-rendering", "optimizeSpeed", &block},
      {"cursor", "pointer", &block},
      {"cx", "5px", &round},
      {"cy", "5px", &round},
      {"d", "path(\"M0 0h5v5\")", &path},
      {"direction", "rtl", &text},
      {"display", "none", &block},
      {"dominant-baseline", "middle", &text},
      {"enable-background", "new", &block},
      {"fill", "red", &block},
      {"fill-opacity", ".5", &block},
      {"fill-rule", "evenodd", &bare},
      {"filter", "blur(3px)", &block},
      {"flood-color", "red", &flood},
      {"flood-opacity", ".5", &flood},
      {"font", "italic 9px a", &text},
      {"font-family", "a", &text},
      {"font-feature-settings", "'smcp'", &text},
      {"font-kerning", "none", &text},
      {"font-palette", "dark", &text},
      {"font-size", "9px", &text},
      {"font-size-adjust", ".5", &text},
      {"font-stretch", "condensed", &text},
      {"font-style", "italic", &text},
      {"font-variant", "small-caps", &text},
      {"font-variant-caps", "small-caps", &text},
      {"font-variant-ligatures", "none", &text},
      {"font-variation-settings", "'wght' 300", &text},
      {"font-weight", "bold", &text},
      {"glyph-orientation-horizontal", "90", &text},
      {"glyph-orientation-vertical", "0", &vertical},
      {"height", "5px", &shape},
      {"image-rendering", "pixelated", &image},
      {"inline-size", "50px", &text},
      {"isolation", "isolate", &mixed},
      {"kerning", "0", &text},
      {"letter-spacing", "5px", &text},
      {"lighting-color", "red", &light},
      {"marker", "url(#m)", &markers},
      {"marker-end", "url(#m)", &markers},
      {"marker-mid", "url(#m)", &markers},
      {"marker-start", "url(#m)", &markers},
      {"mask", "url(#m)", &referring},
      {"mask-border", "url(a.png)", &block},
      {"mask-image", "url(a.png)", &block},
      {"mask-type", "alpha", &masking},
      {"mix-blend-mode", "screen", &block},
      {"offset-path", "path('M0 0h9')", &block},
      {"opacity", ".5", &faint},
      {"overflow", "visible", &inside},
      {"paint-order", "stroke", &bordered},
      {"perspective", "9px", &block},
      {"pointer-events", "none", &block},
      {"r", "5px", &round},
      {"rotate", "9deg", &block},
      {"rx", "3px", &shape},
      {"ry", "3px", &shape},
      {"scale", "2", &block},
      {"shape-inside", "url(#a)", &text},
      {"shape-rendering", "crispEdges", &block},
      {"stop-color", "red", &end},
      {"stop-opacity", ".5", &end},
      {"stroke", "red", &block},
      {"stroke-dasharray", "9 5", &stroke},
      {"stroke-dashoffset", "5", &dashed},
      {"stroke-linecap", "round", &stroke},
      {"stroke-linejoin", "bevel", &stroke},
      {"stroke-miterlimit", "1", &stroke},
      {"stroke-opacity", ".5", &stroke},
      {"stroke-width", "5", &stroke},
      {"text-anchor", "end", &text},
      {"text-combine-upright", "all", &vertical},
      {"text-decoration", "underline", &text},
      {"text-indent", "5px", &text},
      {"text-orientation", "upright", &vertical},
      {"text-overflow", "ellipsis", &text},
      {"text-rendering", "optimizeSpeed", &text},
      {"text-shadow", "1px 1px red", &text},
      {"text-transform", "uppercase", &text},
      {"transform", "scale(2)", &block},
      {"transform-box", "fill-box", &shape},
      {"transform-origin", "5px 5px", &block},
      {"translate", "5px", &block},
      {"unicode-bidi", "bidi-override", &inner},
      {"vector-effect", "non-scaling-stroke", &stroke},
      {"visibility", "hidden", &block},
      {"white-space", "pre", &text},
      {"white-space-collapse", "preserve", &text},
      {"width", "5px", &shape},
      {"will-change", "transform", &block},
      {"word-spacing", "5px", &text},
      {"writing-mode", "vertical-rl", &text},
      {"x", "5px", &shape},
      {"y", "5px", &shape},
      {"zoom", "2", &block},
  };
  Row row;
  for (const PropertyCase& p : all) {
    std::string quoted;
    for (const char c : std::string(p.value)) quoted += c == '\'' ? std::string("&apos;") : std::string(1, c);
    const bool isTurned = std::string(p.name) == "transform-origin" || std::string(p.name) == "transform-box";
    const std::string before = isTurned                                 ? "transform:rotate(9deg);"
                               : std::string(p.name) == "vector-effect" ? "transform:scale(2);"
                                                                        : "";
    const std::string origin = std::string(p.name) == "transform-box" ? "transform-origin:50% 50%;" : "";
    const std::string base = "style='" + before + origin;
    const Drawn without = drawn(replaced(*p.subject, base + "'")),
                with = drawn(replaced(*p.subject, base + p.name + ":" + quoted + "'"));
    SCOPED_TRACE(p.name);
    row.of[static_cast<size_t>(outcomeOf(p.name, with, without))].insert(p.name);
  }
  return wrapped("- Drawn: " + listed(row.of[0]) + ".") + wrapped("- Named: " + listed(row.of[1]) + ".") +
         wrapped("- Without effect on a still picture: " + listed(row.of[2]) + ".");
}

} // namespace gpgp::test::support
