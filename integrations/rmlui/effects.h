// RmlUi's font effects by their parameters instead of bitmaps.
#pragma once
#include "frame.h"

#include <RmlUi/Core/FontEffect.h>

namespace gpgp::rmlui {

/// The glyphs once more, in the effect's colour.
struct Effect final : Rml::FontEffect {
  TextStyle style;
  float x = 0, y = 0; ///< moved
};

/// Registered in place of RmlUi's own: shadow, outline, glow, blur. Until Rml::Shutdown.
class EffectInstancers {
public:
  EffectInstancers();
  ~EffectInstancers();
  EffectInstancers(const EffectInstancers&) = delete;
  EffectInstancers& operator=(const EffectInstancers&) = delete;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace gpgp::rmlui
