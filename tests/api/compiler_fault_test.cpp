// Faults in the libraries without a device: for every n, the n-th allocation fails in compilers, importers, the
// evaluator and text, whose memory is operator new's. Each call then says so, leaks nothing and throws nothing.
#include "fault_sweep.h"

#if defined(GPGP_TEST_TEXT)
#include "vector/text/tiny_font.h"
#endif

#include <cstring>

namespace {
using namespace gpgp::test;

#if defined(GPGP_WITH_COMPILER)
struct CompilerFaults : testing::Test {
  ErrorCount messages;
  GpgpBlob blob{};

  /// A compiler that makes a blob of constant things.
  void sweepBlob(const std::function<GpgpResult()>& compile) {
    FaultJob job;
    job.messages = &messages;
    job.calls = {compile};
    job.state = [&] { return std::string(static_cast<const char*>(blob.data), blob.size); };
    job.end = [&] { gpgpFreeBlob(&blob); };
    sweepFaults(job);
  }
};
constexpr char kLongName[] = "a name that no small string holds.txt";
#endif

#if defined(GPGP_WITH_COMPILER) && defined(GPGP_WITH_VECTOR)
TEST_F(CompilerFaults, Svg) {
  static constexpr char kText[] =
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 40 40'><style>.a{fill:url(#g)}</style><defs>"
      "<linearGradient id='g'><stop offset='0' stop-color='red'/><stop offset='1' stop-color='#00f8'/></linearGradient>"
      "<clipPath id='c'><circle cx='20' cy='20' r='15'/></clipPath><filter id='f'><feGaussianBlur stdDeviation='2'/>"
      "</filter></defs><g clip-path='url(#c)' opacity='.5'><rect class='a' width='30' height='30' rx='4'/>"
      "<path d='M5 5C9 30 30 1 35 35z' stroke='green' stroke-width='3' stroke-dasharray='4 2' fill='none'/></g>"
      "<g filter='url(#f)'><ellipse cx='9' cy='9' rx='5' ry='3'/></g></svg>";
  GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
  source.name = kLongName;
  source.data = kText;
  source.size = sizeof kText - 1;
  source.messageFn = ErrorCount::count<GpgpMessage>;
  source.messageUserData = &messages;
  sweepBlob([&] { return gpgpCompileSvg(&source, &blob); });
}

TEST_F(CompilerFaults, Glyphs) {
  constexpr GpgpPathVerb kVerbs[] = {GPGP_PATH_MOVE, GPGP_PATH_QUAD, GPGP_PATH_LINE, GPGP_PATH_CLOSE};
  constexpr float kPoints[] = {0, 0, 0.5f, -0.9f, 0.7f, 0, 0.2f, 0.3f};
  const GpgpPath paths[] = {{kVerbs, 4, kPoints, 4, GPGP_FILL_NON_ZERO, {0, 0, 0, 1}},
                            {kVerbs, 4, kPoints, 4, GPGP_FILL_EVEN_ODD, {1, 0, 0, 0.5f}}};
  const GpgpGlyph glyphs[] = {{7, paths, 1, nullptr}, {8, nullptr, 0, nullptr}, {9, paths, 2, nullptr}};
  GpgpGlyphSource source = GPGP_GLYPH_SOURCE_INIT;
  source.name = kLongName;
  source.glyphs = glyphs;
  source.glyphCount = 3;
  source.messageFn = ErrorCount::count<GpgpMessage>;
  source.messageUserData = &messages;
  sweepBlob([&] { return gpgpCompileGlyphs(&source, &blob); });
}

TEST_F(CompilerFaults, LottieFrames) {
  static constexpr char kText[] =
      R"({"v":"5.5.0","fr":30,"ip":0,"op":60,"w":100,"h":80,"layers":[{"ty":4,"ip":0,"op":60,"st":0,"ks":{"o":{"a":1,
      "k":[{"t":0,"s":[20],"o":{"x":0.3,"y":0},"i":{"x":0.6,"y":1}},{"t":60,"s":[90]}]},"p":{"k":[50,40]}},"shapes":[
      {"ty":"gr","it":[{"ty":"rc","p":{"k":[0,0]},"s":{"k":[40,30]},"r":{"k":5}},{"ty":"st","c":{"k":[1,0,0,1]},"o":{
      "k":100},"w":{"k":3}},{"ty":"fl","c":{"k":[0,0,1,1]},"o":{"k":50}},{"ty":"tr","p":{"k":[0,0]},"a":{"k":[0,0]},
      "s":{"k":[100,100]},"r":{"k":10},"o":{"k":100}}]},{"ty":"tm","s":{"k":10},"e":{"k":80},"o":{"k":0}}]}]})";
  GpgpLottie lottie = nullptr;
  GpgpLottieFrame frame = GPGP_LOTTIE_FRAME_INIT;
  FaultJob job;
  job.messages = &messages;
  job.calls = {[&] {
                 GpgpLottieSource source = GPGP_LOTTIE_SOURCE_INIT;
                 source.name = kLongName;
                 source.data = kText;
                 source.size = sizeof kText - 1;
                 source.messageFn = ErrorCount::count<GpgpMessage>;
                 source.messageUserData = &messages;
                 return gpgpCreateLottie(&source, &lottie);
               },
               [&] { return gpgpEvaluateLottie(lottie, 12.5, &frame); },
               [&] { return gpgpCompileLottieFrame(lottie, 31, nullptr, &blob); },
               [&] { return gpgpEvaluateLottie(lottie, 40, &frame); }};
  job.state = [&] {
    return std::string(static_cast<const char*>(blob.data), blob.size) + std::to_string(frame.content) + " " +
           std::to_string(frame.pathCount);
  };
  job.end = [&] {
    gpgpDestroyLottie(lottie);
    gpgpFreeBlob(&blob);
    lottie = nullptr;
    frame = GPGP_LOTTIE_FRAME_INIT;
  };
  sweepFaults(job);
}
#endif

