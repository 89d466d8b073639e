#include "spawn/codegen/compile_kernel.h"

#include "shaders/spawn_kernel_sources.h"
#include "spawn/codegen/large_stack.h"

#include <glslang/Include/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <spirv-tools/optimizer.hpp>

#include <cstring>

namespace gpgp::spawn {
namespace {

/// Includes by path below shaders/, from the text that this library carries.
class Includer final : public glslang::TShader::Includer {
public:
  IncludeResult* includeLocal(const char* path, const char*, size_t) override {
    for (const EmbeddedShader& shader : spawn_kernel_sources)
      if (std::strcmp(shader.path, path) == 0)
        return new IncludeResult(path, shader.text, std::strlen(shader.text), nullptr);
    return nullptr;
  }
  void releaseInclude(IncludeResult* result) override { delete result; }
};

/// What our shaders use of a compiler's limits; devices are asked elsewhere.
TBuiltInResource resources() {
  TBuiltInResource limits{};
  limits.maxComputeWorkGroupCountX = limits.maxComputeWorkGroupCountY = limits.maxComputeWorkGroupCountZ = 65535;
  limits.maxComputeWorkGroupSizeX = limits.maxComputeWorkGroupSizeY = 1024;
  limits.maxComputeWorkGroupSizeZ = 64;
  limits.maxDrawBuffers = 1;
  limits.limits.nonInductiveForLoops = limits.limits.whileLoops = limits.limits.doWhileLoops = true;
  limits.limits.generalUniformIndexing = limits.limits.generalAttributeMatrixVectorIndexing = true;
  limits.limits.generalVaryingIndexing = limits.limits.generalSamplerIndexing = true;
  limits.limits.generalVariableIndexing = limits.limits.generalConstantMatrixVectorIndexing = true;
  return limits;
}

/// glslang counts its users in the process; here for as long as the library is loaded.
struct Process {
  Process() { glslang::InitializeProcess(); }
  ~Process() { glslang::FinalizeProcess(); }
};
} // namespace

std::string kernelText(const std::string& functions, KernelTarget target) {
  return std::string("#version 460\n"
                     "#extension GL_GOOGLE_include_directive : require\n"
                     "#extension GL_KHR_memory_scope_semantics : require\n") +
         (target != KernelTarget::any
              ? "#define GPGP_SUBGROUPS\n#extension GL_KHR_shader_subgroup_arithmetic : require\n"
                "#extension GL_KHR_shader_subgroup_ballot : require\n"
                "#extension GL_KHR_shader_subgroup_shuffle : require\n"
              : "") +
         (target == KernelTarget::software ? "#define GPGP_SOFTWARE\n" : "") +
         "#include \"spawn/shared/bindings.glsl\"\n"
         "#include \"spawn/kernel/table_format.h\"\n" +
         functions + "#include \"spawn/derive/derive.glsl\"\n";
}

std::span<const KernelTarget> targetsOf(const Graph& graph, Queues queues) {
  static constexpr KernelTarget kTargets[] = {KernelTarget::software, KernelTarget::subgroups, KernelTarget::any};
  return std::span(kTargets).subspan(graph.phases || queues == Queues::groups ? 1 : 0);
}

std::vector<uint32_t> optimize(std::span<const uint32_t> spirv, KernelTarget target) {
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
  optimizer.RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
  // Merged returns are what inlining needs.
  if (target != KernelTarget::software) optimizer.RegisterPass(spvtools::CreateMergeReturnPass());
  optimizer.RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
      .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
      .RegisterPass(spvtools::CreateSSARewritePass())
      .RegisterPass(spvtools::CreateAggressiveDCEPass());
  // Drivers inline and clean up as well, but start from less: measured 10 to 20 % faster kernels on hardware. Functions
  // are cleaned up before they are inlined, each once: all of it takes a quarter less time than the performance passes
  // alone. Software devices compile and run what is not inlined faster.
  if (target != KernelTarget::software) optimizer.RegisterPerformancePasses();
  std::vector<uint32_t> optimized;
  if (!optimizer.Run(spirv.data(), spirv.size(), &optimized)) optimized.clear();
  return optimized;
}

namespace {
core::Result<std::vector<uint32_t>> compile(const KernelSource& source, KernelTarget target) {
  static const Process process;
  static const TBuiltInResource limits = resources();
  const std::string text = kernelText(source.functions, target);
  const char* const texts[] = {text.c_str()};
  glslang::TShader shader(EShLangCompute);
  shader.setStrings(texts, 1);
  shader.setEnvInput(glslang::EShSourceGlsl, EShLangCompute, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_2);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_5);
  Includer includer;
  constexpr auto kMessages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
  if (!shader.parse(&limits, 460, false, kMessages, includer))
    return core::makeError(GPGP_ERROR_UNSUPPORTED, "the generated kernel does not compile: %.300s",
                           shader.getInfoLog());
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(kMessages))
    return core::makeError(GPGP_ERROR_UNSUPPORTED, "the generated kernel does not link: %.300s", program.getInfoLog());
  std::vector<uint32_t> words;
  glslang::GlslangToSpv(*program.getIntermediate(EShLangCompute), words);
  const std::vector<uint32_t> optimized = optimize(words, target);
  if (optimized.empty()) return core::makeError(GPGP_ERROR_UNSUPPORTED, "the generated kernel could not be optimised");
  std::vector<uint32_t> code{static_cast<uint32_t>(source.table.size())};
  code.insert(code.end(), source.table.begin(), source.table.end());
  code.insert(code.end(), optimized.begin(), optimized.end());
  return code;
}
} // namespace

core::Result<std::vector<uint32_t>> compileKernel(const KernelSource& source, KernelTarget target) {
  core::Result<std::vector<uint32_t>> code = core::makeError(GPGP_ERROR_UNSUPPORTED, "no thread to compile the kernel");
  onLargeStack([&] { code = compile(source, target); });
  return code;
}

std::string remarkOn(const KernelSource& source) {
  if (!source.byWords) return {};
  return std::to_string(source.byWords) +
         (isWorthCompiling(source) ? " operators of long chains are interpreted: kernels have no room for them"
                                   : " operators are of chains that kernels have no room for: this grammar is "
                                     "interpreted, and has no kernel");
}

} // namespace gpgp::spawn
