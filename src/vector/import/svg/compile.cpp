// gpgpCompileSvg: SVG to a baked drawing.
#include "core/blob.h"
#include "vector/import/svg/import.h"
#include "vector/patch/patches.h"

#include <chrono>

using namespace gpgp;

namespace {
using vector::svg::Reporter;

constexpr float kMaxScale = 1e6f;

GpgpResult compile(const GpgpSvgSource& source, GpgpBlob& blob, Reporter& reporter) {
  const auto fail = [&reporter](GpgpResult code, const char* text) { return reporter.error(text, code), code; };
  if (!source.data && source.size) return fail(GPGP_ERROR_INVALID_ARGUMENT, "data is NULL, size is not 0");
  if (!(source.scale >= 0 && source.scale <= kMaxScale))
    return fail(GPGP_ERROR_INVALID_ARGUMENT, "scale must be 0 to 1e6");
  if (source.methods & ~(GPGP_DRAWING_FLATTENED | GPGP_DRAWING_IN_PASS))
    return fail(GPGP_ERROR_INVALID_ARGUMENT, "methods has unknown bits");
  if (source.fileSystem && !source.fileSystem->read) return fail(GPGP_ERROR_INVALID_ARGUMENT, "fileSystem needs read");
  using Clock = std::chrono::steady_clock;
  const auto milliseconds = [](Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
  };
  vector::svg::ImportDetail detail;
  if (source.scale > 0) detail.scale = static_cast<double>(source.scale);
  detail.layers = !(source.methods & GPGP_DRAWING_IN_PASS); // patches have none
  const auto begin = Clock::now();
  const auto imported = vector::svg::importSvg(
      {static_cast<const std::byte*>(source.data), source.data ? source.size : 0}, reporter, {},
      {source.imageFn, source.imageUserData}, detail, source.fileSystem, {source.textFn, source.textUserData});
  if (!imported) return fail(imported.error().code, imported.error().text);
  std::pmr::memory_resource* memory = std::pmr::new_delete_resource();
  const vector::svg::ImportedViews views(*imported);
  const std::vector<GpgpPath>& paths = views.paths;
  const auto parsed = Clock::now();
  std::pmr::vector<vector::LeftEmpty> leftEmpty(memory);
  const uint64_t outlines = vector::outlineBytes(source.maxStorageBufferRange);
  auto drawing = vector::makeDrawing(paths, views.groups, memory, source.jobSystem, &leftEmpty,
                                     source.methods == GPGP_DRAWING_IN_PASS ? UINT64_MAX : outlines);
  const auto converted = Clock::now();
  for (const vector::LeftEmpty& left : leftEmpty) {
    const auto& path = (left.group ? imported->groups[left.group - 1].clip : imported->paths)[left.index];
    reporter.error(path.place, path.element + ": " + left.error.text + (left.refused ? "" : "; not drawn"),
                   left.error.code);
    if (left.refused) return left.error.code;
  }
  if (!drawing) return fail(drawing.error().code, drawing.error().text);
  if (imported->width > 0 && imported->height > 0) {
    const double page[4] = {0, 0, imported->width, imported->height};
    for (size_t i = 0; i < 4; ++i) drawing->viewport[i] = static_cast<float>(page[i]);
  }
  const GpgpSvgReport counts{static_cast<uint32_t>(drawing->paths.size()),
                             static_cast<uint32_t>(drawing->curves.size()),
                             static_cast<uint32_t>(drawing->patches.size()), 0, 0};
  if (source.methods & GPGP_DRAWING_IN_PASS) {
    auto patches = vector::makePatches(*drawing, memory);
    if (!patches) return fail(patches.error().code, patches.error().text);
    for (const vector::Patches::LeftOut& left : patches->leftOut) {
      const auto& path = imported->paths[left.path];
      reporter.warn(path.place, path.element + ": left out of the patches: " + left.reason);
    }
    drawing->words = std::move(patches->words);
  }
  vector::Drawing kept = source.stageFn ? vector::Drawing(*drawing) : std::move(*drawing); // stages show all of it
  if (source.methods == GPGP_DRAWING_IN_PASS) kept.curves.clear(), kept.patches.clear();
  const GpgpBlob made = core::newBlob(vector::bakedSize(kept));
  if (!made.data) return fail(GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of memory");
  vector::bake(kept, core::bytesOf(made));
  blob = made;
  if (source.report)
    *source.report = {counts.paths, counts.curves, counts.patches,
                      milliseconds(begin, parsed) - imported->strokeMilliseconds,
                      milliseconds(parsed, converted) + imported->strokeMilliseconds};
  if (source.stageFn) {
    const auto show = [&source](const char* stage, const std::pmr::string& svg) {
      source.stageFn(source.stageUserData, stage, svg.data(), svg.size());
    };
    show("paths", vector::pathsToSvg(paths, memory));
    show("pieces", vector::piecesToSvg(paths, memory));
    show("crossings", vector::crossingsToSvg(paths, memory));
    show("patches", vector::patchesToSvg(paths, *drawing, memory));
  }
  return GPGP_SUCCESS;
}
} // namespace

GpgpResult GPGP_CALL gpgpCompileSvg(const GpgpSvgSource* source, GpgpBlob* blob) {
  if (!source || !blob) return GPGP_ERROR_INVALID_ARGUMENT;
  if (source->sType != GPGP_STRUCTURE_SVG_SOURCE || source->pNext) return GPGP_ERROR_INVALID_STRUCT;
  try {
    Reporter reporter(source->messageFn, source->messageUserData, source->name);
    return compile(*source, *blob, reporter);
  } catch (...) { // bad_alloc; nothing else is thrown. There may be no memory for a message's parts
    const GpgpMessage message{GPGP_SEVERITY_ERROR, GPGP_ERROR_OUT_OF_HOST_MEMORY, "gpgpCompileSvg",
                              source->name ? source->name : "", "out of memory"};
    if (source->messageFn) source->messageFn(source->messageUserData, &message);
    return GPGP_ERROR_OUT_OF_HOST_MEMORY;
  }
}