#if defined(GPGP_WITH_COMPILER) && defined(GPGP_WITH_SPAWN)
constexpr char kGrammar[] = "var height = 2.5 to 4; axiom Box A; terminal Tower (1, 0); terminal Roof (1, 1);\n"
                            "A = SubDiv(X) { 1: B | -1: B };\n"
                            "B = [0.5] Scale(1, height, 1) { Replicate() { Tower | Translate(0, 1, 0) Roof } };\n";
constexpr char kPlainGrammar[] = "axiom Box A; terminal Tower (1, 0); terminal Roof (1, 1);\n"
                                 "A = SubDiv(X) { -1: B | -1: B };\n"
                                 "B = Replicate() { Tower | Translate(0, 1, 0) Roof };\n";

GpgpGrammarSource grammarSource(ErrorCount& messages) {
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.name = kLongName;
  source.alias = "an_alias_that_no_small_string_holds";
  source.text = kPlainGrammar;
  source.size = sizeof kPlainGrammar - 1;
  source.messageFn = ErrorCount::count<GpgpCompileMessage>;
  source.messageUserData = &messages;
  return source;
}

TEST_F(CompilerFaults, Grammars) {
  const GpgpGrammarSource source = grammarSource(messages);
  sweepBlob([&] { return gpgpCompileGrammar(&source, &blob); });
}

TEST_F(CompilerFaults, GrammarsThatAreWrong) { // the message of the error needs memory, too
  GpgpGrammarSource source = grammarSource(messages);
  source.text = kGrammar;
  source.size = 60;
  for (const bool onwards : {false, true})
    for (uint64_t n = 1;; ++n) {
      const int64_t before = livingNews();
      failAllocations(n, onwards);
      const GpgpResult result = gpgpCompileGrammar(&source, &blob);
      const uint64_t tried = allocationsTried();
      failAllocations(0, false);
      ASSERT_EQ(blob.data, nullptr);
      ASSERT_TRUE(result == GPGP_ERROR_OUT_OF_HOST_MEMORY || result == GPGP_ERROR_INVALID_DATA) << result;
      if (canFailNew() && n > 1) {
        ASSERT_EQ(livingNews(), before) << n;
      }
      if (tried < n) break;
    }
}

TEST_F(CompilerFaults, GrammarsInTheStackLanguage) {
  static constexpr char kText[] = "/Wall 1 0 terminal /Roof 1 1 terminal /storey 3.2 var\n"
                                  "/lot 0 { X [ storey { Wall } -1 { Roof } ] subdiv } rule\n/Box axiom lot";
  GpgpGrammarSource source = grammarSource(messages);
  source.text = kText;
  source.size = sizeof kText - 1;
  source.flags = GPGP_COMPILE_STACK_LANGUAGE;
  if (gpgpCompileGrammar(&source, &blob) != GPGP_SUCCESS) GTEST_FAIL() << messages.last;
  gpgpFreeBlob(&blob);
  sweepBlob([&] { return gpgpCompileGrammar(&source, &blob); });
}

TEST_F(CompilerFaults, LinkedGrammars) {
  GpgpGrammarSource sources[2] = {grammarSource(messages), grammarSource(messages)};
  sources[1].alias = "another_alias_that_no_small_string_holds";
  sweepBlob([&] { return gpgpLinkGrammars(sources, 2, &blob); });
}

TEST_F(CompilerFaults, Lsystems) {
  static constexpr char kText[] = "axiom: A(1)\niterations: 3\nangle: 25\nA(s) --> F(s)[+A(s*0.7)][-A(s*0.7)]\n";
  GpgpLsystemSource source = GPGP_LSYSTEM_SOURCE_INIT;
  source.name = kLongName;
  source.text = kText;
  source.size = sizeof kText - 1;
  source.messageFn = ErrorCount::count<GpgpCompileMessage>;
  source.messageUserData = &messages;
  sweepBlob([&] { return gpgpCompileLsystem(&source, &blob); });
}

