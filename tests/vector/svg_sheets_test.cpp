// Style sheets wherever they are: in elements, instructions and files; what they import, and for which media they are.
#include "svg_import.h"
#include "vector/import/svg/media.h"

#include <gtest/gtest.h>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using vector::svg::Media;

using Texts = std::vector<std::string>;

/// A drawing of one rectangle of class a behind `before` and around `inside`, with files beside it.
Import sheeted(const std::string& before, const std::string& inside, const TextFiles& files,
               const vector::svg::ImportLimits& limits = {}) {
  const GpgpFileSystem system = files.fileSystem();
  return import(before + "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'>" + inside +
                    "<rect class='a' width='9' height='9'/></svg>",
                limits, 1, &system);
}
/// Its colour: 'r', 'g', 'b' or 'k'; '?' where there is another.
char colorOf(const Import& i) {
  if (i.drawing.paths.size() != 1) return '?';
  const auto& c = i.drawing.paths[0].color;
  const int bits = (c[0] > 0.9f) + 2 * (c[1] > 0.9f) + 4 * (c[2] > 0.9f);
  return bits == 1 ? 'r' : bits == 2 ? 'g' : bits == 4 ? 'b' : bits == 0 ? 'k' : '?';
}

const std::string kLink = "<link xmlns='http://www.w3.org/1999/xhtml' ";

TEST(SvgSheets, InstructionsAndLinksReadFiles) {
  const TextFiles files{{"red.css", ".a{fill:#f00}"}, {"sub/lime.css", "\xef\xbb\xbf.a{fill:lime}"}};
  const struct {
    const char* before;
    std::string inside;
    char color;
  } cases[] = {
      {"<?xml-stylesheet href='red.css' type='text/css'?>", "", 'r'},
      {"<?xml version='1.0'?>\n<?xml-stylesheet type=\"text/css\" href=\"./sub/../red.css?v=1&amp;w=2\"?>\n", "", 'r'},
      {"<?xml-stylesheet href='red.css'?><!-- a -->", "", 'r'},
      {"<?xml-stylesheet href='red.css' media='print'?>", "", 'k'},
      {"<?xml-stylesheet href='red.css' alternate='yes' title='a'?>", "", 'k'},
      {"<?other href='red.css'?>", "", 'k'},
      {"", kLink + "rel='stylesheet' href='sub/lime.css'/>", 'g'},
      {"", kLink + "rel='Stylesheet' type='TEXT/CSS;charset=utf-8' href='sub%2Flime.css'/>", 'g'},
      {"", "<defs xmlns:h='http://www.w3.org/1999/xhtml'><h:link rel='stylesheet' href='red.css'/></defs>", 'r'},
      {"", kLink + "rel='icon' href='sub/lime.css'/>", 'k'},
      {"", kLink + "rel='alternate stylesheet' href='sub/lime.css'/>", 'k'},
      {"", kLink + "rel='stylesheet' media='print' href='sub/lime.css'/>", 'k'},
      {"", "<style xmlns='http://www.w3.org/1999/xhtml'>.a{fill:blue}</style>", 'b'},
      {"", kLink + "rel='stylesheet' href='data:text/css,.a%7bfill:red%7d'/>", 'r'},
      {"", kLink + "rel='stylesheet' href='data:text/css;base64,LmF7ZmlsbDpyZWR9'/>", 'r'},
      // In the order in which they stand.
      {"<?xml-stylesheet href='red.css'?>", "<style>.a{fill:blue}</style>", 'b'},
      {"<?xml-stylesheet href='red.css'?>", kLink + "rel='stylesheet' href='sub/lime.css'/>", 'g'},
      {"<?xml-stylesheet href='red.css'?><?xml-stylesheet href='sub/lime.css'?>", "", 'g'},
      {"", "<style>.a{fill:blue}</style>" + kLink + "rel='stylesheet' href='red.css'/>", 'r'},
      {"", kLink + "rel='stylesheet' href='red.css'/><style>.a{fill:blue}</style>", 'b'},
      {"", "<style>.a{fill:blue !important}</style>" + kLink + "rel='stylesheet' href='red.css'/>", 'b'},
  };
  for (const auto& c : cases) {
    const Import i = sheeted(c.before, c.inside, files);
    EXPECT_EQ(colorOf(i), c.color) << c.before << c.inside;
    EXPECT_EQ(i.placed, Texts()) << c.before << c.inside;
  }
}

