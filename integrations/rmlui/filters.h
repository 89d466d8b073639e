// RmlUi's filters and gradients by their names and parameters.
#pragma once
#include "frame.h"

#include <RmlUi/Core/Dictionary.h>
#include <RmlUi/Core/Types.h>

namespace gpgp::rmlui {

/// Null: there is no such filter here.
FilterPointer makeFilter(const Rml::String& name, const Rml::Dictionary& parameters);
/// Null: there is no such shader here.
PaintPointer makeGradient(const Rml::String& name, const Rml::Dictionary& parameters);

} // namespace gpgp::rmlui
