// Hot reload as an engine does it, with the mini-engine's own code: frames run while the grammar's files change, to
// another grammar, to errors and back. No frame waits, and each derives one of the versions, whole.
#include "grammar_watch.h"
#include "host/files.h"
#include "host/frames.h"
#include "host/memory.h"
#include "spawn/evaluator/evaluator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <unistd.h>

namespace {
using namespace gpgp;

/// A box cut into that many slices.
std::string slices(uint32_t count) {
  return "axiom Box A;\nterminal T (1, 0);\nA = Repeat(Y, -1 / " + std::to_string(count) + ", ADJUST_TO_FILL) T;\n";
}

class ReloadTest : public testing::Test {
protected:
  ReloadTest() {
    auto info = device_.contextCreateInfo();
    info.maxFramesInFlight = 3;
    info.messageFn = [](void*, const GpgpMessage* m) { ADD_FAILURE() << m->function << ": " << m->text; };
    auto context = Context::create(info);
    EXPECT_TRUE(context) << context.name();
    context_ = *std::move(context);
    auto spawnerInfo = init<GpgpSpawnerCreateInfo>();
    spawnerInfo.base.queueFamily = device_.graphics().family;
    spawnerInfo.maxShapes = spawnerInfo.maxTerminals = 4096;
    spawnerInfo.maxHostAxioms = 2;
    auto spawner = Spawner::create(context_, spawnerInfo);
    EXPECT_TRUE(spawner) << spawner.name();
    spawner_ = *std::move(spawner);
    EXPECT_EQ(spawner_.prewarm(), GPGP_SUCCESS);
    instances_ = host::Buffer(device_, 64 * sizeof(GpgpInstance), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  }
  ~ReloadTest() override {
    watch_.reset();
    frames_.waitAll();
    grammar_.reset();
    spawner_.reset();
    context_.reset();
    for (const std::string& message : device_.validationMessages()) ADD_FAILURE() << message;
    for (const std::string& file : {file_, other_}) std::filesystem::remove(file);
  }

  /// Frames begin with a grammar of these files, five slices each, which are followed from now on.
  void watch(bool kernels, const std::vector<std::string>& files) {
    mini::GrammarWatchOptions options;
    const std::string text = slices(5);
    std::vector<GpgpGrammarSource> sources(files.size(), init<GpgpGrammarSource>());
    for (size_t i = 0; i < files.size(); ++i) {
      write(text, files[i]);
      options.files.push_back({files[i], text});
      sources[i].name = files[i].c_str();
      sources[i].text = text.data();
      sources[i].size = text.size();
    }
    const auto blob = files.size() > 1 ? linkGrammars(sources.data(), static_cast<uint32_t>(sources.size()))
                                       : compileGrammar(sources[0]);
    auto grammarInfo = init<GpgpGrammarCreateInfo>();
    grammarInfo.data = blob->data();
    grammarInfo.size = blob->size();
    auto grammar = Grammar::create(context_, grammarInfo);
    ASSERT_TRUE(grammar) << grammar.name();
    grammar_ = *std::move(grammar);
    options.kernels = kernels;
    options.say = [this](const std::string& message) { said_.push_back(message); };
    watch_ = std::make_unique<mini::GrammarWatch>(context_, spawner_, options);
  }
  void watch(bool kernels) { watch(kernels, {file_}); }
  void write(const std::string& text) { write(text, file_); }
  static void write(const std::string& text, const std::string& file) { host::writeFile(file, text); }

  /// One for each start. Their places are this grammar's.
  std::vector<GpgpAxiom> axioms() const {
    GpgpAxiom axiom{};
    axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1;
    axiom.size[0] = axiom.size[1] = axiom.size[2] = 10;
    axiom.start = GPGP_AXIOM_DEFAULT_START;
    std::vector<GpgpAxiom> all(std::max<size_t>(starts_.size(), 1), axiom);
    for (size_t i = 0; i < starts_.size(); ++i)
      EXPECT_EQ(gpgpFindGrammarStart(grammar_, starts_[i].c_str(), &all[i].start), GPGP_SUCCESS);
    return all;
  }

  /// One frame of an engine. Its record must succeed whatever is being compiled.
  void frame() {
    const VkCommandBuffer commands = frames_.begin();
    EXPECT_EQ(context_.advance(frames_.frame()), GPGP_SUCCESS);
    while (const auto report = spawner_.report()) {
      EXPECT_EQ(report->base.status, GPGP_SUCCESS);
      derived_.push_back(report->terminals);
    }
    if (auto next = watch_->update()) {
      grammar_ = *std::move(next); // the old one is destroyed while up to three frames still use it
      ++swaps_;
    }
    EXPECT_TRUE(context_.recordUpload(commands, frames_.frame()));
    auto info = init<GpgpSpawnInfo>();
    info.grammar = grammar_;
    const std::vector<GpgpAxiom> start = axioms();
    info.hostAxioms = start.data();
    info.axiomCount = static_cast<uint32_t>(start.size());
    const GpgpAccess written{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_WRITE_BIT, {}};
    info.instances = instances_.range(written, written);
    EXPECT_EQ(spawner_.recordPrepare(commands, frames_.frame(), info), GPGP_SUCCESS);
    frames_.submit();
    ++frameCount_;
  }
  /// Frames until something is so; a generous limit, so that a failure ends.
  template <class Condition> bool framesUntil(Condition condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    while (!condition() && std::chrono::steady_clock::now() < end && !HasFailure()) frame();
    return condition();
  }
  uint32_t last() const { return derived_.empty() ? 0 : derived_.back(); }

  host::HeadlessDevice device_{host::DeviceOptions{.validation = true}};
  Context context_;
  Spawner spawner_;
  Grammar grammar_;
  host::Buffer instances_;
  host::FrameRing frames_{device_, 3};
  std::unique_ptr<mini::GrammarWatch> watch_;
  const std::string file_ = testing::TempDir() + "gpgp_reload_" + std::to_string(getpid()) + ".pga",
                    other_ = testing::TempDir() + "gpgp_reload_other_" + std::to_string(getpid()) + ".pga";
  std::vector<std::string> starts_; // of axioms; none: one of the default
  std::vector<std::string> said_;
  std::vector<uint32_t> derived_; // terminals of each report
  uint32_t swaps_ = 0, frameCount_ = 0;
};

TEST_F(ReloadTest, ErrorsKeepThePreviousVersion) {
  watch(false);
  ASSERT_TRUE(framesUntil([&] { return last() == 5; }));
  write(slices(7));
  ASSERT_TRUE(framesUntil([&] { return last() == 7; }));
  EXPECT_EQ(swaps_, 1u);

  write("axiom Box A;\nterminal T (1, 0);\nA = Repeat(Y) T;\nB = Nowhere;\n");
  ASSERT_TRUE(framesUntil([&] { return said_.size() == 2; }));
  EXPECT_EQ(said_[0], file_ + ":3:5: error: Repeat takes 3 arguments, found 1");
  EXPECT_EQ(said_[1], file_ + ":4:5: error: there is no rule or terminal 'Nowhere'");
  for (int i = 0; i < 8; ++i) frame();
  EXPECT_EQ(last(), 7u);
  EXPECT_EQ(swaps_, 1u);

  std::filesystem::remove(file_); // as some editors do for a moment
  for (int i = 0; i < 8; ++i) frame();
  EXPECT_EQ(last(), 7u);

  write(slices(9));
  ASSERT_TRUE(framesUntil([&] { return last() == 9; }));
  EXPECT_EQ(swaps_, 2u);
  EXPECT_EQ(said_.size(), 2u);
  // whole versions only, in order, and a report from every frame but those in flight
  EXPECT_TRUE(std::is_sorted(derived_.begin(), derived_.end()));
  for (const uint32_t count : derived_) EXPECT_TRUE(count == 5 || count == 7 || count == 9) << count;
  EXPECT_GE(derived_.size() + 3, frameCount_);
}

TEST_F(ReloadTest, LinkedFilesAreFollowed) {
  const auto name = [](const std::string& file) { return std::filesystem::path(file).stem().string(); };
  starts_ = {name(file_), name(other_)};
  watch(true, {file_, other_});
  ASSERT_TRUE(framesUntil([&] { return last() == 5 + 5; }));
  write(slices(7) + "Unused = A;\n"); // a rule more: the other file's starts move
  ASSERT_TRUE(framesUntil([&] { return last() == 7 + 5; }));
  EXPECT_EQ(std::exchange(said_, {}), std::vector{file_ + ":4:1: warning: rule 'Unused' is never used"});
  write(slices(20), other_);
  ASSERT_TRUE(framesUntil([&] { return last() == 7 + 20; }));
  said_.clear(); // warned again

  write("axiom Box A;\nA = Nowhere;\n", other_); // an error in one: both stay
  ASSERT_TRUE(framesUntil([&] { return !said_.empty(); }));
  EXPECT_EQ(said_, std::vector{other_ + ":2:5: error: there is no rule or terminal 'Nowhere'"});
  write(slices(9));
  for (int i = 0; i < 8; ++i) frame();
  EXPECT_EQ(last(), 7u + 20u);

  write(slices(3), other_);
  ASSERT_TRUE(framesUntil([&] { return last() == 9 + 3; }));
}

TEST_F(ReloadTest, KernelsTakeOverWhenTheyAreReady) {
  watch(true);
  write(slices(6));
  ASSERT_TRUE(framesUntil([&] { return swaps_ == 1 && last() == 6; })); // on the interpreter
  const uint32_t before = frameCount_;
  ASSERT_TRUE(framesUntil([&] { return swaps_ == 2; })); // compiled and prewarmed while frames ran
  EXPECT_GT(frameCount_, before + 3);
  for (int i = 0; i < 8; ++i) frame();
  EXPECT_EQ(last(), 6u);
  EXPECT_TRUE(said_.empty());
}

TEST_F(ReloadTest, EndsInTheMidstOfWork) {
  for (int i = 0; i < 4; ++i) {
    watch(true);
    write(slices(6 + static_cast<uint32_t>(i)));
    const uint32_t swaps = swaps_;
    ASSERT_TRUE(framesUntil([&] { return swaps_ > swaps; })); // now the kernel is being compiled
    watch_.reset();
  }
}

} // namespace