TEST(SvgSheets, ImportsComeFirstAndAreRelativeToTheirSheet) {
  const TextFiles files{{"sub/a.css", "@import 'b.css'; .b{fill:red}"},
                        {"sub/b.css", ".a{fill:lime}"},
                        {"sub/up.css", "@import url( '../top.css' );"},
                        {"top.css", ".a{fill:blue}"},
                        {"twice.css", "@charset 'utf-8';@import 'top.css';@import 'sub/b.css';@import 'top.css';"}};
  for (const auto& [sheet, color] : std::initializer_list<std::pair<const char*, char>>{
           {"@import url(sub/a.css);", 'g'},
           {"@IMPORT \"sub/up.css\" all;", 'b'},
           {"@import 'twice.css';", 'b'},
           {"@import 'sub/a.css';.a{fill:red}", 'r'}, // what is imported stands before
           {"@import 'sub/a.css' print;", 'k'},
           {"@import 'sub/a.css' screen and (prefers-color-scheme:light);", 'g'},
           {"/* a */ @charset 'a'; /* b */ @import 'sub/a.css'", 'g'},
       }) {
    const Import i = sheeted("", std::string("<style>") + sheet + "</style>", files);
    EXPECT_EQ(colorOf(i), color) << sheet;
    EXPECT_EQ(i.placed, Texts()) << sheet;
  }
}

TEST(SvgSheets, BlocksForMediaCountWhereTheyAreOurs) {
  for (const auto& [sheet, color] : std::initializer_list<std::pair<const char*, char>>{
           {"@media screen {.a{fill:red}}", 'r'},
           {"@media all{.a{fill:red}}.b{}", 'r'},
           {"@media {.a{fill:red}}", 'r'},
           {"@media print {.a{fill:red}}", 'k'},
           {"@media not print {.a{fill:red}}", 'r'},
           {"@media (prefers-color-scheme: dark) {.a{fill:red}} .b{}", 'k'},
           {".a{fill:blue} @media (prefers-color-scheme:DARK) {.a{fill:red}}", 'b'},
           {".a{fill:blue} @media screen{@media (color){.a{fill:red}}@media print{.a{fill:lime}}}", 'r'},
           {"@media screen{.a{fill:red}} .a{fill:blue}", 'b'},
           {"@namespace 'http://www.w3.org/2000/svg'; .a{fill:red}", 'r'},
       }) {
    const Import i = sheeted("", std::string("<style>") + sheet + "</style>", {});
    EXPECT_EQ(colorOf(i), color) << sheet;
    EXPECT_EQ(i.placed, Texts()) << sheet;
  }
}

TEST(SvgSheets, MediaQueries) {
  for (const auto& [query, is] : std::initializer_list<std::pair<const char*, Media>>{
           {"", Media::Yes},
           {" ALL ", Media::Yes},
           {"screen", Media::Yes},
           {"only screen", Media::Yes},
           {"not screen", Media::No},
           {"print", Media::No},
           {"print, screen", Media::Yes},
           {"hologram", Media::No},
           {"screen and (color)", Media::Yes},
           {"screen and (color) and (monochrome)", Media::No},
           {"not screen and (monochrome)", Media::Yes},
           {"(prefers-color-scheme: light)", Media::Yes},
           {"(prefers-color-scheme:dark)", Media::No},
           {"(prefers-reduced-motion)", Media::No},
           {"(prefers-reduced-motion: no-preference)", Media::Yes},
           {"(min-width: 100px)", Media::Unknown},
           {"not (min-width: 100px)", Media::Unknown},
           {"print and (min-width: 100px)", Media::No},
           {"screen, (min-width: 100px)", Media::Yes},
           {"print, (min-width: 100px)", Media::Unknown},
           {"(color) or (monochrome)", Media::Unknown},
           {"((color))", Media::Unknown},
           {"screen and", Media::Unknown},
           {"screen (color)", Media::Unknown},
           {"(color", Media::Unknown},
           {",", Media::No},
       })
    EXPECT_EQ(vector::svg::evaluateMedia(query), is) << query;
}