TEST_F(CompilerFaults, EvaluationsAreWholeOrEmpty) {
  FailingHost allocator;
  const GpgpHostAllocator host = allocator.callbacks();
  GpgpAxiom axioms[3] = {};
  for (uint32_t i = 0; i < 3; ++i) {
    axioms[i].transform[0] = axioms[i].transform[5] = axioms[i].transform[10] = 1;
    axioms[i].size[0] = axioms[i].size[1] = axioms[i].size[2] = 4;
    axioms[i].start = GPGP_AXIOM_DEFAULT_START;
    axioms[i].seed = i;
  }
  GpgpEvaluator evaluator = nullptr;
  GpgpEvaluation evaluation = nullptr;
  GpgpEvaluationInfo info = GPGP_EVALUATION_INFO_INIT;
  info.axioms = axioms;
  info.axiomCount = 3;
  info.flags = GPGP_EVALUATION_BOUNDS;
  info.rangeCount = 2;
  FaultJob job;
  job.messages = &messages;
  job.emptied = "0 0 0";
  job.calls = {[&] {
                 const GpgpGrammarSource source = grammarSource(messages);
                 GpgpEvaluatorCreateInfo createInfo = GPGP_EVALUATOR_CREATE_INFO_INIT;
                 createInfo.label = kLongName;
                 createInfo.sources = &source;
                 createInfo.sourceCount = 1;
                 createInfo.hostAllocator = &host;
                 return gpgpCreateEvaluator(&createInfo, &evaluator);
               },
               [&] { return gpgpCreateEvaluation(evaluator, &evaluation); },
               [&] { return gpgpEvaluate(evaluation, &info); }, [&] { return gpgpEvaluate(evaluation, &info); }};
  job.state = [&] {
    GpgpEvaluationResult result = GPGP_EVALUATION_RESULT_INIT;
    if (!evaluation) return std::string();
    EXPECT_EQ(gpgpGetEvaluationResult(evaluation, &result), GPGP_SUCCESS);
    return std::to_string(result.instances) + " " + std::to_string(result.keyHash[0]) + " " +
           std::to_string(result.axiomCount);
  };
  job.end = [&] {
    gpgpDestroyEvaluation(evaluation);
    gpgpDestroyEvaluator(evaluator);
    evaluation = nullptr, evaluator = nullptr;
    ASSERT_EQ(allocator.living, 0) << "the host allocator's memory leaked";
  };
  sweepFaults(job);
}
#endif

#if defined(GPGP_TEST_TEXT)
TEST(TextFaults, LayoutsKeepTheirTextOrHaveTheNewOne) {
  ErrorCount messages;
  const std::vector<char> bytes = tinyFont();
  GpgpFont font = nullptr;
  GpgpShaper shaper = nullptr;
  GpgpLayout layout = nullptr;
  std::string outline;
  const auto setText = [&](const char* text) {
    GpgpTextInfo info = GPGP_TEXT_INFO_INIT;
    info.text = text;
    info.size = std::strlen(text);
    info.style.fonts = &font;
    info.style.fontCount = 1;
    info.style.size = 20;
    info.style.underline = VK_TRUE;
    info.width = 60;
    return gpgpSetLayoutText(layout, &info);
  };
  FaultJob job;
  job.messages = &messages;
  job.emptied = " 0 0.000000 0 0"; // as gpgpSetLayoutText says
  job.calls = {[&] {
                 GpgpFontCreateInfo info = GPGP_FONT_CREATE_INFO_INIT;
                 info.label = "a label that no small string holds";
                 info.data = bytes.data();
                 info.size = bytes.size();
                 info.messageFn = ErrorCount::count<GpgpMessage>;
                 info.messageUserData = &messages;
                 return gpgpCreateFont(&info, &font);
               },
               [&] {
                 GpgpShaperCreateInfo info = GPGP_SHAPER_CREATE_INFO_INIT;
                 info.messageFn = ErrorCount::count<GpgpMessage>;
                 info.messageUserData = &messages;
                 return gpgpCreateShaper(&info, &shaper);
               },
               [&] { return gpgpCreateLayout(shaper, &layout); },
               [&] { return setText("AB CA AB"); },
               [&] { return setText("a text that is \xff longer, AB DE"); },
               [&] {
                 GpgpGlyphOutlineInfo info = GPGP_GLYPH_OUTLINE_INFO_INIT;
                 info.glyph = tiny::kLayers;
                 return gpgpGetGlyphOutline(
                     font, &info,
                     [](void* user, const GpgpGlyphOutline* found) {
                       const UncountedNew own;
                       *static_cast<std::string*>(user) = std::to_string(found->pathCount);
                     },
                     &outline);
               }};
  job.state = [&] {
    std::string state = outline;
    if (!layout) return state;
    GpgpLayoutInfo info = GPGP_LAYOUT_INFO_INIT;
    EXPECT_EQ(gpgpGetLayoutInfo(layout, &info), GPGP_SUCCESS);
    state += " " + std::to_string(info.glyphCount) + " " + std::to_string(info.width) + " " +
             std::to_string(info.lineCount) + " " + std::to_string(info.invalidCount);
    return state;
  };
  job.end = [&] {
    gpgpDestroyLayout(layout);
    gpgpDestroyShaper(shaper);
    gpgpDestroyFont(font);
    layout = nullptr, shaper = nullptr, font = nullptr;
    outline.clear();
  };
  sweepFaults(job);
}
#endif

} // namespace
