// Where a camera sees a panel on its canvas, and how deep.
#pragma once
#include <gpgp/ui.h>

namespace gpgp::vector {

void placePanel(const GpgpPanel& panel, const float* viewProjection, const uint32_t* viewport, GpgpCanvasItem& item,
                float* clip);

} // namespace gpgp::vector