TEST(SvgSheets, WhatIsNotReadIsNamedWithItsPlace) {
  const TextFiles files{{"sub/bad.css", "\n  .a::before {fill:red}\n@media screen {\n @font-face {} }"},
                        {"self.css", "@import 'other.css';"},
                        {"other.css", "\n @import 'self.css';"},
                        {"late.css", ".a{fill:red} @import 'self.css';"}};
  const std::string before = "the style sheet '", after = "; it does not count";
  const struct {
    std::string inside, message;
  } cases[] = {
      {"<style>\n @import 'https://a.b/c.css';</style>",
       "test.svg:2:2: warning: " + before +
           "https://a.b/c.css' is not beside the drawing, and other places are not read"},
      {"<style>@import url(//a.b/c.css);</style>",
       "test.svg:1:73: warning: " + before + "//a.b/c.css' is not beside the drawing, and other places are not read"},
      {"<style>@import 'file:///c.css';</style>",
       "test.svg:1:73: warning: " + before + "file:///c.css' is not beside the drawing, and other places are not read"},
      {"<style>@import 'C:/c.css';</style>",
       "test.svg:1:73: warning: " + before + "C:/c.css' is not beside the drawing, and other places are not read"},
      {"<style>@import '/etc/c.css';</style>",
       "test.svg:1:73: warning: " + before +
           "/etc/c.css' has an absolute path, and only paths from the drawing's folder are read"},
      {"<style>@import 'sub/../../c.css';</style>",
       "test.svg:1:73: warning: " + before +
           "sub/../../c.css' leads out of the drawing's folder, where nothing is read"},
      {"<style>@import '%2e%2e/c.css';</style>",
       "test.svg:1:73: warning: " + before + "%2e%2e/c.css' leads out of the drawing's folder, where nothing is read"},
      {"<style>@import '..\\\\c.css';</style>",
       "test.svg:1:73: warning: " + before + "..\\c.css' leads out of the drawing's folder, where nothing is read"},
      {"<style>@import '#a';</style>", "test.svg:1:73: warning: " + before + "#a' is not a file"},
      {"<style>@import 'no.css';</style>", "test.svg:1:73: warning: " + before + "no.css' cannot be read"},
      {"<style>@import 'self.css';</style>", "other.css:2:2: warning: " + before + "self.css' imports itself"},
  };
  for (const auto& c : cases) EXPECT_EQ(sheeted("", c.inside, files).placed, Texts{c.message + after}) << c.inside;
  EXPECT_EQ(sheeted("", "<style>@import 'sub/bad.css';</style>", files).placed,
            (Texts{"sub/bad.css:2:3: warning: style selector '.a::before' is not supported",
                   "sub/bad.css:4:2: warning: style rule @font-face is not supported"}));
  EXPECT_EQ(sheeted("", "<style>@import 'late.css';</style>", files).placed,
            Texts{"late.css:1:14: warning: style rule @import does not stand before all others; ignored"});
  EXPECT_EQ(sheeted("", "<style>@import foo;</style>", files).placed,
            Texts{"test.svg:1:73: warning: style rule @import has 'foo', which is not an address; ignored"});
  EXPECT_EQ(
      sheeted("", "<style>@import 'a.css' layer(b);</style>", files).placed,
      Texts{"test.svg:1:73: warning: style rule @import has the condition 'layer(b)', which is not supported: its "
            "style sheet does not count"});
  EXPECT_EQ(sheeted("", "<style>@media (min-width:9px) {.a{fill:red}}</style>", files).placed,
            Texts{"test.svg:1:73: warning: style rule @media has the condition '(min-width:9px)', which is not "
                  "supported: its contents are ignored"});
  EXPECT_EQ(sheeted("", "<style>@supports fill:red {.a{fill:red}}</style>", files).placed,
            Texts{"test.svg:1:73: warning: style rule @supports has 'fill:red', which is not a condition; its contents "
                  "are ignored"});
  EXPECT_EQ(sheeted("\n <?xml-stylesheet href='a.xsl' type='text/xsl'?>", "", files).placed,
            Texts{"test.svg:2:2: warning: <?xml-stylesheet?> of type 'text/xsl' is not supported"});
  EXPECT_EQ(sheeted("<?xml-stylesheet type='text/css'?>", "", files).placed,
            Texts{"test.svg:1:1: warning: <?xml-stylesheet?> has no href; ignored"});
  EXPECT_EQ(sheeted("", kLink + "rel='stylesheet'/>", files).placed,
            Texts{"test.svg:1:66: warning: <link> has no href; ignored"});
  EXPECT_EQ(import("<?xml-stylesheet href='a.css'?><svg/>").placed,
            Texts{"test.svg:1:1: warning: " + before + "a.css' is another file, and no files are read here" + after});
}

