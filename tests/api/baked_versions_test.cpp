// Each baked format names its version; a library that reads another one says both and what to do. Only the version is
// changed here, so whoever checks a checksum first, or reads on, does not pass.
#include "../device_test.h"

#include <gpgp/gpgp.hpp>

#include <cstring>

namespace gpgp::test {
namespace {

struct BakedVersions : DeviceTest {
  /// Loads the bytes as they are, then with each other version, which is the second word of all formats.
  template <class Asset, class Info> void check(const Blob& blob, const char* doWhat) {
    const auto create = [this](const std::vector<char>& data) {
      auto info = init<Info>();
      info.data = data.data();
      info.size = data.size();
      return Asset::create(context, info).code();
    };
    std::vector<char> bytes(static_cast<const char*>(blob.data()), static_cast<const char*>(blob.data()) + blob.size());
    EXPECT_EQ(create(bytes), GPGP_SUCCESS) << lastMessage();
    uint32_t version = 0;
    std::memcpy(&version, bytes.data() + 4, 4);
    EXPECT_GT(version, 0u);
    EXPECT_LT(version, 1000u);
    for (const uint32_t other : {version - 1, version + 1, 0xffffffffu}) {
      std::memcpy(bytes.data() + 4, &other, 4);
      EXPECT_EQ(create(bytes), GPGP_ERROR_INVALID_DATA);
      for (const std::string& part :
           std::vector<std::string>{" " + std::to_string(other), "reads", " " + std::to_string(version), doWhat})
        EXPECT_NE(lastMessage().find(part), std::string::npos) << lastMessage() << "\n  does not say: " << part;
    }
  }
};

TEST_F(BakedVersions, Drawing) {
  const char text[] =
      R"(<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><rect width="5" height="4"/></svg>)";
  for (const GpgpDrawingMethods methods : {GPGP_DRAWING_FLATTENED, GPGP_DRAWING_IN_PASS}) {
    auto source = init<GpgpSvgSource>();
    source.name = "a.svg";
    source.data = text;
    source.size = sizeof text - 1;
    source.methods = methods;
    check<Drawing, GpgpDrawingCreateInfo>(*compileSvg(source), "bake it again");
  }
}

TEST_F(BakedVersions, Glyphs) {
  const GpgpPathVerb verbs[] = {GPGP_PATH_MOVE, GPGP_PATH_LINE, GPGP_PATH_LINE};
  const float points[] = {0, 0, 1, 0, 0, 1};
  GpgpPath path{};
  path.verbs = verbs;
  path.verbCount = path.pointCount = 3;
  path.points = points;
  path.color[3] = 1;
  GpgpGlyph glyph{};
  glyph.key = 7;
  glyph.paths = &path;
  glyph.pathCount = 1;
  auto source = init<GpgpGlyphSource>();
  source.name = "a font";
  source.glyphs = &glyph;
  source.glyphCount = 1;
  GpgpBlob raw{};
  ASSERT_EQ(gpgpCompileGlyphs(&source, &raw), GPGP_SUCCESS);
  check<GlyphSet, GpgpGlyphSetCreateInfo>(Blob(raw), "bake them again");
}

/// A text's source whose messages go into `why`.
template <class Source, size_t size> Source sourceOf(const char* name, const char (&text)[size], std::string& why) {
  auto source = init<Source>();
  source.name = name;
  source.text = text;
  source.size = size - 1;
  source.messageUserData = &why;
  source.messageFn = [](void* user, const GpgpCompileMessage* m) { *static_cast<std::string*>(user) += m->text; };
  return source;
}

TEST_F(BakedVersions, Grammar) {
  std::string why;
  const auto blob =
      compileGrammar(sourceOf<GpgpGrammarSource>("a.pga", "axiom Box A; terminal Solid (1, 0); A = Solid;", why));
  ASSERT_TRUE(blob) << why;
  check<gpgp::Grammar, GpgpGrammarCreateInfo>(*blob, "bake it again");
}

TEST_F(BakedVersions, Lsystem) {
  std::string why;
  const auto blob = compileLsystem(sourceOf<GpgpLsystemSource>("a.lsys", "axiom: F\niterations: 2\nF --> FF\n", why));
  ASSERT_TRUE(blob) << why;
  check<gpgp::Lsystem, GpgpLsystemCreateInfo>(*blob, "compile it again");
}

} // namespace
} // namespace gpgp::test
