// Hot reload: follows grammar files, linked where they are several, and hands over a new grammar whenever one of them
// has changed and all compile.
//
// A thread reads and compiles, so that frames never wait. What it made becomes an asset between two frames, travels to
// the device with the frames' own gpgpRecordUpload, and is handed over once it can be recorded with: the frame that has
// it is as fast as any other. A file with errors is reported and changes nothing.
//
// Places of starts are a version's own: engines whose axioms name starts look them up again (gpgpFindGrammarStart).
#pragma once
#include <gpgp/gpgp.hpp>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace mini {

struct GrammarWatchOptions {
  struct File {
    std::string path;
    std::string text; ///< as it is in use now
  };
  std::vector<File> files;
  bool kernels = false; ///< each version twice: at once for the interpreter, then with a kernel of its own
  std::function<void(const std::string&)> say; ///< errors and warnings with their places; called by update
};

class GrammarWatch {
public:
  /// Both handles outlive the watch.
  GrammarWatch(GpgpContext context, GpgpRecorder spawner, GrammarWatchOptions options);
  ~GrammarWatch();
  GrammarWatch(const GrammarWatch&) = delete;
  GrammarWatch& operator=(const GrammarWatch&) = delete;

  /// Once a frame, between gpgpAdvance and the records: the grammar to use from this frame on, if it is another one.
  /// Destroying the old one at once is fine; gpgp keeps it until the frames that use it are over.
  std::optional<gpgp::Grammar> update();

private:
  void run();
  bool compile(const std::vector<std::string>& texts, GpgpCompileFlags flags);

  const GpgpContext context_;
  const GpgpRecorder spawner_;
  const GrammarWatchOptions options_;
  gpgp::Grammar next_; // only update touches it

  std::mutex mutex_; // of all below; held for moments only
  std::condition_variable wake_;
  std::vector<std::string> messages_;
  gpgp::Blob compiled_;           // by the thread, for update
  GpgpAsset toPrewarm_ = nullptr; // next_, by update, for the thread
  bool hasKernel_ = false, stop_ = false;
  std::thread thread_; // last: it uses all others
};

} // namespace mini
