/* The engine's own glslang: compiles one shader, so that its symbols are linked and its state is used. */
#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>

int engineCompilesItsShaders(void);

int engineCompilesItsShaders(void) {
  glslang_input_t input = {0};
  glslang_shader_t* shader;
  int ok;
  if (!glslang_initialize_process()) return 0;
  input.language = GLSLANG_SOURCE_GLSL;
  input.stage = GLSLANG_STAGE_COMPUTE;
  input.client = GLSLANG_CLIENT_VULKAN;
  input.client_version = GLSLANG_TARGET_VULKAN_1_2;
  input.target_language = GLSLANG_TARGET_SPV;
  input.target_language_version = GLSLANG_TARGET_SPV_1_5;
  input.code = "#version 450\nlayout(local_size_x = 1) in;\nvoid main() {}\n";
  input.default_version = 450;
  input.default_profile = GLSLANG_NO_PROFILE;
  input.messages = GLSLANG_MSG_DEFAULT_BIT;
  input.resource = glslang_default_resource();
  shader = glslang_shader_create(&input);
  ok = glslang_shader_preprocess(shader, &input) && glslang_shader_parse(shader, &input);
  glslang_shader_delete(shader);
  glslang_finalize_process();
  return ok;
}
