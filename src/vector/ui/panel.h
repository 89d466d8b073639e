// Where a camera sees a panel on its canvas, and how deep.
#pragma once
#include <gpgp/ui.h>

namespace gpgp::vector {

/// False, and nothing is written, where a result is too large for a float.
bool placePanel(const GpgpPanel& panel, const float* viewProjection, const uint32_t* viewport, GpgpCanvasItem& item,
                float* clip);

} // namespace gpgp::vector
