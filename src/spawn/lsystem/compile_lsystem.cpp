// gpgpCompileLsystem.
#include "core/blob.h"
#include "spawn/lsystem/compile.h"

#include <gpgp/lsystem.h>

#include <cstdlib>
#include <cstring>
#include <new>

using namespace gpgp;

namespace {
constexpr size_t kMostText = size_t(1) << 24;

void report(const GpgpLsystemSource& source, const spawn::Diagnostic& d) {
  if (!source.messageFn) return;
  const GpgpCompileMessage message{
      source.name ? source.name : "", d.place.line, d.place.column, d.severity, d.text.c_str(), d.omitted};
  source.messageFn(source.messageUserData, &message);
}
GpgpResult fail(const GpgpLsystemSource& source, GpgpResult result, const char* text) {
  report(source, {{}, GPGP_SEVERITY_ERROR, text, 0});
  return result;
}
} // namespace

GpgpResult GPGP_CALL gpgpCompileLsystem(const GpgpLsystemSource* source, GpgpBlob* blob) {
  if (!source || !blob) return GPGP_ERROR_INVALID_ARGUMENT;
  if (source->sType != GPGP_STRUCTURE_LSYSTEM_SOURCE || source->pNext) return GPGP_ERROR_INVALID_STRUCT;
  try {
    if (!source->text && source->size) return fail(*source, GPGP_ERROR_INVALID_ARGUMENT, "text is NULL, size is not 0");
    if (source->size > kMostText) return fail(*source, GPGP_ERROR_INVALID_ARGUMENT, "the text is over 16 MiB");
    if (!source->variables && source->variableCount)
      return fail(*source, GPGP_ERROR_INVALID_ARGUMENT, "variables is NULL, variableCount is not 0");
    std::vector<spawn::lsystem::Override> overrides;
    for (uint32_t i = 0; i < source->variableCount; ++i) {
      if (!source->variables[i].name) return fail(*source, GPGP_ERROR_INVALID_ARGUMENT, "a variable's name is NULL");
      overrides.push_back({source->variables[i].name, source->variables[i].value});
    }
    spawn::Diagnostics diagnostics;
    const std::string_view text(source->text ? source->text : "", source->text ? source->size : 0);
    const auto words =
        spawn::lsystem::compile(text, overrides, diagnostics, {}, source->start ? source->start : std::string_view());
    for (const spawn::Diagnostic& d : diagnostics.sorted()) report(*source, d);
    if (!words) return GPGP_ERROR_INVALID_DATA;
    const GpgpBlob made = core::copyToBlob(std::as_bytes(std::span(*words)));
    if (!made.data) return fail(*source, GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of memory");
    *blob = made;
    return GPGP_SUCCESS;
  } catch (const std::bad_alloc&) {
    return GPGP_ERROR_OUT_OF_HOST_MEMORY;
  }
}
