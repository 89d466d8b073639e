// Assets and histories: objects with one device buffer, or a part of one that they share, whose contents arrive through
// gpgpRecordUpload.
//
// An asset's buffer receives bytes, a history's is cleared to zero. An object is resident from the recording that
// copied its last byte on; if that command buffer turns out never to have run, it is pending again. What is added later
// goes the same way, range by range, in the order in which ranges were queued.
#pragma once
#include "core/context.h"

#include <atomic>
#include <span>

namespace gpgp::core {

class Resident : public Object {
public:
  ~Resident() override;
  void attach() override;
  void retire() override;

  virtual bool resident() const { return hasArrived(queued_.load(std::memory_order_acquire)); }
  VkBuffer buffer() const { return buffer_ ? buffer_.handle() : place_.buffer; }
  VkDeviceSize bufferSize() const { return buffer_ ? buffer_.size() : place_.bufferSize; }
  VkDeviceSize offset() const { return place_.offset; } ///< in the buffer
  VkDeviceSize size() const { return size_; }

protected:
  /// Bytes to copy; the object keeps them until the copy is known to have run.
  Resident(Context& owner, Kind objectKind, const char* name)
      : Object(owner, objectKind, name), bytes_(&owner.host()), ranges_(&owner.host()) {}
  enum class Room { own, shared }; ///< a buffer of its own, or one of the context's pool
  /// Allocates the buffer. Either bytes (an asset), or an empty vector and a size to clear (a history). Sizes are
  /// rounded up to 16 bytes. Call once, at the end of the derived object's creation.
  Result<void> makeResident(GpgpService service, std::pmr::vector<std::byte> bytes, VkDeviceSize clearSize = 0,
                            Room room = Room::own);
  /// The same for contents that come in ranges: all bytes stay on the host, and nothing is queued.
  Result<void> makeGrowing(GpgpService service, VkDeviceSize size, Room room);
  /// The bytes of one that grows. A range may change once no upload of it is under way (hasSettled).
  std::span<std::byte> bytes() { return bytes_; }
  std::span<const std::byte> bytes() const { return bytes_; }
  /// Lets queue succeed as many times.
  void reserveRanges(size_t count) { ranges_.reserve(ranges_.size() + count); }
  /// Queues a range, of whole 16 bytes; returns its number, from 1 on.
  uint64_t queue(VkDeviceSize offset, VkDeviceSize size);
  /// Whether the copies of the range and of all before it are recorded.
  bool hasArrived(uint64_t number) const { return number <= arrived(); }
  uint64_t arrived() const { return arrived_.load(std::memory_order_acquire); } ///< the last one of which that is so
  /// Whether they are known to have run. (context)
  bool hasSettled(uint64_t number) const { return number < firstNumber_; }

private:
  friend class UploadRing;
  friend class Context;
  struct Range {
    VkDeviceSize offset, size, done;
    uint64_t first, last; // numbers of the upload recordings that hold its pieces; 0: none
    bool settled;
  };
  Result<void> allocate(GpgpService service, VkDeviceSize size, Room room);
  VkDeviceSize pending() const;
  void updateArrived();

  Buffer buffer_;          // its own, or
  AssetPool::Place place_; // its part of another
  GpgpService service_ = GPGP_SERVICE_CORE;
  bool pending_ = false; // its part counts as waiting for frames to be safe
  std::pmr::vector<std::byte> bytes_;
  VkDeviceSize size_ = 0;
  bool grows_ = false;
  std::pmr::vector<Range> ranges_; // queued and not known to have run, oldest first
  uint64_t firstNumber_ = 1;       // the oldest one's
  std::atomic<uint64_t> queued_{0}, arrived_{0};
  // Linked in the context's list while there are such ranges and the object has a handle. Both ask for the context's
  // objects to be locked.
  void link();
  void unlink();
  Resident *previous_ = nullptr, *next_ = nullptr;
  bool linked_ = false;
};

/// The staging ring behind gpgpRecordUpload.
class UploadRing {
public:
  static Result<Unique<UploadRing>> create(Context& context, VkDeviceSize bytes);
  virtual ~UploadRing() = default;

  /// Records copies and clears for pending objects within the budget. Returns bytes still pending.
  Result<VkDeviceSize> record(VkCommandBuffer commandBuffer, VkDeviceSize byteBudget);
  /// Harvests uploads of safe frames: those that never ran make their objects pending again.
  void advance();

private:
  friend Unique<UploadRing> makeUnique<UploadRing>(std::pmr::memory_resource&, Context&);
  explicit UploadRing(Context& context) : context_(context), records_(&context.host()) {}
  struct Record {
    uint64_t number = 0, frame = 0; // number 0: free
    VkDeviceSize ringEnd = 0;       // ring position after its bytes
  };
  uint32_t* marker(size_t record) const;

  Context& context_;
  Buffer ring_, markers_;
  std::pmr::vector<Record> records_;
  VkDeviceSize head_ = 0, tail_ = 0; // grow without bound; position modulo ring size
  uint64_t nextNumber_ = 1;
};

} // namespace gpgp::core
