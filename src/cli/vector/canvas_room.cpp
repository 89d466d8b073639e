#include "cli/vector/canvas_room.h"

#include <algorithm>

namespace gpgp::cli {

Measured<GpgpCanvasReport> drawPicture(Session& session, Canvas& canvas, const CanvasPicture& picture,
                                       uint32_t repeat) {
  const GpgpAccess after{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
  return session.measure(canvas, "rasterising", repeat,
                         [&](VkCommandBuffer commands, const GpgpFrame& frame, const GpgpRecordingInfo& base) {
                           GpgpCanvasInfo info = GPGP_CANVAS_INFO_INIT;
                           info.base = base;
                           info.width = picture.size.width;
                           info.height = picture.size.height;
                           info.items = &picture.item;
                           info.itemCount = 1;
                           info.images = picture.textures.views().data();
                           info.imageCount = static_cast<uint32_t>(picture.textures.views().size());
                           info.samples = picture.antialiasing.samples;
                           info.exactArea = picture.antialiasing.area ? VK_TRUE : VK_FALSE;
                           std::copy(picture.background.begin(), picture.background.end(), info.background);
                           info.target = picture.target.target({}, after);
                           info.encodeSrgb = info.blendSrgb = VK_TRUE;
                           return canvas.recordPrepare(commands, frame, info);
                         });
}

uint32_t firstLayerPixels(const host::HeadlessDevice& device, const Size& size) {
  const uint64_t pixels = uint64_t(size.width + 128) * (size.height + 128) * 4;
  return static_cast<uint32_t>(std::min<uint64_t>(pixels, device.properties().limits.maxStorageBufferRange / 8));
}

std::optional<Canvas> largerCanvas(Session& session, GpgpCanvasCreateInfo& info, const GpgpCanvasReport& report) {
  const auto wanted = [](uint32_t needed, uint32_t given, double share) {
    // Somewhat more than is needed: what had no tile words has not been asked for its entries.
    const double more = needed > given ? 1.125 * static_cast<double>(needed) - static_cast<double>(given) : 0;
    return static_cast<uint32_t>(std::min(static_cast<double>(given) + more * share, static_cast<double>(1u << 28)));
  };
  // Eighths of what is missing, of both: as many as there is room for, and rather of words, which come first.
  for (int eighths = 16; eighths > 0; --eighths)
    for (int ofWords = std::min(eighths, 8); ofWords >= 0 && eighths - ofWords <= 8; --ofWords) {
      GpgpCanvasCreateInfo next = info;
      next.maxPaths = std::max(info.maxPaths, report.paths);
      next.maxTileEntries = wanted(report.tileEntries, report.tileEntriesGiven, (eighths - ofWords) / 8.0);
      next.maxTileWords = wanted(report.tileWords, report.tileWordsGiven, ofWords / 8.0);
      next.maxDrawings = std::max(info.maxDrawings, std::min(report.items, 65536u));
      if (report.tilePatches > report.tilePatchesGiven)
        next.maxTilePatches = std::min(report.tilePatches + report.tilePatches / 8, 1u << 28);
      if (report.layerPixels != UINT32_MAX && report.layerPixels > report.layerPixelsGiven) { // which no budget holds
        const uint32_t most = std::min(1u << 28, session.device().properties().limits.maxStorageBufferRange / 8);
        const uint32_t needed = std::min(report.layerPixels, 1u << 28);
        next.maxLayerPixels = std::max(needed, std::min(needed * 2, most)); // with more, operations run side by side
      }
      next.maxLayerOperations = std::max(info.maxLayerOperations, std::min(report.layerOperations, 65536u));
      if (report.imagePixels > report.imagePixelsGiven) next.maxImagePixels = std::min(report.imagePixels, 1u << 28);
      const bool layers = next.maxImagePixels != info.maxImagePixels || next.maxTilePatches > report.tilePatchesGiven ||
                          next.maxDrawings > report.itemsGiven || next.maxLayerPixels > report.layerPixelsGiven ||
                          next.maxLayerOperations > report.layerOperationsGiven;
      if (!layers && next.maxTileEntries == report.tileEntriesGiven && next.maxTileWords == report.tileWordsGiven)
        continue;
      Result<Canvas> made = Canvas::create(session.context(), next);
      if (!made) continue;
      info = next;
      return std::move(*made);
    }
  return std::nullopt;
}

std::string omitted(const GpgpCanvasReport& report, uint32_t paths, bool said) {
  if (report.layerPixels == UINT32_MAX)
    return "the drawing's layers were left out: one of them, or all side by side, are larger than 16384 x 16384 pixels";
  if (report.layerPixels > report.layerPixelsGiven || report.layerOperations > report.layerOperationsGiven)
    return "the drawing's layers were left out: they need " + std::to_string(report.layerPixels) + " pixels and " +
           std::to_string(report.layerOperations) + " operations, and there is room for " +
           std::to_string(report.layerPixelsGiven) + " and " + std::to_string(report.layerOperationsGiven) +
           "; a smaller --size needs fewer";
  if (report.imagePixels > report.imagePixelsGiven)
    return std::to_string(report.pathsDropped) + " of " + std::to_string(paths) +
           " paths were left out: images cover " + std::to_string(report.imagePixels) +
           " pixels, and there is room for " + std::to_string(report.imagePixelsGiven) +
           "; a smaller --size needs fewer";
  const bool words = report.tileWords > report.tileWordsGiven;
  const std::string text =
      std::to_string(report.pathsDropped) + " of " + std::to_string(paths) + " paths were left out";
  if (report.layerOperations && !words && report.tileEntries <= report.tileEntriesGiven)
    return text + ": the device has no room for all layers side by side; a smaller --size needs less";
  if (report.tilePatches > report.tilePatchesGiven && said) // room for twice as many comes with them
    return text + "; --max-tile-entries " + std::to_string(std::max(report.tileEntries, report.tilePatches / 2 + 1)) +
           " would hold them, or somewhat more";
  if (report.tilePatches > report.tilePatchesGiven)
    return text + ": they need " + std::to_string(report.tilePatches) +
           " patches in tiles, and the device has room for " + std::to_string(report.tilePatchesGiven) +
           "; a smaller --size needs fewer";
  if (said) // as many words come with them
    return text + "; --max-tile-entries " + std::to_string(std::max(report.tileEntries, words ? report.tileWords : 0)) +
           " would hold them, or somewhat more";
  return text + ": they need " + std::to_string(words ? report.tileWords : report.tileEntries) +
         (words ? " tile words" : " tile entries") + ", and the device has room for " +
         std::to_string(words ? report.tileWordsGiven : report.tileEntriesGiven) + "; a smaller --size needs fewer";
}

} // namespace gpgp::cli
