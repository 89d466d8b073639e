// The engine's side of the contract: memory, messages, files.
#include "gpgp_glue.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>

namespace mini {
namespace {

void GPGP_CALL onSvgMessage(void*, const GpgpMessage* message) {
  std::fprintf(stderr, "svg: %s: %s\n", message->label, message->text);
}

} // namespace

GpgpGpuAllocator EngineMemory::callbacks() { return {this, allocate, free}; }

VkResult EngineMemory::allocate(void* user, const GpgpGpuAllocationRequest* request, GpgpGpuAllocation* allocation) {
  auto& self = *static_cast<EngineMemory*>(user);
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.allocationSize = request->requirements.size;
  try {
    info.memoryTypeIndex =
        self.device_.memoryType(request->requirements.memoryTypeBits, request->required, request->preferred);
  } catch (const std::runtime_error&) {
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  }
  *allocation = GpgpGpuAllocation{};
  VkResult result = vkAllocateMemory(self.device_.device, &info, nullptr, &allocation->memory);
  if (result == VK_SUCCESS && (request->required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT)) {
    result = vkMapMemory(self.device_.device, allocation->memory, 0, VK_WHOLE_SIZE, 0, &allocation->mapped);
    if (result != VK_SUCCESS) vkFreeMemory(self.device_.device, allocation->memory, nullptr);
  }
  if (result != VK_SUCCESS) return result;
  allocation->userData = reinterpret_cast<void*>(static_cast<uintptr_t>(info.allocationSize));
  self.bytes_ += info.allocationSize;
  ++self.allocations_;
  return VK_SUCCESS;
}

void EngineMemory::free(void* user, const GpgpGpuAllocation* allocation) {
  auto& self = *static_cast<EngineMemory*>(user);
  vkFreeMemory(self.device_.device, allocation->memory, nullptr); // unmaps as well
  self.bytes_ -= static_cast<VkDeviceSize>(reinterpret_cast<uintptr_t>(allocation->userData));
  --self.allocations_;
}

GpgpHostAllocator HostMemory::callbacks() { return {this, allocate, free}; }

void* HostMemory::allocate(void* user, size_t size, size_t alignment) {
  ++static_cast<HostMemory*>(user)->allocations_;
  return ::operator new (size, std::align_val_t{alignment}, std::nothrow);
}

void HostMemory::free(void*, void* memory, size_t, size_t alignment) {
  ::operator delete (memory, std::align_val_t{alignment});
}

Gpgp::Gpgp(Device& device, uint32_t framesInFlight) : memory(device), device_(device) {
  const GpgpGpuAllocator allocator = memory.callbacks();
  const GpgpHostAllocator hostAllocator = hostMemory.callbacks();
  auto info = gpgp::init<GpgpContextCreateInfo>();
  info.label = "mini engine";
  info.instance = device.instance;
  info.physicalDevice = device.physical;
  info.device = device.device;
  info.getInstanceProcAddr = vkGetInstanceProcAddr;
  info.apiVersion = VK_API_VERSION_1_2;
  info.features = device.gpgpFeatures;
  info.maxFramesInFlight = framesInFlight;
  info.gpuAllocator = &allocator;
  info.hostAllocator = &hostAllocator;
  info.messageFn = onMessage;
  info.messageUserData = this;
  context = take(gpgp::Context::create(info), "gpgpCreateContext");
}

void Gpgp::onMessage(void* user, const GpgpMessage* message) {
  if (message->severity == GPGP_SEVERITY_ERROR) static_cast<Gpgp*>(user)->lastError_ = message->text;
  std::fprintf(stderr, "gpgp: %s: %s%s%s\n", message->function, message->label, message->label[0] ? ": " : "",
               message->text);
}

GpgpResult Gpgp::check(GpgpResult result, const char* what) {
  if (result >= 0) return result;
  throw std::runtime_error(std::string(what) + ": " + gpgpResultString(result) +
                           (lastError_.empty() ? "" : ": " + lastError_));
}

GpgpRecorderCreateInfo Gpgp::recorder(const char* label) const {
  GpgpRecorderCreateInfo info{};
  info.label = label;
  info.queueFamily = device_.family;
  info.queueFlags = device_.queueFlags;
  info.engineScratch = VK_TRUE;
  return info;
}

void Gpgp::shareScratch(const gpgp::Recorder& recorder) {
  const gpgp::ScratchSize needs = take(recorder.scratchSize(), "gpgpGetScratchSize");
  scratchSize_.size = std::max(scratchSize_.size, needs.size);
  scratchSize_.usage |= needs.usage;
}

GpgpBuffer Gpgp::scratch() {
  if (!scratch_.handle) scratch_ = Buffer(device_, scratchSize_.size, scratchSize_.usage);
  return scratch_.forGpgp(kNoAccess, kNoAccess);
}

gpgp::Drawing Gpgp::loadSvg(const std::string& file, const char* label) {
  if (!fileExists(file)) {
    std::fprintf(stderr, "mini_engine: %s is not there (tests/data/fetch.sh fetches drawings); going on without it\n",
                 file.c_str());
    return {};
  }
  const std::vector<char> bytes = readFile(file);
  auto source = gpgp::init<GpgpSvgSource>();
  source.name = file.c_str();
  source.data = bytes.data();
  source.size = bytes.size();
  source.messageFn = onSvgMessage;
  const gpgp::Blob baked = take(gpgp::compileSvg(source), "gpgpCompileSvg");
  auto info = gpgp::init<GpgpDrawingCreateInfo>();
  info.label = label;
  info.data = baked.data();
  info.size = baked.size();
  info.hitTestable = VK_TRUE;
  return take(gpgp::Drawing::create(context, info), "gpgpCreateDrawing");
}

gpgp::GeometrySet Gpgp::geometrySet(const char* label, const std::vector<GpgpMesh>& meshes) {
  auto info = gpgp::init<GpgpGeometrySetCreateInfo>();
  info.label = label;
  info.meshes = meshes.data();
  info.meshCount = static_cast<uint32_t>(meshes.size());
  return take(gpgp::GeometrySet::create(context, info), "gpgpCreateGeometrySet");
}

std::vector<char> readFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool fileExists(const std::string& path) { return std::filesystem::is_regular_file(path); }

float linearFromSrgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

} // namespace mini
