// The model and what of it is seen: gpgp visibility samples its triangles, the forward pass colours them.
#pragma once
#include "buffer_set.h"
#include "forward.h"
#include "gpgp_glue.h"
#include "scene.h"

#include <memory>

namespace mini {

class Sight {
public:
  Sight(Device& device, Gpgp& gpgp, const Forward& forward, Model model);
  Sight(const Sight&) = delete;
  Sight& operator=(const Sight&) = delete;
  /// Finds the triangles that this camera sees in a picture of this size.
  void prepare(VkCommandBuffer commands, const GpgpFrame& frame, const Camera& camera, VkExtent2D extent);
  /// Draws the model, visible triangles orange, from any camera.
  void draw(VkCommandBuffer commands, const Camera& camera);
  void collect();
  const GpgpVisibilityReport& report() const { return report_; }
  uint32_t reports() const { return reports_; }
  const Model& model() const { return model_; }

private:
  Gpgp& gpgp_;
  Model model_;
  Buffer positions_, normals_, indices_, draws_, visibleBits_;
  gpgp::GeometrySet geometry_;
  gpgp::VisibilityRecorder recorder_;
  gpgp::CameraHistory view_;
  std::unique_ptr<BufferSet> set_;
  Pipeline pipeline_;
  bool prepared_ = false;
  uint32_t reports_ = 0;
  GpgpVisibilityReport report_{};
};

} // namespace mini
