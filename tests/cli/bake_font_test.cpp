// `gpgp bake` of fonts: which glyphs chosen characters take with them, what is told of them, and bad input. That they
// are drawn as live ones are: tests/vector/text/gpu_test.cpp.
#include "files.h"
#include "run.h"

namespace gpgp::test {
namespace {

std::string font(const std::string& name) { return std::string(GPGP_TEST_DATA) + "/fetched/fonts/" + name; }

struct CliBakeFont : testing::Test {
  void SetUp() override {
    if (!std::filesystem::exists(font("NotoColorEmoji.ttf")))
      GTEST_SKIP() << "needs fonts: tests/data/fetch.sh --only fonts";
  }
  const std::string sans = font("DejaVuSans.ttf");
  const TemporaryFile out{std::string("font.gpgpf")};
  std::vector<std::string> command(std::vector<std::string> more, const std::string& file = {}) const {
    more.insert(more.begin(), {"bake", file.empty() ? sans : file, "-o", out.path()});
    return more;
  }
  json bake(const std::vector<std::string>& more, const std::string& file = {}) const {
    const json told = gpgpJson(command(more, file));
    return told["baked"][0];
  }
};

TEST_F(CliBakeFont, CharactersRangesAndFilesAddUp) {
  const json letters = bake({"--characters", "fi"});
  EXPECT_EQ(keys(letters),
            (std::set<std::string>{"in", "type", "out", "bytes", "glyphs", "missing", "pictures", "broken"}));
  EXPECT_EQ(letters["type"], "font");
  EXPECT_EQ(host::readText(out.path()).size(), letters["bytes"].get<size_t>());
  const std::string once = host::readText(out.path());
  // f, i, dotless i and what GSUB makes of them, the missing glyph, and what layouts add; not the font.
  EXPECT_GT(letters["glyphs"], 8);
  EXPECT_LT(letters["glyphs"], 40);
  // The same in other words gives the same bytes.
  const TemporaryFile text("letters.txt", "\xef\xbb\xbfif\r\nfi\n");
  for (const std::vector<std::string>& same : {std::vector<std::string>{"--ranges", "U+66,u+0069"},
                                               {"--ranges", "0x66", "--ranges", "0x69-69"},
                                               {"--characters", "f", "--characters", "i"},
                                               {"--characters-file", text.path()},
                                               {"--characters", "i", "--ranges", " U+0066-0066 "}}) {
    EXPECT_EQ(bake(same)["glyphs"], letters["glyphs"]);
    EXPECT_TRUE(host::readText(out.path()) == once) << testing::PrintToString(same);
  }
  EXPECT_GT(bake({"--ranges", "U+0020-007E"})["glyphs"], 95 + 4);
  EXPECT_EQ(bake({"--characters", "fi", "--outline", "0.1"})["glyphs"], letters["glyphs"]);
  EXPECT_GT(host::readText(out.path()).size(), once.size() * 3 / 2) << "outlines, too";
}

TEST_F(CliBakeFont, WithoutCharactersAllGlyphsOfTheFace) {
  const std::string thai = font("NotoSansThai-Regular.ttf");
  const json all = bake({}, thai);
  EXPECT_EQ(all["glyphs"], 140) << "as many as the font says";
  EXPECT_LT(bake({"--ranges", "U+0E01-0E05"}, thai)["glyphs"], 40);
  // Axes and faces are other outlines.
  const std::string inter = font("Inter-roman.var.ttf");
  const auto bytes = [&](const std::vector<std::string>& more, const std::string& file) {
    bake(more, file);
    return host::readText(out.path());
  };
  EXPECT_TRUE(bytes({"--characters", "a"}, inter) != bytes({"--characters", "a", "--axes", "wght=700"}, inter));
  const std::string cjk = font("NotoSansCJK-Regular.ttc");
  EXPECT_TRUE(bytes({"--characters", "骨直角"}, cjk) !=
              bytes({"--characters", "骨直角", "--face", "3"}, cjk)); // others share all forms
}

TEST_F(CliBakeFont, WhatIsNotBakedIsSaid) {
  const ProcessResult missing = gpgp(command({"--characters", "aक", "--json"}));
  EXPECT_EQ(missing.exitCode, 0) << missing.err;
  EXPECT_NE(missing.err.find("the font has no U+0915"), std::string::npos) << missing.err;
  EXPECT_EQ(json::parse(missing.out, nullptr, false)["baked"][0]["missing"], json::array({"U+0915"}));
  const ProcessResult pictures = gpgp(command({"--characters", "\U0001F98A", "--json"}, font("NotoColorEmoji.ttf")));
  EXPECT_EQ(pictures.exitCode, 0) << pictures.err;
  EXPECT_NE(pictures.err.find("pictures"), std::string::npos) << pictures.err;
  EXPECT_GE(json::parse(pictures.out, nullptr, false)["baked"][0]["pictures"], 1);
}

TEST_F(CliBakeFont, BadInputIsNamedAndWritesNothing) {
  std::filesystem::remove(out.path());
  const TemporaryFile no("no.ttf", "this is no font"), latin("latin.txt", "caf\xe9");
  EXPECT_NE(gpgpFailure(command({}, no.path())).find("no.ttf"), std::string::npos);
  EXPECT_NE(gpgpFailure(command({"--characters-file", latin.path()})).find("not UTF-8 at byte 3"), std::string::npos);
  EXPECT_NE(gpgpFailure(command({"--characters", "\xed\xa0\x80"})).find("not UTF-8 at byte 0"), std::string::npos);
  EXPECT_NE(gpgpFailure(command({"--face", "3"})).find("face is 3"), std::string::npos);
  EXPECT_NE(gpgpFailure(command({"--axes", "wght=700"})).find("no axis 'wght'"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(out.path()));
  expectWrongUsage({command({"--ranges", "20 to 7e"}), command({"--ranges", "U+7E-20"}),
                    command({"--ranges", "U+110000"}), command({"--ranges", "a-"}), command({"--axes", "wght"}),
                    command({"--axes", "wght=heavy"}), command({"--outline", "2"}), command({"--outline", "nan"}),
                    command({"--face", "-1"}), command({"--characters-file", "no_such_file.txt"})});
  EXPECT_FALSE(std::filesystem::exists(out.path()));
}

} // namespace
} // namespace gpgp::test
