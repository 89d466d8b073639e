#include "grammar_watch.h"

#include <chrono>
#include <fstream>
#include <iterator>
#include <utility>

namespace mini {
namespace {

constexpr std::chrono::milliseconds kPeriod{100}; // between two looks at the files

/// Nothing where a file is away for the moment, as while an editor replaces it.
std::optional<std::vector<std::string>> readTexts(const std::vector<GrammarWatchOptions::File>& files) {
  std::vector<std::string> texts;
  for (const auto& [path, text] : files) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    texts.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return texts;
}

} // namespace

GrammarWatch::GrammarWatch(GpgpContext context, GpgpRecorder spawner, GrammarWatchOptions options)
    : context_(context), spawner_(spawner), options_(std::move(options)), thread_([this] { run(); }) {}

GrammarWatch::~GrammarWatch() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

// ---------------------------------------------------------------- between two frames

std::optional<gpgp::Grammar> GrammarWatch::update() {
  const std::lock_guard lock(mutex_);
  for (const std::string& message : messages_) options_.say(message);
  messages_.clear();
  if (toPrewarm_) return std::nullopt; // the thread has next_
  if (compiled_.size() > 0) {
    auto info = gpgp::init<GpgpGrammarCreateInfo>();
    info.label = options_.files[0].path.c_str();
    info.data = compiled_.data();
    info.size = compiled_.size();
    auto made = gpgp::Grammar::create(context_, info); // checks the bytes and queues them for upload
    if (!made) options_.say(options_.files[0].path + ": " + made.name());
    next_ = *std::move(made);
    compiled_.reset();
    if (next_ && hasKernel_) {
      toPrewarm_ = next_;
      wake_.notify_one();
      return std::nullopt;
    }
  }
  if (!next_ || !*next_.resident()) return std::nullopt;
  return std::exchange(next_, {});
}

// ---------------------------------------------------------------- the thread

void GrammarWatch::run() {
  std::vector<std::string> texts; // what was compiled last
  for (const auto& file : options_.files) texts.push_back(file.text);
  std::vector<std::string> seen = texts; // at the last look
  bool kernelMissing = false;
  std::unique_lock lock(mutex_);
  while (!stop_) {
    if (toPrewarm_) {
      lock.unlock();
      const GpgpResult result = gpgpPrewarmGrammar(spawner_, toPrewarm_); // compiles pipelines, beside the frames
      lock.lock();
      if (result < 0) messages_.push_back(options_.files[0].path + ": " + gpgpResultString(result));
      toPrewarm_ = nullptr;
    }
    const bool taken = compiled_.size() == 0;
    lock.unlock();
    const auto now = readTexts(options_.files);
    if (now && *now != seen) {
      seen = *now; // perhaps in the midst of being written: compiled once two looks agree
    } else if (now && *now != texts) {
      texts = *now;
      kernelMissing = compile(texts, 0) && options_.kernels;
    } else if (kernelMissing && taken) {
      kernelMissing = false;
      compile(texts, GPGP_COMPILE_KERNEL);
    }
    lock.lock();
    wake_.wait_for(lock, kPeriod, [this] { return stop_ || toPrewarm_; });
  }
}

bool GrammarWatch::compile(const std::vector<std::string>& texts, GpgpCompileFlags flags) {
  std::vector<std::string> messages;
  auto source = gpgp::init<GpgpGrammarSource>();
  source.flags = flags;
  source.messageUserData = &messages;
  source.messageFn = [](void* user, const GpgpCompileMessage* m) {
    std::string place = m->file;
    if (m->line) place += ':' + std::to_string(m->line) + ':' + std::to_string(m->column);
    static_cast<std::vector<std::string>*>(user)->push_back(
        place + (m->severity == GPGP_SEVERITY_ERROR ? ": error: " : ": warning: ") + m->text);
  };
  std::vector<GpgpGrammarSource> sources(texts.size(), source);
  for (size_t i = 0; i < texts.size(); ++i) {
    sources[i].name = options_.files[i].path.c_str();
    sources[i].text = texts[i].data();
    sources[i].size = texts[i].size();
  }
  gpgp::Result<gpgp::Blob> blob = texts.size() > 1
                                      ? gpgp::linkGrammars(sources.data(), static_cast<uint32_t>(sources.size()))
                                      : gpgp::compileGrammar(sources[0]);
  const std::lock_guard lock(mutex_);
  if (flags == 0 || !blob) messages_.insert(messages_.end(), messages.begin(), messages.end());
  if (!blob) return false; // the previous version lives on
  compiled_ = *std::move(blob);
  hasKernel_ = (flags & GPGP_COMPILE_KERNEL) != 0;
  return true;
}

} // namespace mini
