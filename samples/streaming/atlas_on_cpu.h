// gpgp's shader header on the processor: where a block lies, for those who store texels.
#pragma once
#include <glm/glm.hpp>

#include <algorithm>

#define GPGP_FN inline
#define GPGP_SHADER_BEGIN namespace streaming {
#define GPGP_SHADER_END }
namespace streaming {
using glm::uint;
using glm::uvec2;
using glm::vec2;
using glm::vec3;
using std::max;
} // namespace streaming
#include <gpgp/shaders/atlas.h>
#undef GPGP_FN
#undef GPGP_SHADER_BEGIN
#undef GPGP_SHADER_END
