// Canvases that are made larger until a drawing fits.
#pragma once
#include "cli/shared/session.h"

#include <gpgp/vector.hpp>

#include <optional>
#include <string>

namespace gpgp::cli {

/// A canvas for what a report says is needed, or as near to that as the device has room for; none where it has not.
/// `info`: of the canvas that reported; becomes that of the new one.
std::optional<Canvas> largerCanvas(Session& session, GpgpCanvasCreateInfo& info, const GpgpCanvasReport& report);

/// What is missing, and what would have held it. `said`: the budget was.
std::string omitted(const GpgpCanvasReport& report, uint32_t paths, bool said);

} // namespace gpgp::cli
