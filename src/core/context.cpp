#include "core/context.h"

#include "core/open_file.h"
#include "core/recorder.h"
#include "core/requirements.h"
#include "core/resident.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace gpgp::core {

namespace {
/// The deleter lies in the object, so it is taken out first.
void destroyObject(Object* object) {
  const PmrDelete deleter = object->deleter;
  deleter(object);
}

/// Whether data begins as a cache of this device and driver does. Drivers must find out for themselves, but some do not
/// survive what is cut or another's.
bool isCacheOf(const VkPhysicalDeviceProperties& device, const void* data, size_t size) {
  struct {
    uint32_t size, version, vendor, device;
    uint8_t uuid[VK_UUID_SIZE];
  } header; // VkPipelineCacheHeaderVersionOne
  if (size < sizeof header) return false;
  std::memcpy(&header, data, sizeof header);
  return header.size >= sizeof header && header.size <= size &&
         header.version == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendor == device.vendorID &&
         header.device == device.deviceID && std::memcmp(header.uuid, device.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}
} // namespace

const char* kindName(Kind kind) {
  switch (kind) {
  case Kind::none: return "destroyed object";
  case Kind::grammar: return "grammar";
  case Kind::lsystem: return "L-system";
  case Kind::drawing: return "drawing";
  case Kind::glyphSet: return "glyph set";
  case Kind::list: return "list";
  case Kind::geometrySet: return "geometry set";
  case Kind::spawner: return "spawner";
  case Kind::lsystemRecorder: return "L-system recorder";
  case Kind::canvas: return "canvas";
  case Kind::patchRecorder: return "patch recorder";
  case Kind::visibilityRecorder: return "visibility recorder";
  case Kind::canvasHistory: return "canvas history";
  case Kind::cameraHistory: return "camera history";
  case Kind::atlasRecorder: return "shading atlas recorder";
  case Kind::atlas: return "shading atlas";
  case Kind::tileSet: return "tile set";
  }
  return "unknown object";
}

Context::Context(const GpgpContextCreateInfo& info)
    : label(info.label), messageFn(info.messageFn), messageUserData(info.messageUserData),
      maxFramesInFlight(info.maxFramesInFlight ? info.maxFramesInFlight : 3),
      maxRecordingsPerFrame(info.maxRecordingsPerFrame ? info.maxRecordingsPerFrame : 16),
      jobSystem(info.jobSystem ? *info.jobSystem : GpgpJobSystem{}),
      fileSystem(info.fileSystem ? *info.fileSystem : GpgpFileSystem{}), host_(info.hostAllocator), slotBlocks_(&host_),
      living_(&host_) {}

Result<Context*> Context::create(const GpgpContextCreateInfo& info) {
  // The context owns its HostMemory, so its own storage comes from the callbacks directly.
  HostMemory bootstrap(info.hostAllocator);
  void* storage = bootstrap.allocate(sizeof(Context), alignof(Context));
  Context* context = nullptr;
  try {
    context = new (storage) Context(info);
    const auto made = context->initialise(info);
    if (made) return context;
    context->~Context();
    bootstrap.deallocate(storage, sizeof(Context), alignof(Context));
    return made.error();
  } catch (...) {
    if (context) context->~Context();
    bootstrap.deallocate(storage, sizeof(Context), alignof(Context));
    throw;
  }
}

void Context::destroy(Context* context) {
  const GpgpHostAllocator callbacks = context->host_.callbacks();
  HostMemory bootstrap(callbacks.allocate ? &callbacks : nullptr);
  context->~Context();
  context->magic = 0;
  bootstrap.deallocate(context, sizeof(Context), alignof(Context));
}

Result<void> Context::initialise(const GpgpContextCreateInfo& info) {
  device.instance = info.instance;
  device.physicalDevice = info.physicalDevice;
  device.device = info.device;
  device.features = info.features;
  const auto vki = loadInstanceTable(info.instance, info.getInstanceProcAddr);
  if (!vki) return vki.error();
  device.vki = *vki;
  if (auto ok = checkFeatures(device.vki, info.physicalDevice, info.features); !ok) return ok;
  const auto vk = loadDeviceTable(device.vki, info.device, device.has(GPGP_FEATURE_DEBUG_UTILS));
  if (!vk) return vk.error();
  device.vk = *vk;
  VkPhysicalDeviceSubgroupProperties subgroups{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
  VkPhysicalDeviceSubgroupSizeControlProperties sizes{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES, &subgroups};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &sizes};
  device.vki.GetPhysicalDeviceProperties2(device.physicalDevice, &properties);
  device.limits = properties.properties.limits;
  device.vendor = properties.properties.vendorID;
  device.model = properties.properties.deviceID;
  device.subgroupArithmetic = (subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) &&
                              (subgroups.supportedOperations & VK_SUBGROUP_FEATURE_ARITHMETIC_BIT) &&
                              (subgroups.supportedOperations & VK_SUBGROUP_FEATURE_BALLOT_BIT) &&
                              (subgroups.supportedOperations & VK_SUBGROUP_FEATURE_SHUFFLE_BIT);
  if (sizes.minSubgroupSize == sizes.maxSubgroupSize) device.subgroupSize = sizes.maxSubgroupSize;
  device.software = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  if (device.software) device.subgroupSize = subgroups.subgroupSize; // theirs is a vector's

  gpu_ = makeUnique<GpuMemory>(host_, device, host_, info.gpuAllocator);
  assetPool_ = makeUnique<AssetPool>(host_, device, *gpu_, host_);
  if (info.pipelineCache) {
    pipelineCache = info.pipelineCache;
  } else {
    VkPipelineCacheCreateInfo cacheInfo{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    if (info.pipelineCacheSize && info.pipelineCacheData) {
      if (isCacheOf(properties.properties, info.pipelineCacheData, info.pipelineCacheSize)) {
        cacheInfo.initialDataSize = info.pipelineCacheSize;
        cacheInfo.pInitialData = info.pipelineCacheData;
      } else {
        message(GPGP_SEVERITY_INFO, GPGP_ERROR_INVALID_DATA, "gpgpCreateContext", label.text,
                "pipelineCacheData is cut, or of another device or driver; the cache begins empty");
      }
    }
    const VkResult result = device.vk.CreatePipelineCache(device.device, &cacheInfo, nullptr, &pipelineCache);
    if (result != VK_SUCCESS) return vulkanError(result, "vkCreatePipelineCache");
    ownsPipelineCache_ = true;
  }
  auto uploads = UploadRing::create(*this, info.uploadRingBytes ? info.uploadRingBytes : VkDeviceSize(8) << 20);
  if (!uploads) return uploads.error();
  uploads_ = std::move(*uploads);
  return {};
}

Context::~Context() {
  for (Object* object : living_) destroyObject(object);
  freeRetired(UINT64_MAX);
  uploads_.reset();
  if (ownsPipelineCache_) device.vk.DestroyPipelineCache(device.device, pipelineCache, nullptr);
  assetPool_.reset();
  gpu_.reset();
  for (void* block : slotBlocks_) host_.deallocate(block, sizeof(Slot) * 64, alignof(Slot));
}

void Context::message(GpgpSeverity severity, GpgpResult code, const char* function, const char* objectLabel,
                      const char* text) const {
  if (!messageFn) return;
  const GpgpMessage message{severity, code, function, objectLabel ? objectLabel : "", text};
  messageFn(messageUserData, &message);
}

Slot* Context::adopt(Unique<Object> object) {
  const std::lock_guard lock(objects);
  if (living_.size() == living_.capacity()) living_.reserve(std::max<size_t>(64, 2 * living_.size()));
  if (!freeSlots_ && wornSlots_ > kWornSlots) { // the one that has waited longest begins anew
    Slot* const slot = firstWorn_;
    firstWorn_ = slot->nextFree;
    --wornSlots_;
    slot->generation = 0;
    slot->nextFree = nullptr;
    freeSlots_ = slot;
  }
  if (!freeSlots_) {
    slotBlocks_.reserve(slotBlocks_.size() + 1);
    Slot* block = static_cast<Slot*>(host_.allocate(sizeof(Slot) * 64, alignof(Slot)));
    slotBlocks_.push_back(block);
    for (uint32_t i = 0; i < 64; ++i) {
      new (&block[i]) Slot();
      block[i].context = this;
      block[i].nextFree = freeSlots_;
      freeSlots_ = &block[i];
    }
  }
  Slot* slot = freeSlots_;
  freeSlots_ = slot->nextFree;
  object->deleter = object.get_deleter();
  object->handle = slot;
  slot->object = object.release();
  slot->object->livingIndex = living_.size();
  living_.push_back(slot->object);
  slot->object->attach();
  return slot;
}

void Context::retire(Object& object) {
  {
    const std::lock_guard lock(objects);
    Slot& slot = *object.handle;
    slot.object = nullptr;
    if (++slot.generation < alignof(Slot)) {
      slot.nextFree = freeSlots_;
      freeSlots_ = &slot;
    } else {
      slot.nextFree = nullptr;
      (wornSlots_++ ? lastWorn_->nextFree : firstWorn_) = &slot;
      lastWorn_ = &slot;
    }
    living_[object.livingIndex] = living_.back();
    living_[object.livingIndex]->livingIndex = object.livingIndex;
    living_.pop_back();
  }
  object.retire();
  object.destroyedInFrame = current();
  object.next = retired_;
  retired_ = &object;
  if (lost()) freeRetired(UINT64_MAX);
}

void Context::freeRetired(uint64_t safeFrame) {
  Object** link = &retired_;
  while (Object* object = *link) {
    if (object->destroyedInFrame > safeFrame) {
      link = &object->next;
      continue;
    }
    *link = object->next;
    destroyObject(object);
  }
}

void Context::setLost() {
  lost_.store(true, std::memory_order_relaxed);
  freeRetired(UINT64_MAX);
}

Result<void> Context::advance(const GpgpFrame& frame) {
  if (frame.safe >= frame.current)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "frame.safe (%llu) must be below frame.current (%llu)",
                     static_cast<unsigned long long>(frame.safe), static_cast<unsigned long long>(frame.current));
  if (frame.current < current() || frame.safe < safe())
    return makeError(GPGP_ERROR_INVALID_ARGUMENT, "frame numbers only grow: the last was {%llu, %llu}",
                     static_cast<unsigned long long>(current()), static_cast<unsigned long long>(safe()));
  if (frame.current - frame.safe > maxFramesInFlight)
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "frame.current - frame.safe is %llu, but the context was made for %u frames in flight",
                     static_cast<unsigned long long>(frame.current - frame.safe), maxFramesInFlight);
  current_.store(frame.current, std::memory_order_relaxed);
  safe_.store(frame.safe, std::memory_order_relaxed);
  begun_ = true;
  uploads_->advance();
  for (Recorder* recorder = recorders; recorder; recorder = recorder->nextRecorder()) recorder->advance();
  freeRetired(frame.safe);
  return {};
}

