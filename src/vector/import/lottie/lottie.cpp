// The C functions of lottie.h: no context is needed, messages go to those who made the animation.
#include "api/check_struct.h"
#include "core/blob.h"
#include "vector/import/lottie/evaluate.h"
#include "vector/patch/drawing.h"

#include <gpgp/lottie.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

using namespace gpgp;
using core::makeError;
using core::Result;
using vector::lottie::Reporter;

namespace {

/// An animation behind its handle, and the frame that was evaluated last.
struct Lottie {
  static constexpr uint32_t kMagic = 0x6c6f7474; // "lott"
  uint32_t magic = kMagic;
  Reporter reporter;
  vector::lottie::Animation animation;
  vector::lottie::EvaluateInfo info;
  vector::svg::Imported frame;
  std::unique_ptr<vector::svg::ImportedViews> views;
};

Lottie* toLottie(GpgpLottie handle) {
  auto* lottie = reinterpret_cast<Lottie*>(handle);
  return lottie && lottie->magic == Lottie::kMagic ? lottie : nullptr;
}

/// Runs body() -> Result<void>; errors become a message and a result, nothing is thrown past the ABI.
template <class Body> GpgpResult guarded(const char* function, Reporter* reporter, Body&& body) noexcept {
  try {
    const Result<void> result = body();
    if (result) return GPGP_SUCCESS;
    if (reporter) reporter->error(result.error(), function);
    return result.error().code;
  } catch (...) {
    const core::Error error = makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of memory");
    try {
      if (reporter) reporter->error(error, function);
    } catch (...) { // no memory for the message either
    }
    return error.code;
  }
}

Result<void> evaluateInto(Lottie& lottie, double frame) {
  if (!std::isfinite(frame)) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "frame is not finite");
  lottie.views.reset();
  lottie.frame = {};
  lottie.frame = vector::lottie::evaluate(lottie.animation, frame, lottie.info, lottie.reporter);
  lottie.views = std::make_unique<vector::svg::ImportedViews>(lottie.frame);
  return {};
}

} // namespace

GpgpResult GPGP_CALL gpgpCreateLottie(const GpgpLottieSource* source, GpgpLottie* result) {
  if (!source || !result) return GPGP_ERROR_INVALID_ARGUMENT;
  if (source->sType != GPGP_STRUCTURE_LOTTIE_SOURCE || source->pNext) return GPGP_ERROR_INVALID_STRUCT;
  std::unique_ptr<Lottie> lottie;
  try {
    lottie.reset(new Lottie{
        Lottie::kMagic, Reporter(source->messageFn, source->messageUserData, source->name), {}, {}, {}, nullptr});
  } catch (...) {
    return GPGP_ERROR_OUT_OF_HOST_MEMORY;
  }
  return guarded("gpgpCreateLottie", &lottie->reporter, [&]() -> Result<void> {
    if (!source->data && source->size) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "data is NULL, size is not 0");
    if (!(source->scale >= 0 && source->scale <= 1e6f))
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "scale must be 0 to 1e6");
    if (source->fileSystem && !source->fileSystem->read)
      return makeError(GPGP_ERROR_INVALID_ARGUMENT, "fileSystem needs read");
    auto animation =
        vector::lottie::readAnimation({static_cast<const std::byte*>(source->data), source->data ? source->size : 0},
                                      {source->imageFn, source->imageUserData, source->fileSystem}, lottie->reporter);
    if (!animation) return animation.error();
    lottie->animation = std::move(*animation);
    if (source->scale > 0) lottie->info.scale = static_cast<double>(source->scale);
    lottie->info.text = {source->textFn, source->textUserData};
    *result = reinterpret_cast<GpgpLottie>(lottie.release());
    return {};
  });
}

void GPGP_CALL gpgpDestroyLottie(GpgpLottie handle) {
  Lottie* lottie = toLottie(handle);
  if (!lottie) return;
  lottie->magic = 0;
  delete lottie;
}

GpgpResult GPGP_CALL gpgpGetLottieInfo(GpgpLottie handle, GpgpLottieInfo* info) {
  const Lottie* lottie = toLottie(handle);
  if (!lottie) return GPGP_ERROR_INVALID_HANDLE;
  if (const auto good = api::checkStruct(info, GPGP_STRUCTURE_LOTTIE_INFO, "info"); !good) return good.error().code;
  const vector::lottie::Animation& animation = lottie->animation;
  info->width = static_cast<float>(animation.width);
  info->height = static_cast<float>(animation.height);
  info->frameRate = animation.rate;
  info->firstFrame = animation.in;
  info->endFrame = animation.out;
  info->layers = static_cast<uint32_t>(animation.layers);
  info->images = animation.imageCount;
  return GPGP_SUCCESS;
}

GpgpResult GPGP_CALL gpgpEvaluateLottie(GpgpLottie handle, double frame, GpgpLottieFrame* result) {
  Lottie* lottie = toLottie(handle);
  if (!lottie) return GPGP_ERROR_INVALID_HANDLE;
  return guarded("gpgpEvaluateLottie", &lottie->reporter, [&]() -> Result<void> {
    if (auto good = api::checkStruct(result, GPGP_STRUCTURE_LOTTIE_FRAME, "result"); !good) return good;
    if (auto good = evaluateInto(*lottie, frame); !good) return good;
    const vector::svg::ImportedViews& views = *lottie->views;
    result->paths = views.paths.data();
    result->pathCount = static_cast<uint32_t>(views.paths.size());
    result->groups = views.groups.data();
    result->groupCount = static_cast<uint32_t>(views.groups.size());
    result->content = vector::lottie::contentOf(lottie->frame);
    return {};
  });
}

GpgpResult GPGP_CALL gpgpCompileLottieFrame(GpgpLottie handle, double frame, const GpgpJobSystem* jobs,
                                            GpgpBlob* blob) {
  Lottie* lottie = toLottie(handle);
  if (!lottie) return GPGP_ERROR_INVALID_HANDLE;
  return guarded("gpgpCompileLottieFrame", &lottie->reporter, [&]() -> Result<void> {
    if (!blob) return makeError(GPGP_ERROR_INVALID_ARGUMENT, "blob is NULL");
    if (auto good = evaluateInto(*lottie, frame); !good) return good;
    std::pmr::memory_resource* memory = std::pmr::new_delete_resource();
    std::pmr::vector<vector::LeftEmpty> leftEmpty(memory);
    auto drawing = vector::makeDrawing(lottie->views->paths, lottie->views->groups, memory, jobs, &leftEmpty);
    if (!drawing) return drawing.error();
    for (const vector::LeftEmpty& left : leftEmpty)
      lottie->reporter.say(GPGP_SEVERITY_WARNING, GPGP_ERROR_UNSUPPORTED, {},
                           left.error.text + std::string("; not drawn"), "gpgpCompileLottieFrame");
    const float page[4] = {0, 0, static_cast<float>(lottie->animation.width),
                           static_cast<float>(lottie->animation.height)};
    std::copy_n(page, 4, drawing->viewport);
    const GpgpBlob made = core::newBlob(vector::bakedSize(*drawing));
    if (!made.data) return makeError(GPGP_ERROR_OUT_OF_HOST_MEMORY, "out of memory");
    vector::bake(*drawing, core::bytesOf(made));
    *blob = made;
    return {};
  });
}
