// `gpgp vector` on text in a font that varies.
#include "../vector/text/tiny_font.h"
#include "files.h"
#include "host/picture.h"
#include "run.h"

namespace gpgp::test {
namespace {

TEST(CliVectorFonts, VariableFontsHaveTheWeightThatIsAsked) {
  const std::vector<char> bytes = tinyVariableFont();
  const TemporaryFile font("varies.otf", std::string_view(bytes.data(), bytes.size()));
  const struct {
    const char* weight;
    ptrdiff_t width; // of the pillar, in pixels
  } cases[] = {{"1", 4}, {"normal", 10}, {"900", 30}, {"1000", 30}};
  for (const auto& c : cases) {
    const TemporaryFile file("varies.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'><text "
                                           "y='90' font-size='100' font-weight='" +
                                               std::string(c.weight) + "'>A</text></svg>"),
        out("varies.png");
    gpgpJson({"vector", file.path(), "--font", font.path(), "--out", out.path()});
    const host::Picture drawn = host::readPng(out.path());
    ptrdiff_t inked = 0;
    for (size_t x = 0; x < 100; ++x) inked += drawn.rgba[4 * (60 * 100 + x) + 3] > 127;
    EXPECT_EQ(inked, c.width) << c.weight;
  }
}

} // namespace
} // namespace gpgp::test