bool Context::isNew(std::initializer_list<const char*> texts) const {
  uint64_t hash = 0xcbf29ce484222325; // FNV-1a, a zero between texts
  for (const char* text : texts) {
    for (; *text; ++text) hash = (hash ^ static_cast<unsigned char>(*text)) * 0x100000001b3;
    hash *= 0x100000001b3;
  }
  return said_[hash % said_.size()].exchange(hash, std::memory_order_relaxed) != hash;
}

Result<void> Context::checkFrame(const GpgpFrame* frame) const {
  if (!frame) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "frame is NULL");
  if (!begun_) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "no frame has begun; call gpgpAdvance first");
  if (frame->current != current() || frame->safe != safe())
    return makeError(GPGP_ERROR_INVALID_ARGUMENT,
                     "frame {%llu, %llu} is not the one of the last gpgpAdvance, {%llu, %llu}",
                     static_cast<unsigned long long>(frame->current), static_cast<unsigned long long>(frame->safe),
                     static_cast<unsigned long long>(current()), static_cast<unsigned long long>(safe()));
  return {};
}

Result<std::pmr::vector<std::byte>> Context::readFile(const char* path) {
  std::pmr::vector<std::byte> bytes(&host_);
  if (fileSystem.read) {
    size_t size = 0;
    GpgpResult result = fileSystem.read(fileSystem.userData, path, nullptr, 0, &size);
    if (result == GPGP_SUCCESS) {
      bytes.resize(size);
      size_t again = size;
      result = fileSystem.read(fileSystem.userData, path, bytes.data(), size, &again);
      if (result == GPGP_SUCCESS && again != size)
        return makeError(GPGP_ERROR_IO, "%s: changed while it was read", path);
    }
    if (result != GPGP_SUCCESS)
      return makeError(GPGP_ERROR_IO, "%s: the engine's file callback returned %s", path, gpgpResultString(result));
    return bytes;
  }
  const File file = openToRead(path);
  if (!file) return makeError(GPGP_ERROR_IO, "%s: cannot be opened", path);
  for (;;) {
    constexpr size_t kPiece = 1 << 16;
    const size_t old = bytes.size();
    bytes.resize(old + kPiece);
    const size_t got = std::fread(bytes.data() + old, 1, kPiece, file.get());
    bytes.resize(old + got);
    if (got < kPiece) break;
  }
  if (std::ferror(file.get())) return makeError(GPGP_ERROR_IO, "%s: cannot be read", path);
  return bytes;
}

} // namespace gpgp::core
