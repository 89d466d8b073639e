// The inventory's frame: a small picture made here, to be drawn as a nine-slice whose sides and middle repeat.
#pragma once
#include "device.h"

namespace mini {

class FramePicture {
public:
  explicit FramePicture(Device& device);
  ~FramePicture();
  FramePicture(const FramePicture&) = delete;
  FramePicture& operator=(const FramePicture&) = delete;
  /// To be sampled in compute shaders.
  GpgpCanvasImage image() const {
    return {image_.view, recorder_,         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
            VK_FALSE,    GPGP_IMAGE_LINEAR, GPGP_IMAGE_FILTER_LINEAR};
  }

  static constexpr uint32_t kSide = 32, kBorder = 12; // texels

private:
  Device& device_;
  Image image_;
  VkSampler recorder_ = VK_NULL_HANDLE;
};

} // namespace mini
