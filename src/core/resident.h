// Assets and views: objects with one device buffer whose first contents arrive through gpgpRecordUpload.
//
// An asset's buffer receives bytes, a view's is cleared to zero. An object is resident from the record that copied
// its last byte on; if that command buffer turns out never to have run, it is pending again.
#pragma once
#include "core/context.h"

#include <atomic>

namespace gpgp::core {

class Resident : public Object {
public:
  ~Resident() override;
  void retire() override;

  bool resident() const { return uploaded_.load(std::memory_order_acquire) == size_; }
  VkBuffer buffer() const { return buffer_.handle(); }
  VkDeviceSize size() const { return size_; }

protected:
  /// Bytes to copy; the object keeps them until the copy is known to have run.
  Resident(Context& owner, Kind objectKind, const char* name)
      : Object(owner, objectKind, name), bytes_(&owner.host()) {}
  /// Allocates the buffer. Either bytes (an asset), or an empty vector and a size to clear (a view). Sizes are
  /// rounded up to 16 bytes. Call once, at the end of the derived object's creation.
  Result<void> makeResident(GpgpService service, std::pmr::vector<std::byte> bytes, VkDeviceSize clearSize = 0);

private:
  friend class UploadRing;
  friend class Context;
  Buffer buffer_;
  std::pmr::vector<std::byte> bytes_;
  VkDeviceSize size_ = 0;
  std::atomic<VkDeviceSize> uploaded_{0};
  uint64_t firstUpload_ = 0, lastUpload_ = 0; // numbers of the upload records that hold its pieces; 0: none
  // Linked in the context's list from creation until the upload is known to have run, or the handle is destroyed.
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
  uint32_t* stamp(size_t record) const;

  Context& context_;
  Buffer ring_, stamps_;
  std::pmr::vector<Record> records_;
  VkDeviceSize head_ = 0, tail_ = 0; // grow without bound; position modulo ring size
  uint64_t nextNumber_ = 1;
};

} // namespace gpgp::core
