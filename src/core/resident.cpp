#include "core/resident.h"

#include <algorithm>
#include <cstring>

namespace gpgp::core {
namespace {
constexpr VkDeviceSize kAlignment = 16; // of pieces and sizes: covers every copy and fill rule
} // namespace

Resident::~Resident() {
  {
    const std::lock_guard lock(context.objects);
    unlink();
  }
  if (!place_.buffer) return;
  context.assetPool().free(place_);
  if (pending_) context.gpu().count(service_, &GpgpServiceMemory::pendingBytes, -size_);
}

void Resident::attach() {
  if (!ranges_.empty()) link();
}

void Resident::link() { // oldest first: append
  if (linked_) return;
  previous_ = context.lastResident;
  next_ = nullptr;
  (previous_ ? previous_->next_ : context.residents) = this;
  context.lastResident = this;
  linked_ = true;
}

void Resident::unlink() {
  if (!linked_) return;
  linked_ = false;
  (previous_ ? previous_->next_ : context.residents) = next_;
  (next_ ? next_->previous_ : context.lastResident) = previous_;
}

void Resident::retire() {
  const std::lock_guard lock(context.objects);
  unlink();
  buffer_.markPending();
  if (!place_.buffer || pending_) return;
  context.gpu().count(service_, &GpgpServiceMemory::pendingBytes, size_);
  pending_ = true;
}

Result<void> Resident::allocate(GpgpService service, VkDeviceSize size, Room room) {
  size_ = (std::max<VkDeviceSize>(size, 1) + kAlignment - 1) / kAlignment * kAlignment;
  service_ = service;
  if (size_ > context.device.limits.maxStorageBufferRange)
    return makeError(GPGP_ERROR_UNSUPPORTED, "the %s needs %llu bytes, but this device binds at most %u",
                     kindName(kind), static_cast<unsigned long long>(size_),
                     context.device.limits.maxStorageBufferRange);
  if (room == Room::shared) {
    const auto place = context.assetPool().allocate(service, size_);
    if (!place) return place.error();
    place_ = *place;
    return {};
  }
  auto buffer =
      Buffer::create(context.device, context.gpu(), service, label.text, size_,
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryPlace::device);
  if (!buffer) return buffer.error();
  buffer_ = std::move(*buffer);
  return {};
}

Result<void> Resident::makeResident(GpgpService service, std::pmr::vector<std::byte> bytes, VkDeviceSize clearSize,
                                    Room room) {
  if (auto ok = allocate(service, bytes.empty() ? clearSize : bytes.size(), room); !ok) return ok;
  if (!bytes.empty()) bytes.resize(size_);
  bytes_ = std::move(bytes);
  reserveRanges(1); // not while the context is locked
  queue(0, size_);
  return {};
}

Result<void> Resident::makeGrowing(GpgpService service, VkDeviceSize size, Room room) {
  if (auto ok = allocate(service, size, room); !ok) return ok;
  bytes_.resize(size_);
  grows_ = true;
  return {};
}

uint64_t Resident::queue(VkDeviceSize offset, VkDeviceSize size) {
  const std::lock_guard lock(context.objects);
  ranges_.push_back({offset, size, 0, 0, 0, false});
  if (handle) link(); // else attach() does
  return queued_.fetch_add(1, std::memory_order_acq_rel) + 1;
}

VkDeviceSize Resident::pending() const {
  VkDeviceSize bytes = 0;
  for (const Range& range : ranges_) bytes += range.size - range.done;
  return bytes;
}

void Resident::updateArrived() {
  size_t i = 0;
  while (i < ranges_.size() && ranges_[i].done == ranges_[i].size) ++i;
  arrived_.store(firstNumber_ + i - 1, std::memory_order_release);
}

Result<Unique<UploadRing>> UploadRing::create(Context& context, VkDeviceSize bytes) {
  auto made = makeUnique<UploadRing>(context.host(), context);
  made->records_.resize(size_t(context.maxFramesInFlight) * context.maxRecordingsPerFrame);
  bytes = std::max<VkDeviceSize>((bytes + kAlignment - 1) / kAlignment * kAlignment, 4096);
  auto ring = Buffer::create(context.device, context.gpu(), GPGP_SERVICE_CORE, "upload ring", bytes,
                             VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryPlace::upload);
  if (!ring) return ring.error();
  made->ring_ = std::move(*ring);
  auto markers =
      Buffer::create(context.device, context.gpu(), GPGP_SERVICE_CORE, "upload markers",
                     made->records_.size() * kAlignment, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryPlace::readBack);
  if (!markers) return markers.error();
  made->markers_ = std::move(*markers);
  return made;
}

uint32_t* UploadRing::marker(size_t record) const {
  return reinterpret_cast<uint32_t*>(markers_.mapped() + record * kAlignment);
}

Result<VkDeviceSize> UploadRing::record(VkCommandBuffer commandBuffer, VkDeviceSize byteBudget) {
  const std::lock_guard lock(context_.objects);
  VkDeviceSize pending = 0;
  for (const Resident* r = context_.residents; r; r = r->next_) pending += r->pending();
  if (pending == 0) return VkDeviceSize(0);
  const auto free = std::find_if(records_.begin(), records_.end(), [](const Record& r) { return r.number == 0; });
  if (free == records_.end())
    return makeError(GPGP_ERROR_TOO_MANY_RECORDINGS,
                     "more than %zu uploads in flight (maxFramesInFlight x "
                     "maxRecordingsPerFrame)",
                     records_.size());
  const DeviceTable& vk = context_.device.vk;
  const uint64_t number = nextNumber_;
  VkDeviceSize budget = byteBudget ? std::max(byteBudget, kAlignment) : VK_WHOLE_SIZE;
  const VkDeviceSize ringSize = ring_.size();
  bool any = false, full = false;
  for (Resident* r = context_.residents; r && budget >= kAlignment && !full; r = r->next_) {
    for (Resident::Range& range : r->ranges_) {
      const VkDeviceSize before = range.done;
      if (before == range.size) continue;
      if (r->bytes_.empty()) { // a clear costs no ring
        vk.CmdFillBuffer(commandBuffer, r->buffer(), r->offset() + range.offset, range.size, 0);
        range.done = range.size;
      }
      while (range.done < range.size && budget >= kAlignment) {
        const VkDeviceSize at = head_ % ringSize, to = range.offset + range.done;
        VkDeviceSize piece = std::min({range.size - range.done, ringSize - at, ringSize - (head_ - tail_), budget});
        piece = piece / kAlignment * kAlignment;
        if (piece == 0) break;
        std::memcpy(ring_.mapped() + at, r->bytes_.data() + to, piece);
        const VkBufferCopy region{at, r->offset() + to, piece};
        vk.CmdCopyBuffer(commandBuffer, ring_.handle(), r->buffer(), 1, &region);
        head_ += piece, range.done += piece, budget -= piece;
      }
      full = range.done == before; // the ring, or the budget: keep the order
      if (full) break;
      any = true;
      if (range.first == 0) range.first = number;
      range.last = number;
    }
    r->updateArrived();
  }
  pending = 0;
  for (const Resident* r = context_.residents; r; r = r->next_) pending += r->pending();
  if (!any) return pending;

  const size_t index = static_cast<size_t>(free - records_.begin());
  *marker(index) = 0;
  vk.CmdFillBuffer(commandBuffer, markers_.handle(), index * kAlignment, 4, static_cast<uint32_t>(number));
  // The queue family is the engine's choice, so the stages are the ones that every family has.
  const VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_TRANSFER_WRITE_BIT,
                                VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT | VK_ACCESS_HOST_READ_BIT};
  vk.CmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, nullptr, 0,
                        nullptr);
  *free = {number, context_.current(), head_};
  ++nextNumber_;
  return pending;
}

