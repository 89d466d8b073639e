/* gpgp core.hpp: the parts of the C++17 wrapper that all services share.
 *
 * The wrapper is header-only, allocates nothing and adds nothing to the C API:
 *   - Handles are move-only types that destroy the C handle they own.
 *   - Nothing throws. A function that can fail returns a GpgpResult or a Result<T>.
 *   - Each member calls the C function that its name or comment states. Threading, lifetimes, render-pass rules and
 *     command-buffer state are those of the C header.
 *
 *   auto info = gpgp::init<GpgpSpawnerCreateInfo>();  // sType is set, all other fields are zero
 *
 * Destroying a Context destroys everything made from it. Declare it before the other handles, so that it outlives them.
 */
#ifndef GPGP_CORE_HPP
#define GPGP_CORE_HPP

#include <gpgp/core.h>

#include <type_traits>
#include <utility>

namespace gpgp {

/// A value, or the result code that says why there is none: an error, or a status such as GPGP_NOT_READY.
///
///   auto spawner = gpgp::Spawner::create(context, info);
///   if (!spawner) return spawner.code();
///   spawner->prewarm();
template <class T> class [[nodiscard]] Result {
public:
  explicit Result(GpgpResult code, T value = T()) noexcept : code_(code), value_(std::move(value)) {}
  /// True if there is a value, which means that the code is GPGP_SUCCESS.
  explicit operator bool() const noexcept { return code_ == GPGP_SUCCESS; }
  GpgpResult code() const noexcept { return code_; }
  /// The name of the code, such as "GPGP_NOT_READY": a static string.
  const char* name() const noexcept { return gpgpResultString(code_); }
  /// The value; a null handle or a zeroed struct if there is none.
  T& operator*() & noexcept { return value_; }
  const T& operator*() const& noexcept { return value_; }
  T&& operator*() && noexcept { return std::move(value_); }
  T* operator->() noexcept { return &value_; }
  const T* operator->() const noexcept { return &value_; }

private:
  GpgpResult code_;
  T value_;
};

// ---------------------------------------------------------------- structs

/// The sType of a descriptor struct. It is not defined for other types.
template <class T> struct StructureType;
/// For the headers of this wrapper: each service's header names its structs with it.
#define GPGP_STRUCTURE_OF(Type, enumerator)                                                                            \
  template <> struct StructureType<Type> { static constexpr GpgpStructureType value = enumerator; }
GPGP_STRUCTURE_OF(GpgpContextCreateInfo, GPGP_STRUCTURE_CONTEXT_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpRequirementsInfo, GPGP_STRUCTURE_REQUIREMENTS_INFO);
GPGP_STRUCTURE_OF(GpgpRequirements, GPGP_STRUCTURE_REQUIREMENTS);
GPGP_STRUCTURE_OF(GpgpPrewarmInfo, GPGP_STRUCTURE_PREWARM_INFO);
GPGP_STRUCTURE_OF(GpgpTargetInfo, GPGP_STRUCTURE_TARGET_INFO);
GPGP_STRUCTURE_OF(GpgpMemoryReport, GPGP_STRUCTURE_MEMORY_REPORT);

/// A descriptor struct as its _INIT macro makes it: sType is set and all other fields are zero.
template <class T> T init() noexcept {
  T value = T();
  value.sType = StructureType<T>::value;
  return value;
}

// ---------------------------------------------------------------- handles

namespace detail {
/// Calls the C function that destroys a handle. Each service's header specialises it for its own handles.
template <class Raw> struct Destroy;
template <> struct Destroy<GpgpContext> {
  void operator()(GpgpContext handle) const noexcept { gpgpDestroyContext(handle); }
};
template <> struct Destroy<GpgpAsset> {
  void operator()(GpgpAsset handle) const noexcept { gpgpDestroyAsset(handle); }
};
template <> struct Destroy<GpgpRecorder> {
  void operator()(GpgpRecorder handle) const noexcept { gpgpDestroyRecorder(handle); }
};
template <> struct Destroy<GpgpHistory> {
  void operator()(GpgpHistory handle) const noexcept { gpgpDestroyHistory(handle); }
};
} // namespace detail

/// Owns one C handle and destroys it. It converts to the C handle, so it can be assigned to fields of the C structs.
template <class Raw> class Handle {
public:
  Handle() noexcept = default;
  explicit Handle(Raw raw) noexcept : raw_(raw) {}
  Handle(Handle&& other) noexcept : raw_(other.release()) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) reset(other.release());
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { reset(); }

  Raw get() const noexcept { return raw_; }
  operator Raw() const noexcept { return raw_; }
  /// Gives up ownership of the C handle, which the caller then destroys.
  [[nodiscard]] Raw release() noexcept { return std::exchange(raw_, Raw()); }
  /// Destroys the handle that is held, if any, and takes ownership of another one.
  void reset(Raw raw = Raw()) noexcept {
    if (raw_) detail::Destroy<Raw>()(raw_);
    raw_ = raw;
  }

private:
  Raw raw_ = Raw();
};

namespace detail {
/// Creates an object with a C function and wraps its handle in a T.
template <class T, class Raw, class Info>
Result<T> create(GpgpResult(GPGP_CALL* function)(GpgpContext, const Info*, Raw*), GpgpContext context,
                 const Info& info) noexcept {
  Raw raw = Raw();
  const GpgpResult code = function(context, &info, &raw);
  return Result<T>(code, T(raw));
}
/// Takes the oldest report of a recorder.
template <class Report>
Result<Report> report(GpgpResult(GPGP_CALL* function)(GpgpRecorder, Report*), GpgpRecorder recorder) noexcept {
  Report value = init<Report>();
  const GpgpResult code = function(recorder, &value);
  return Result<Report>(code, value);
}
} // namespace detail

