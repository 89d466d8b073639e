// Media queries (Media Queries 4) of a still picture on a screen.
#pragma once
#include <string_view>

namespace gpgp::vector::svg {

enum class Media {
  No,
  Yes,
  Unknown ///< depends on what is not known when a drawing is compiled, or is not supported
};

/// Whether one of the queries of a list holds; an empty list does.
Media evaluateMedia(std::string_view list);

} // namespace gpgp::vector::svg