TEST(SvgSheets, ConditionsAskForWhatIsDrawn) {
  const char* const hold[] = {"(fill: red)",
                              "(transform: rotate(30deg))",
                              "(--a: b)",
                              "(fill: var(--a))",
                              "not (display: foo)",
                              "(fill: red) and (stroke: #00f)",
                              "(foo: bar) or (fill: red)",
                              "((foo: bar) or (fill: red)) and (not (a: b))",
                              "selector(a > b)",
                              "not (backdrop-filter: blur(3px))",
                              "not (text-shadow: 1px 1px red)",
                              "not (clip-path: circle(3px))",
                              "not font-tech(color-COLRv1)",
                              "(clip-path: url(#a))",
                              "(fill: red !important)",
                              "(width: 3px)",
                              "NOT (a: b)"};
  const char* const fail[] = {"(foo: bar)",
                              "(fill: foo)",
                              "not (fill: red)",
                              "(fill: red) and (a: b)",
                              "(a: b) or (c: d)",
                              "selector(a::before)",
                              "font-tech(a)",
                              "(fill)",
                              "(fill:)",
                              "(transform: turn(3))",
                              "(width: wide)",
                              "not(fill: foo)",
                              "()",
                              "(image-rendering: pixelated)"};
  for (const bool holds : {true, false})
    for (const char* condition : holds ? std::span<const char* const>(hold) : std::span<const char* const>(fail)) {
      const Import i = sheeted("", "<style>@supports " + std::string(condition) + " {.a{fill:red}}</style>", {});
      EXPECT_EQ(colorOf(i) == 'r', holds) << condition;
      EXPECT_EQ(i.placed, Texts()) << condition;
    }
  for (const char* condition : {"", "fill: red", "(a: b) (c: d)", "(a: b) and (c: d) or (e: f)", "(fill: red", "not"})
    EXPECT_EQ(sheeted("", "<style>@supports " + std::string(condition) + " {.a{fill:red}}</style>", {}).placed.size(),
              1u)
        << condition;
  std::string deep = "(fill: red)";
  for (int k = 0; k < 100; ++k) deep = "(" + deep + ")";
  EXPECT_EQ(sheeted("", "<style>@supports " + deep + " {.a{fill:red}}</style>", {}).placed.size(), 1u);
  const TextFiles files{{"a.css", ".a{fill:#f00}"}};
  EXPECT_EQ(colorOf(sheeted("", "<style>@import 'a.css' supports(fill: red);</style>", files)), 'r');
  EXPECT_EQ(colorOf(sheeted("", "<style>@import 'a.css' supports((fill: red)) screen;</style>", files)), 'r');
  EXPECT_NE(colorOf(sheeted("", "<style>@import 'a.css' supports(fill: foo);</style>", files)), 'r');
  EXPECT_NE(colorOf(sheeted("", "<style>@import 'a.css' supports(fill: red) print;</style>", files)), 'r');
}

TEST(SvgSheets, TheirPlacesAreTheText) {
  EXPECT_EQ(import("<svg><style>\n<![CDATA[\n  a:b {}\n]]></style>\n<style>c:d {}</style></svg>").placed,
            (Texts{"test.svg:3:3: warning: style selector 'a:b' is not supported",
                   "test.svg:5:8: warning: style selector 'c:d' is not supported"}));
}

TEST(SvgSheets, RulesInsideOfOthersAreNamed) {
  const Import i = sheeted("", "<style>.a { fill:red; &:hover { fill:blue } } </style>", {});
  EXPECT_EQ(colorOf(i), 'r');
  EXPECT_EQ(i.placed, Texts{"test.svg:1:120: warning: <rect> has the declaration '&:hover { fill:blue }', which is not "
                            "supported; ignored"});
}

TEST(SvgSheets, MarkersThatAreTakenBackAreNotNamed) {
  EXPECT_EQ(page("<g marker-end='url(#m)'><path d='M0 0h9v9' marker='url(#n)' style='marker:none'/></g>").placed,
            Texts());
  EXPECT_EQ(page("<g style='marker:url(#m)'><path d='M0 0h9v9' marker-end='none'/></g>").placed.size(), 1u);
  EXPECT_EQ(page("<path d='M0 0h9v9' marker='url(#m)'/>").placed, Texts()); // a shorthand is no attribute
}

