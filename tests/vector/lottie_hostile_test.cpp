// Files that ask for more than there is: each ends within its limits, and what is left out is said.
#include "lottie_file.h"

#include <cmath>

namespace {
using namespace gpgp;
using namespace gpgp::test;

std::string repeated(const std::string& part, size_t count) {
  std::string all;
  for (size_t i = 0; i < count; ++i) all += part;
  return all;
}

TEST(LottieHostile, FilesEndWithinTheirLimits) {
  const std::string inner = R"({"ty":0,"refId":"a","ip":0,"op":60,"w":100,"h":100,"ks":{}})";
  const std::string stroke = R"(,{"ty":"st","c":{"k":[0,0,1]},"o":{"k":100},"w":{"k":2},"lc":2,"lj":2)";
  const std::string zeroes = "[" + repeated("[0,0],", 70'000) + "[0,0]]";
  struct Case {
    const char* name;
    std::string text;
    const char* said; ///< empty: nothing needs to be
  };
  std::vector<Case> cases;
  const auto add = [&](const char* name, std::string text, const char* said) {
    cases.push_back({name, std::move(text), said});
  };
  const auto shapes = [&](const std::string& list, const std::string& ks = "{}") {
    return animation(shapeLayer(list, ks));
  };
  add("deep lists", repeated("[", 100'000), "more than 128 deep");
  add("deep objects", repeated("{\"a\":", 100'000), "more than 128 deep");
  add("a number beyond doubles", R"({"w":1e999})", "too large");
  add("no UTF-8", "{\"layers\":[{\"ty\":4,\"nm\":\"\xff\xfe\"}]}", "not JSON");
  add("a composition in itself", animation(inner, R"("assets":[{"id":"a","layers":[)" + inner + "]}],"),
      "more than 64 deep");
  add("compositions that double",
      animation(inner, R"("assets":[{"id":"a","layers":[)" + inner + "," + inner + "," +
                           shapeLayer(kSquare + "," + kRed) + "]}],"),
      "65 536 layers");
  add("its own parent", animation(shapeLayer(kSquare + "," + kRed, "{}", R"("ind":1,"parent":1,)")),
      "their own parents");
  add("parents in a ring",
      animation(R"({"ty":3,"ind":1,"parent":2,"ks":{}},{"ty":3,"ind":2,"parent":1,"ks":{}},)" +
                shapeLayer(kSquare + "," + kRed, "{}", R"("ind":3,"parent":1,)")),
      "their own parents");
  add("mattes in a ring",
      animation(shapeLayer(kSquare + "," + kRed, "{}", R"("ind":1,"tt":1,"tp":2,)") + "," +
                shapeLayer(kSquare + "," + kRed, "{}", R"("ind":2,"tt":1,"tp":1,)")),
      "more than 28 nested effects");
  add("a matte of nobody", animation(shapeLayer(kSquare + "," + kRed, "{}", R"("ind":1,"tt":1,)")),
      "a matte is not there");
  add("a million copies",
      shapes(kSquare + "," + kRed + R"(,{"ty":"rp","c":{"k":1e6},"o":{"k":0},"tr":{"p":{"k":[0.001,0]}}})"), "");
  add("copies of copies of copies",
      shapes(kSquare + "," + kRed + repeated(R"(,{"ty":"rp","c":{"k":1000},"o":{"k":0},"tr":{}})", 3)),
      "4 000 000 points");
  add("a path of many vertices",
      shapes(R"({"ty":"sh","ks":{"k":{"v":)" + zeroes + R"(,"i":[],"o":[],"c":true}}},)" + kRed),
      "more than 65536 vertices");
  add("a star of many points",
      shapes(R"({"ty":"sr","sy":1,"pt":{"k":1e9},"p":{"k":[50,50]},"or":{"k":40},"ir":{"k":9}},)" + kRed), "");
  add("zigzags on zigzags",
      shapes(kSquare + repeated(R"(,{"ty":"zz","s":{"k":3},"r":{"k":1000},"pt":{"k":1}})", 4) + "," + kRed),
      "4 000 000 points");
  add("dashes without end", shapes(kSquare + stroke + R"(,"d":[{"n":"d","v":{"k":1e-5}}]})"),
      "more dashes than are drawn");
  add("dashes of nothing", shapes(kSquare + stroke + R"(,"d":[{"n":"d","v":{"k":0}},{"n":"g","v":{"k":-3}}]})"), "");
  add("a stroke as wide as the world",
      shapes(kSquare + R"(,{"ty":"st","c":{"k":[0,0,1]},"o":{"k":100},"w":{"k":1e9}})"), "");
  add("no size at all", shapes(kSquare + "," + kRed, R"({"s":{"k":[0,0]}})"), "");
  add("a size beyond floats", shapes(kSquare + "," + kRed, R"({"s":{"k":[1e9,1e9]},"p":{"k":[1e9,1e9]}})"),
      "beyond 1e7");
  add("groups in groups", shapes(repeated(R"({"ty":"gr","it":[)", 40) + kSquare + repeated("]}", 40)), "");
  add("too many groups in groups", shapes(repeated(R"({"ty":"gr","it":[)", 61) + kSquare + repeated("]}", 61)),
      "more than 128 deep");
  add("fading groups in groups",
      shapes(repeated(R"({"ty":"gr","it":[)", 40) + kSquare + "," + kRed + "," + kRed +
             repeated(R"(,{"ty":"tr","o":{"k":90}}]})", 40)),
      "");
  add("masks in masks",
      animation(R"({"ty":1,"sw":100,"sh":100,"sc":"#fff000","ip":0,"op":60,"ks":{},"masksProperties":[)" +
                repeated(R"({"mode":"s","pt":{"k":{"v":[[0,0],[9,0],[9,9]],"c":true}}},)", 70) + R"({"mode":"n"}]})"),
      "more than 28 nested effects");
  add("a mask without vertices",
      animation(
          R"({"ty":1,"sw":9,"sh":9,"sc":"red","ip":0,"op":60,"ks":{},"masksProperties":[{"mode":"a","pt":{"k":{}}}]})"),
      "#rrggbb");
  add("a gradient without stops",
      shapes(kSquare + R"(,{"ty":"gf","t":1,"g":{"p":0,"k":{"k":[]}},"s":{"k":[0,0]},"e":{"k":[9,9]}})"), "");
  add("a gradient of fewer stops than it says",
      shapes(kSquare + R"(,{"ty":"gf","t":2,"g":{"p":900,"k":{"k":[0,1,0,0,1,0]}},"s":{"k":[5,5]},"e":{"k":[5,5]}})"),
      "");
  add("keyframes out of order",
      shapes(kSquare + "," + kRed, R"({"r":{"a":1,"k":[{"t":50,"s":[9]},{"t":0,"s":[1]},{"t":0,"s":[]}]}})"), "sorted");
  add("keyframes of different sizes",
      shapes(
          R"({"ty":"sh","ks":{"a":1,"k":[{"t":0,"s":[{"v":[[0,0],[9,9]],"c":true}]},{"t":59,"s":[{"v":[[0,0]],"c":true}]}]}},)" +
          kRed),
      "");
  add("values of other kinds",
      animation(
          R"({"ty":"4","ks":[],"shapes":{"a":1}},7,null,"x",{"ty":4,"ks":{"p":"x","s":{"k":{}}},"shapes":[3,{"ty":5},{"ty":"fl","c":{"k":"red"}}]})"),
      "");
  add("time that divides by nothing",
      animation(R"({"ty":0,"refId":"a","sr":0,"ip":0,"op":60,"ks":{}})", R"("assets":[{"id":"a","layers":[]}],)"), "");
  add("a remap beyond all frames",
      animation(R"({"ty":0,"refId":"a","tm":{"k":1e9},"ip":0,"op":60,"w":9,"h":9,"ks":{}})",
                R"("assets":[{"id":"a","layers":[)" + shapeLayer(kSquare) + "]}],"),
      "");
  add("an image outside of the folder",
      animation(R"({"ty":2,"refId":"i","ip":0,"op":60,"ks":{}})",
                R"("assets":[{"id":"i","w":8,"h":4,"u":"../","p":"a.png"}],)"),
      "lies outside");
  add("a text without end",
      animation(R"({"ty":5,"ip":0,"op":60,"ks":{},"t":{"d":{"k":[{"t":0,"s":{"t":")" + std::string(20'000, 'x') +
                R"(","f":"F","s":9}}]}}})"),
      "more than 10 000 bytes");
  add("effects without numbers",
      animation(shapeLayer(kSquare + "," + kRed, "{}",
                           R"("ef":[{"ty":25},{"ty":29,"ef":[{"v":{"k":1e9}}]},{"ty":20,"ef":7},{"ty":21}],)")),
      "");
  ASSERT_GE(cases.size(), 30u);
  GpgpLottieSource source = GPGP_LOTTIE_SOURCE_INIT;
  const GpgpFileSystem files{nullptr, [](void*, const char* path, void*, size_t, size_t*) -> GpgpResult {
                               ADD_FAILURE() << "asked for " << path;
                               return GPGP_ERROR_IO;
                             }};
  source.fileSystem = &files;
  source.imageFn = [](void*, uint32_t, const void*, size_t, uint32_t*, uint32_t*) -> VkBool32 { return VK_FALSE; };
  for (const Case& hostile : cases) {
    SCOPED_TRACE(hostile.name);
    LottieFile file(hostile.text, source);
    if (file.result == GPGP_SUCCESS)
      for (const double frame : {0.0, 30.5, 59.0}) {
        const GpgpLottieFrame shown = file.at(frame);
        EXPECT_LE(shown.pathCount, 100'000u);
        for (uint32_t i = 0; i < shown.pathCount; ++i)
          for (uint32_t k = 0; k < 2 * shown.paths[i].pointCount; ++k)
            ASSERT_LE(std::fabs(shown.paths[i].points[k]), 1e7f);
      }
    else
      EXPECT_EQ(file.result, GPGP_ERROR_INVALID_DATA);
    if (*hostile.said) {
      EXPECT_TRUE(file.said(hostile.said)) << (file.messages.empty() ? "nothing was said" : file.messages[0]);
    } else {
      EXPECT_EQ(file.result, GPGP_SUCCESS) << (file.messages.empty() ? "" : file.messages[0]);
    }
  }
}

} // namespace
