// A context: the engine's device, memory, frames, and everything made from it.
//
// Threads: members marked "context" are used by one thread at a time (the API's @threads context), those marked
// "objects" while the mutex of that name is held. The rest is immutable after creation, or safe for all threads: assets
// are created on any.
#pragma once
#include "core/asset_pool.h"
#include "core/device.h"
#include "core/gpu_memory.h"
#include "core/object.h"

#include <array>
#include <atomic>
#include <mutex>
#include <vector>

namespace gpgp::core {

class Resident;
class Recorder;
class UploadRing;

class Context {
public:
  static constexpr uint64_t kMagic = 0x67706770'63747874; // "gpgpctxt"

  /// Makes a context with the engine's allocator; the context itself lives in memory from it.
  static Result<Context*> create(const GpgpContextCreateInfo& info);
  static void destroy(Context* context);

  // ---- immutable
  uint64_t magic = kMagic;
  const Label label;
  const GpgpMessageFn messageFn;
  void* const messageUserData;
  const uint32_t maxFramesInFlight, maxRecordingsPerFrame;
  const GpgpJobSystem jobSystem;   // parallelFor may be null
  const GpgpFileSystem fileSystem; // read may be null
  Device device;
  VkPipelineCache pipelineCache = VK_NULL_HANDLE;

  HostMemory& host() { return host_; }
  GpuMemory& gpu() { return *gpu_; }
  AssetPool& assetPool() { return *assetPool_; }
  void message(GpgpSeverity severity, GpgpResult code, const char* function, const char* objectLabel,
               const char* text) const;

  /// Whether this was not asked for before, for messages that are sent once. Forgets some after many others.
  bool isNew(std::initializer_list<const char*> texts) const;

  // ---- objects
  std::atomic<uint32_t> tileSets{0}; ///< made so far
  std::mutex objects;                ///< held briefly, but by gpgpRecordUpload while it copies
  /// Gives an object a handle. On failure the object is destroyed and bad_alloc thrown. Any thread.
  Slot* adopt(Unique<Object> object);
  /// Invalidates the handle at once and frees the object when the frames that may use it are safe. (context)
  void retire(Object& object);

  // ---- frames (context; current and safe are read by recording threads)
  /// The frame of the last advance; threads that create assets read it beside an advance.
  uint64_t current() const { return current_.load(std::memory_order_relaxed); }
  uint64_t safe() const { return safe_.load(std::memory_order_relaxed); }
  bool lost() const { return lost_.load(std::memory_order_relaxed); }
  /// DEVICE_LOST once the engine has said so.
  Result<void> checkAlive() const {
    if (lost()) return makeError(GPGP_ERROR_DEVICE_LOST, "the device is lost");
    return {};
  }
  void setLost();
  Result<void> advance(const GpgpFrame& frame);
  /// Checks a frame that a recording names: same as the last advance's.
  Result<void> checkFrame(const GpgpFrame* frame) const;

  // ---- lists of living objects that advance visits; intrusive, see Resident and Recorder
  Resident *residents = nullptr, *lastResident = nullptr; ///< upload pending or in flight, oldest first (objects)
  Recorder* recorders = nullptr;                          // context
  UploadRing& uploads() { return *uploads_; }

  /// Reads a file through the engine's callbacks or the C library.
  Result<std::pmr::vector<std::byte>> readFile(const char* path);

  ~Context();

private:
  friend Unique<Context> makeUnique<Context>(std::pmr::memory_resource&, const GpgpContextCreateInfo&);
  Context(const GpgpContextCreateInfo& info);
  Result<void> initialise(const GpgpContextCreateInfo& info);
  void freeRetired(uint64_t safeFrame);

  HostMemory host_;
  Unique<GpuMemory> gpu_;
  Unique<AssetPool> assetPool_;
  Unique<UploadRing> uploads_;
  std::pmr::vector<void*> slotBlocks_; // objects, as the next ones
  Slot* freeSlots_ = nullptr;
  Slot *firstWorn_ = nullptr, *lastWorn_ = nullptr; ///< slots without generations left, in the order of their ends
  uint32_t wornSlots_ = 0;
  std::pmr::vector<Object*> living_;
  Object* retired_ = nullptr; // context
  std::atomic<uint64_t> current_{1}, safe_{0};
  bool begun_ = false;                                      ///< advance() was called
  mutable std::array<std::atomic<uint64_t>, 64> said_ = {}; ///< hashes, see isNew
  std::atomic<bool> lost_{false};
  bool ownsPipelineCache_ = false;
};

} // namespace gpgp::core