TEST(SvgSheets, TheyAreBounded) {
  // A tree of imports, each of two others; and one that is long.
  TextFiles files;
  for (int i = 0; i < 30; ++i) {
    std::string next = "'";
    next.append(std::to_string(i + 1)).append(".css';");
    files[std::to_string(i) + ".css"] = "@import " + next + "@import " + next;
  }
  files["long.css"] = std::string(".a{fill:red}") + std::string(size_t(17) << 20, ' ');
  files["half.css"] = std::string(".a{fill:red}") + std::string(size_t(9) << 20, ' ');
  const Import tree = sheeted("", "<style>@import '0.css';</style>", files);
  EXPECT_FALSE(tree.placed.empty());
  EXPECT_LE(tree.placed.size(), 130u);
  EXPECT_EQ(
      sheeted("", "<style>@import 'long.css';</style>", files).placed,
      Texts{"test.svg:1:73: warning: the style sheet 'long.css' makes more than the 16777216 bytes that are read of "
            "style sheets; it does not count"});
  const Import halves = sheeted("", "<style>@import 'half.css';@import 'half.css';</style>", files);
  EXPECT_EQ(halves.placed.size(), 1u);
  EXPECT_EQ(colorOf(halves), 'r');
  std::string deep;
  for (int i = 0; i < 40; ++i) deep += "@media screen{";
  EXPECT_EQ(sheeted("", "<style>" + deep + "</style>", files).placed.size(), 1u);
}

TEST(SvgSheets, ImagesLieBesideTheDrawingAsWell) {
  const TextFiles files{{"a.png", "A"}, {"below/b c.png", "B"}, {"empty.png", ""}};
  const GpgpFileSystem system = files.fileSystem();
  struct Seen {
    std::string bytes;
    Texts messages;
  };
  const auto drawn = [&](const std::string& href, bool hasFiles = true) {
    Seen seen;
    vector::svg::Reporter reporter(
        [](void* user, const GpgpMessage* m) { static_cast<Seen*>(user)->messages.push_back(withLine(placed(*m))); },
        &seen, "test.svg");
    const auto decode = [](void* user, uint32_t, const void* data, size_t size, uint32_t* width,
                           uint32_t* height) -> VkBool32 {
      static_cast<Seen*>(user)->bytes.append(static_cast<const char*>(data), size);
      return *width = *height = 4, VK_TRUE;
    };
    const std::string text = "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><image href='" + href +
                             "' width='9' height='9'/><image href='" + href + "' width='4' height='4'/></svg>";
    const auto drawing = vector::svg::importSvg(std::as_bytes(std::span(text)), reporter, {}, {decode, &seen}, {},
                                                hasFiles ? &system : nullptr);
    EXPECT_EQ(drawing->paths.size(), seen.messages.empty() ? 2u : 0u) << href;
    return seen;
  };
  EXPECT_EQ(drawn("a.png").bytes, "A"); // once
  EXPECT_EQ(drawn("./below/../below/b%20c.png?x#y").bytes, "B");
  const std::pair<const char*, const char*> refused[] = {
      {"../a.png", "leads out of the drawing's folder, where nothing is read"},
      {"below/../../a.png", "leads out of the drawing's folder, where nothing is read"},
      {"/a.png", "has an absolute path, and only paths from the drawing's folder are read"},
      {"http://host/a.png", "is not beside the drawing, and other places are not read"},
      {"//host/a.png", "is not beside the drawing, and other places are not read"},
      {"C:a.png", "is not beside the drawing, and other places are not read"},
      {"no.png", "cannot be read"}};
  for (const auto& [href, why] : refused) {
    const Seen seen = drawn(href);
    EXPECT_EQ(seen.bytes, "") << href;
    ASSERT_FALSE(seen.messages.empty()) << href;
    EXPECT_EQ(seen.messages[0], "line 1: <image> '" + std::string(href) + "' " + why + "; it is not drawn");
  }
  EXPECT_EQ(drawn("a.png", false).messages[0],
            "line 1: <image> 'a.png' is another file, and no files are read here; it is not drawn");
  EXPECT_EQ(drawn("empty.png").messages[0], "line 1: <image> holds nothing that can be decoded; not supported");
}

} // namespace
