#include "frame_format.h"

#include "assembly.h"
#include "compression.h"

#include <cmath>

namespace streaming {
namespace {

template <class Header> auto numbersOf(Header& h) {
  return std::tie(h.number, h.key, h.codec, h.pose, h.seconds, h.times, h.visible, h.blocks, h.lowered, h.dropped,
                  h.tiles);
}
constexpr size_t kKeyPlace = 4; // behind number

} // namespace

bool isKeyFrame(ByteSpan frame) { return frame.size() > kKeyPlace && frame[kKeyPlace] == 1; }

Bytes writeFrame(const FrameHeader& header, const FrameBlocks& blocks, ByteSpan texels) {
  Writer raw;
  raw.put(static_cast<uint32_t>(blocks.triangles.size()));
  uint32_t last = 0;
  for (const uint32_t triangle : blocks.triangles) { // differences: they compress better
    raw.put(triangle - last);
    last = triangle;
  }
  raw.putAll(blocks.words);
  raw.put(static_cast<uint32_t>(blocks.visibleBits.size()));
  raw.putAll(blocks.visibleBits);
  const Bytes packed = compress(raw.bytes);
  Writer writer;
  writer.putEach(numbersOf(header));
  writer.put(static_cast<uint32_t>(raw.bytes.size()));
  writer.put(static_cast<uint32_t>(packed.size()));
  writer.putBytes(packed);
  writer.putBytes(texels);
  writer.put(checksum(writer.bytes));
  return writer.bytes;
}

std::optional<ParsedFrame> parseFrame(ByteSpan frame, uint32_t triangleCount) {
  if (frame.size() < 4) return {};
  const ByteSpan body = frame.first(frame.size() - 4);
  if (Reader(frame.last(4)).get<uint32_t>() != checksum(body)) return {};
  ParsedFrame parsed;
  Reader reader(body);
  reader.getEach(numbersOf(parsed.header));
  const auto rawSize = reader.get<uint32_t>();
  const ByteSpan packed = reader.take(reader.get<uint32_t>());
  if (!reader.well() || !std::isfinite(parsed.header.seconds) || parsed.header.key > 1 ||
      static_cast<uint8_t>(parsed.header.codec) > 1)
    return {};
  parsed.texels = reader.take(reader.left());
  const uint32_t bitWords = (triangleCount + 31) / 32;
  if (rawSize > 8 + uint64_t{triangleCount} * 8 + bitWords * 4) return {};
  const auto raw = decompress(packed, rawSize);
  if (!raw) return {};
  Reader list(*raw);
  FrameBlocks& blocks = parsed.blocks;
  const auto count = list.get<uint32_t>();
  blocks.triangles = list.getAll<uint32_t>(count);
  blocks.words = list.getAll<uint32_t>(count);
  blocks.visibleBits = list.getAll<uint32_t>(list.get<uint32_t>());
  if (!list.ended() || blocks.visibleBits.size() != bitWords) return {};
  uint32_t last = 0;
  for (uint32_t& triangle : blocks.triangles) {
    last = triangle += last;
    if (triangle >= triangleCount) return {};
  }
  return parsed;
}

} // namespace streaming