void UploadRing::advance() {
  // In order of recording: the ring's tail may pass a recording only after all before it.
  for (;;) {
    Record* oldest = nullptr;
    for (Record& record : records_)
      if (record.number && (!oldest || record.number < oldest->number)) oldest = &record;
    if (!oldest || oldest->frame > context_.safe()) return;
    const size_t index = static_cast<size_t>(oldest - records_.data());
    const bool ran = *static_cast<volatile uint32_t*>(marker(index)) == static_cast<uint32_t>(oldest->number);
    const std::lock_guard lock(context_.objects);
    for (Resident *r = context_.residents, *next = nullptr; r; r = next) {
      next = r->next_;
      bool lost = false;
      for (Resident::Range& range : r->ranges_) {
        if (range.first == 0 || oldest->number < range.first || oldest->number > range.last) continue;
        if (!ran) {
          range.done = range.first = range.last = 0;
          lost = true;
        } else {
          range.settled = range.last == oldest->number && range.done == range.size;
        }
      }
      if (lost) {
        r->updateArrived();
        context_.message(GPGP_SEVERITY_WARNING, GPGP_NOT_EXECUTED, "gpgpAdvance", r->label.text,
                         "a recorded upload was never executed; it is pending again");
      }
      const auto open = std::find_if(r->ranges_.begin(), r->ranges_.end(),
                                     [](const Resident::Range& range) { return !range.settled; });
      r->firstNumber_ += static_cast<uint64_t>(open - r->ranges_.begin());
      r->ranges_.erase(r->ranges_.begin(), open);
      if (r->ranges_.empty()) {
        if (!r->grows_) r->bytes_ = std::pmr::vector<std::byte>(&context_.host());
        r->unlink();
      }
    }
    tail_ = oldest->ringEnd;
    *oldest = {};
  }
}

} // namespace gpgp::core
