// Pictures on canvases that are made larger until a drawing fits.
#pragma once
#include "cli/shared/session.h"
#include "cli/shared/textures.h"
#include "cli/vector/options.h"

#include <gpgp/vector.hpp>

#include <array>
#include <optional>
#include <string>

namespace gpgp::cli {

/// One item, and the picture that it is drawn into.
struct CanvasPicture {
  const GpgpCanvasItem& item;
  const Textures& textures;
  const host::Image& target;
  Size size;
  std::array<float, 4> background;
  Antialiasing antialiasing;
};
Measured<GpgpCanvasReport> drawPicture(Session& session, Canvas& canvas, const CanvasPicture& picture, uint32_t repeat);

/// Room for layers to begin with, as far as the device binds it; a report says what is needed.
uint32_t firstLayerPixels(const host::HeadlessDevice& device, const Size& size);

/// A canvas for what a report says is needed, or as near to that as the device has room for; none where it has not.
/// `info`: of the canvas that reported; becomes that of the new one.
std::optional<Canvas> largerCanvas(Session& session, GpgpCanvasCreateInfo& info, const GpgpCanvasReport& report);

/// What is missing, and what would have held it. `said`: the budget was.
std::string omitted(const GpgpCanvasReport& report, uint32_t paths, bool said);

} // namespace gpgp::cli