/// The link to one device of the engine (gpgpCreateContext), and the functions that take it.
class Context : public Handle<GpgpContext> {
public:
  using Handle::Handle;
  static Result<Context> create(const GpgpContextCreateInfo& info) noexcept {
    GpgpContext raw = nullptr;
    const GpgpResult code = gpgpCreateContext(&info, &raw);
    return Result<Context>(code, Context(raw));
  }
  /// gpgpAdvance: once a frame, before anything is recorded in it.
  [[nodiscard]] GpgpResult advance(const GpgpFrame& frame) noexcept { return gpgpAdvance(get(), &frame); }
  void notifyDeviceLost() noexcept { gpgpNotifyDeviceLost(get()); }
  /// gpgpRecordUpload. The value is the number of bytes that are still pending. byteBudget 0: as many as staging memory
  /// has room for.
  Result<VkDeviceSize> recordUpload(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                    VkDeviceSize byteBudget = 0) noexcept {
    VkDeviceSize pending = 0;
    const GpgpResult code = gpgpRecordUpload(get(), commandBuffer, &frame, byteBudget, &pending);
    return Result<VkDeviceSize>(code, pending);
  }
  /// gpgpGetPipelineCacheData. size: in, the capacity of data; out, the size needed. data nullptr asks for the size.
  [[nodiscard]] GpgpResult pipelineCacheData(size_t& size, void* data) const noexcept {
    return gpgpGetPipelineCacheData(get(), &size, data);
  }
  Result<GpgpMemoryReport> memoryReport() const noexcept {
    GpgpMemoryReport value = init<GpgpMemoryReport>();
    const GpgpResult code = gpgpGetMemoryReport(get(), &value);
    return Result<GpgpMemoryReport>(code, value);
  }
};

/// Base of all assets: immutable input that recorders share.
class Asset : public Handle<GpgpAsset> {
public:
  using Handle::Handle;
  /// gpgpGetResidency: true once all data of the asset has been recorded for upload.
  Result<bool> resident() const noexcept {
    VkBool32 value = VK_FALSE;
    const GpgpResult code = gpgpGetResidency(get(), &value);
    return Result<bool>(code, value != VK_FALSE);
  }
};

/// Scratch memory that one recording needs: bytes, alignment in bytes, and usage flags of its buffer.
struct ScratchSize {
  VkDeviceSize size = 0, alignment = 0;
  VkBufferUsageFlags usage = 0;
};

/// Base of all recorders: pipelines and scratch for one kind of work.
class Recorder : public Handle<GpgpRecorder> {
public:
  using Handle::Handle;
  /// gpgpPrewarm for recorders that do not draw.
  [[nodiscard]] GpgpResult prewarm() noexcept { return gpgpPrewarm(get(), nullptr); }
  /// gpgpPrewarm with the render targets that a drawing recorder will draw into.
  [[nodiscard]] GpgpResult prewarm(const GpgpPrewarmInfo& info) noexcept { return gpgpPrewarm(get(), &info); }
  /// gpgpGetScratchSize
  Result<ScratchSize> scratchSize() const noexcept {
    ScratchSize value;
    const GpgpResult code = gpgpGetScratchSize(get(), &value.size, &value.alignment, &value.usage);
    return Result<ScratchSize>(code, value);
  }
  /// gpgpGetPasses. count: in, the capacity of names; out, the number of passes. names nullptr asks for the count.
  [[nodiscard]] GpgpResult passes(uint32_t& count, const char** names) const noexcept {
    return gpgpGetPasses(get(), &count, names);
  }
  /// gpgpGetPipelines. count: in, the capacity of infos; out, the number of pipelines. nullptr asks for the count.
  [[nodiscard]] GpgpResult pipelines(uint32_t& count, GpgpPipelineInfo* infos) const noexcept {
    return gpgpGetPipelines(get(), &count, infos);
  }
};

/// Base of all histories: what is kept from one recording to the next.
class History : public Handle<GpgpHistory> {
public:
  using Handle::Handle;
};

// ---------------------------------------------------------------- bytes (libgpgp_compiler)

/// Owns bytes that a function of libgpgp_compiler made, and frees them (gpgpFreeBlob).
class Blob {
public:
  Blob() noexcept = default;
  explicit Blob(GpgpBlob blob) noexcept : blob_(blob) {}
  Blob(Blob&& other) noexcept : blob_(std::exchange(other.blob_, GpgpBlob())) {}
  Blob& operator=(Blob&& other) noexcept {
    if (this != &other) {
      reset();
      blob_ = std::exchange(other.blob_, GpgpBlob());
    }
    return *this;
  }
  Blob(const Blob&) = delete;
  Blob& operator=(const Blob&) = delete;
  ~Blob() { reset(); }
  const void* data() const noexcept { return blob_.data; }
  size_t size() const noexcept { return blob_.size; }
  void reset() noexcept {
    if (blob_.data) gpgpFreeBlob(&blob_);
  }

private:
  GpgpBlob blob_ = GpgpBlob();
};

} // namespace gpgp

#endif
