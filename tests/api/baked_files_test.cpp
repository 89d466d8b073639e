// Baked files of every format through the functions that load them: with any bit changed, cut anywhere, with something
// behind them or of another version they are refused with one message, and nothing is made of them.
#include "scenarios.h"

#include <gpgp/gpgp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>

namespace {
using namespace gpgp;
using namespace gpgp::test;

using Bytes = std::vector<char>;
Bytes take(GpgpBlob& blob) {
  Bytes bytes(static_cast<char*>(blob.data), static_cast<char*>(blob.data) + blob.size);
  gpgpFreeBlob(&blob);
  return bytes;
}

struct BakedFiles : testing::Test {
  host::HeadlessDevice& device = sharedDevice();
  std::vector<std::string> messages;
  GpgpContext context = nullptr;

  void SetUp() override {
    const GpgpContextCreateInfo info = scenarioContextInfo(device, &messages);
    ASSERT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
  }
  void TearDown() override {
    gpgpDestroyContext(context);
    for (const std::string& message : device.takeValidationMessages()) ADD_FAILURE() << message;
  }

  using Load = std::function<GpgpResult(const void*, size_t, GpgpAsset*)>;
  template <class Info>
  static Load loads(GpgpContext context, GpgpResult(GPGP_CALL* create)(GpgpContext, const Info*, GpgpAsset*),
                    Info info) {
    return [context, create, info](const void* data, size_t size, GpgpAsset* asset) {
      Info own = info;
      own.data = data;
      own.size = size;
      return create(context, &own, asset);
    };
  }
  void expectRefused(const Load& load, const void* data, size_t size, const char* what, size_t where) {
    GpgpAsset asset = nullptr;
    messages.clear();
    const GpgpResult result = load(data, size, &asset);
    ASSERT_LT(result, 0) << what << " " << where;
    ASSERT_EQ(asset, nullptr) << what << " " << where;
    ASSERT_EQ(messages.size(), 1u) << what << " " << where;
  }
  void expectLoads(const Load& load, const void* data, size_t size) {
    GpgpAsset asset = nullptr;
    messages.clear();
    ASSERT_EQ(load(data, size, &asset), GPGP_SUCCESS) << (messages.empty() ? "" : messages.back());
    gpgpDestroyAsset(asset);
  }

  /// ends: lengths at which a file is whole already, as kernels behind a grammar are no part of it.
  void sweep(const Load& load, const Bytes& good, const std::vector<size_t>& ends = {}) {
    ASSERT_GT(good.size(), 64u);
    expectLoads(load, good.data(), good.size());
    Bytes shifted(good.size() + 1); // a file need not lie where words do
    std::copy(good.begin(), good.end(), shifted.begin() + 1);
    expectLoads(load, shifted.data() + 1, good.size());

    // All of a small file; of what follows in a large one every 2111th bit and 211th length.
    constexpr size_t kWhole = 2048;
    const auto next = [](size_t byte, size_t step) { return byte < kWhole ? size_t(1) : step; };
    Bytes changed = good;
    for (size_t bit = 0; bit < good.size() * 8; bit += next(bit / 8, 2111)) {
      changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ (1 << bit % 8));
      expectRefused(load, changed.data(), changed.size(), "bit", bit);
      if (HasFatalFailure()) return;
      changed[bit / 8] = good[bit / 8];
    }
    for (size_t size = 1; size < good.size(); size += next(size, 211)) {
      if (std::count(ends.begin(), ends.end(), size)) continue;
      const Bytes cut(good.begin(),
                      good.begin() + static_cast<std::ptrdiff_t>(size)); // a sanitizer sees what is beyond
      expectRefused(load, cut.data(), cut.size(), "cut to", size);
      if (HasFatalFailure()) return;
    }
    for (const size_t more : {1u, 3u, 4u, 16u, 64u}) {
      Bytes longer = good;
      longer.resize(good.size() + more, 1);
      expectRefused(load, longer.data(), longer.size(), "longer by", more);
      if (HasFatalFailure()) return;
    }
    uint32_t version = 0;
    std::memcpy(&version, good.data() + 4, 4);
    for (const uint32_t other : {0u, version - 1, version + 1, version + 1000, UINT32_MAX}) {
      if (other == version) continue;
      std::memcpy(changed.data() + 4, &other, 4);
      expectRefused(load, changed.data(), changed.size(), "version", other);
      if (HasFatalFailure()) return;
      for (const uint32_t number : {other, version}) // which it is, and which would be read
        EXPECT_NE(messages[0].find(std::to_string(number)), std::string::npos) << messages[0];
    }
  }
};

