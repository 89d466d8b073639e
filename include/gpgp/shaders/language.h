// Lets one text be GLSL and HLSL: the names of types and functions in which the two differ.
//
// GLSL is the default. HLSL needs GPGP_HLSL defined, as in `glslangValidator -D -DGPGP_HLSL=1` or `dxc -D GPGP_HLSL=1`.
#ifndef GPGP_SHADERS_LANGUAGE_H
#define GPGP_SHADERS_LANGUAGE_H

#ifndef __cplusplus
#ifdef GPGP_HLSL
#define vec2 float2
#define vec3 float3
#define vec4 float4
#define uvec2 uint2
#define uvec4 uint4
#define mix lerp
#define floatBitsToUint asuint
#define uintBitsToFloat asfloat
#define matrix gpgpMatrix // a keyword
#define GPGP_CONST static const
#endif
#ifndef GPGP_CONST
#define GPGP_CONST const
#endif
#ifndef GPGP_FN
#define GPGP_FN
#define GPGP_OUT(T) out T
#define GPGP_PRECISE precise
#define GPGP_SHADER_BEGIN
#define GPGP_SHADER_END
#endif
#endif

#endif