#if defined(GPGP_WITH_COMPILER) && defined(GPGP_WITH_SPAWN)
constexpr char kGrammar[] = "axiom Box A; terminal Tower (1, 0); terminal Roof (1, 1);\n"
                            "A = SubDiv(X) { -1: B | -1: B };\n"
                            "B = Replicate() { Tower | Translate(0, 1, 0) Roof };\n";
TEST_F(BakedFiles, Grammars) {
  std::vector<size_t> ends;
  for (const GpgpCompileFlags flags : {GpgpCompileFlags(0), GPGP_COMPILE_KERNEL}) {
    GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
    source.name = "towers.pga";
    source.text = kGrammar;
    source.size = sizeof kGrammar - 1;
    source.flags = flags;
    GpgpBlob blob{};
    ASSERT_EQ(gpgpCompileGrammar(&source, &blob), GPGP_SUCCESS);
    const GpgpGrammarCreateInfo info = GPGP_GRAMMAR_CREATE_INFO_INIT;
    const Bytes bytes = take(blob);
    for (size_t at = ends.empty() ? bytes.size() : ends[0]; at < bytes.size();) { // kernels, one after the other
      uint32_t words = 0;
      std::memcpy(&words, bytes.data() + at + 8, 4);
      ends.push_back(at += size_t(words) * 4);
    }
    sweep(loads(context, gpgpCreateGrammar, info), bytes, ends);
    ends.push_back(bytes.size());
  }
}

TEST_F(BakedFiles, Lsystems) {
  static constexpr char kText[] = "axiom: A(1)\niterations: 3\nangle: 25\nA(s) --> F(s)[+A(s*0.7)][-A(s*0.7)]\n";
  GpgpLsystemSource source = GPGP_LSYSTEM_SOURCE_INIT;
  source.text = kText;
  source.size = sizeof kText - 1;
  GpgpBlob blob{};
  ASSERT_EQ(gpgpCompileLsystem(&source, &blob), GPGP_SUCCESS);
  const GpgpLsystemCreateInfo info = GPGP_LSYSTEM_CREATE_INFO_INIT;
  sweep(loads(context, gpgpCreateLsystem, info), take(blob));
}
#endif

#if defined(GPGP_WITH_COMPILER) && defined(GPGP_WITH_VECTOR)
TEST_F(BakedFiles, Drawings) {
  static constexpr char kText[] =
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 40 40'><linearGradient id='g'><stop stop-color='red'/>"
      "<stop offset='1'/></linearGradient><rect width='30' height='30' rx='4' fill='url(#g)'/><g opacity='.5'>"
      "<circle r='9' cx='20' cy='20'/><path d='M5 5C9 30 30 1 35 35z'/></g></svg>";
  for (const GpgpDrawingMethods methods : {GPGP_DRAWING_FLATTENED, GPGP_DRAWING_FLATTENED | GPGP_DRAWING_IN_PASS}) {
    GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
    source.data = kText;
    source.size = sizeof kText - 1;
    source.methods = methods;
    GpgpBlob blob{};
    ASSERT_EQ(gpgpCompileSvg(&source, &blob), GPGP_SUCCESS);
    const GpgpDrawingCreateInfo info = GPGP_DRAWING_CREATE_INFO_INIT;
    sweep(loads(context, gpgpCreateDrawing, info), take(blob));
  }
}

TEST_F(BakedFiles, GlyphSets) {
  constexpr GpgpPathVerb kVerbs[] = {GPGP_PATH_MOVE, GPGP_PATH_QUAD, GPGP_PATH_LINE, GPGP_PATH_CLOSE};
  constexpr float kPoints[] = {0, 0, 0.5f, -0.9f, 0.7f, 0, 0.2f, 0.3f};
  const GpgpPath path{kVerbs, 4, kPoints, 4, GPGP_FILL_NON_ZERO, {0, 0, 0, 1}};
  const GpgpGlyph glyphs[] = {{7, &path, 1, nullptr}, {8, nullptr, 0, nullptr}};
  GpgpGlyphSource source = GPGP_GLYPH_SOURCE_INIT;
  source.glyphs = glyphs;
  source.glyphCount = 2;
  GpgpBlob blob{};
  ASSERT_EQ(gpgpCompileGlyphs(&source, &blob), GPGP_SUCCESS);
  const GpgpGlyphSetCreateInfo info = GPGP_GLYPH_SET_CREATE_INFO_INIT;
  sweep(loads(context, gpgpCreateGlyphSet, info), take(blob));
}
#endif

} // namespace
