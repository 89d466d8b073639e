// Shapes and ranges of messages.
#include "messages.h"

#include <algorithm>
#include <cmath>

namespace streaming {
namespace {

constexpr uint32_t kMagic = 0x67706773; // "gpgs"

Writer begin(MessageType type) {
  Writer writer;
  writer.put(type);
  return writer;
}
/// The reader behind the type; one that has failed where the type is another.
Reader open(ByteSpan message, MessageType type) {
  Reader reader(message);
  if (reader.get<uint8_t>() != static_cast<uint8_t>(type)) reader.take(SIZE_MAX);
  return reader;
}
// The numbers of messages in the order in which they are written and read.
template <class Message> auto helloNumbers(Message& m) { return std::tie(m.world, m.width, m.height, m.fieldOfView); }
template <class Message> auto welcomeNumbers(Message& m) {
  return std::tie(m.atlasWidth, m.atlasHeight, m.triangleCount, m.gutter, m.codec);
}
template <class Message> auto poseNumbers(Message& m) {
  return std::tie(m.number, m.seconds, m.view, m.earliest, m.latest);
}

bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool isWithin(float value, float low, float high) { return value >= low && value <= high; } // not a NaN

} // namespace

std::optional<MessageType> typeOf(ByteSpan message) {
  if (message.empty() || message[0] < 1 || message[0] > static_cast<uint8_t>(MessageType::refresh)) return {};
  return static_cast<MessageType>(message[0]);
}

Bytes write(const Hello& message) {
  Writer writer = begin(MessageType::hello);
  writer.put(kMagic);
  writer.put(kVersion);
  writer.putEach(helloNumbers(message));
  return writer.bytes;
}

std::optional<Hello> parseHello(ByteSpan message) {
  Reader reader = open(message, MessageType::hello);
  if (reader.get<uint32_t>() != kMagic || reader.get<uint32_t>() != kVersion) return {};
  Hello hello;
  reader.getEach(helloNumbers(hello));
  const auto isSide = [](uint32_t side) { return side >= 16 && side <= 4096; };
  if (!reader.ended() || !isSide(hello.width) || !isSide(hello.height) || !isWithin(hello.fieldOfView, 0.1f, 2.5f))
    return {};
  return hello;
}

Bytes write(const Welcome& message) {
  Writer writer = begin(MessageType::welcome);
  writer.put(kVersion);
  writer.putEach(welcomeNumbers(message));
  writer.put(static_cast<uint32_t>(message.drawColours.size()));
  writer.putAll(message.drawColours);
  return writer.bytes;
}

std::optional<Welcome> parseWelcome(ByteSpan message) {
  Reader reader = open(message, MessageType::welcome);
  if (reader.get<uint32_t>() != kVersion) return {};
  Welcome welcome;
  reader.getEach(welcomeNumbers(welcome));
  welcome.drawColours = reader.getAll<uint32_t>(reader.get<uint32_t>());
  const auto isSide = [](uint32_t side) { return side >= 128 && side <= 8192 && side % 128 == 0; };
  if (!reader.ended() || !isSide(welcome.atlasWidth) || !isSide(welcome.atlasHeight) || welcome.gutter > 1 ||
      static_cast<uint8_t>(welcome.codec) > 1 || welcome.triangleCount == 0 || welcome.triangleCount > kMaxTriangles)
    return {};
  return welcome;
}

Bytes write(const PoseMessage& message) {
  Writer writer = begin(MessageType::pose);
  writer.putEach(poseNumbers(message));
  return writer.bytes;
}

std::optional<PoseMessage> parsePose(ByteSpan message) {
  Reader reader = open(message, MessageType::pose);
  PoseMessage pose;
  reader.getEach(poseNumbers(pose));
  const View& view = pose.view;
  const bool well = reader.ended() && std::isfinite(pose.seconds) && std::abs(pose.seconds) < 1e9 &&
                    isFinite(view.eye) && glm::length(view.eye) < 1e5f && isFinite(view.forward) &&
                    std::abs(glm::length(view.forward) - 1) < 1e-3f && std::abs(view.forward.y) < 0.999f &&
                    isFinite(view.velocity) && glm::length(view.velocity) < 1e3f && isWithin(view.turnRate, 0, 100) &&
                    isWithin(view.tiltRate, 0, 100) && isWithin(pose.earliest, 0, 10) &&
                    isWithin(pose.latest, pose.earliest, 10);
  return well ? std::optional(pose) : std::nullopt;
}

uint32_t partCount(size_t frameBytes) { return static_cast<uint32_t>((frameBytes + kPartBytes - 1) / kPartBytes); }

Part partOf(ByteSpan frame, uint32_t number, uint32_t index) {
  Part part;
  part.frame = number;
  part.bytes = static_cast<uint32_t>(frame.size());
  part.index = static_cast<uint16_t>(index);
  part.count = static_cast<uint16_t>(partCount(frame.size()));
  const size_t begin = size_t{index} * kPartBytes;
  part.data = frame.subspan(begin, std::min<size_t>(kPartBytes, frame.size() - begin));
  return part;
}

Bytes write(const Part& message) {
  Writer writer = begin(MessageType::part);
  writer.put(message.frame);
  writer.put(message.bytes);
  writer.put(message.index);
  writer.putBytes(message.data);
  return writer.bytes;
}

std::optional<Part> parsePart(ByteSpan message) {
  Reader reader = open(message, MessageType::part);
  Part part;
  part.frame = reader.get<uint32_t>();
  part.bytes = reader.get<uint32_t>();
  part.index = reader.get<uint16_t>();
  if (!reader.well() || part.bytes == 0 || part.bytes > kMaxFrameBytes) return {};
  part.count = static_cast<uint16_t>(partCount(part.bytes));
  if (part.index >= part.count) return {};
  const size_t expected = std::min<size_t>(kPartBytes, part.bytes - size_t{part.index} * kPartBytes);
  part.data = reader.take(expected);
  return reader.ended() ? std::optional(part) : std::nullopt;
}

Bytes write(const Missing& message) {
  Writer writer = begin(MessageType::missing);
  writer.put(message.frame);
  writer.put(static_cast<uint16_t>(message.parts.size()));
  writer.putAll(message.parts);
  return writer.bytes;
}

std::optional<Missing> parseMissing(ByteSpan message) {
  Reader reader = open(message, MessageType::missing);
  Missing missing;
  missing.frame = reader.get<uint32_t>();
  const auto count = reader.get<uint16_t>();
  if (count > kMaxNumbersInMissing) return {};
  missing.parts = reader.getAll<uint16_t>(count);
  return reader.ended() ? std::optional(missing) : std::nullopt;
}

Bytes writeRefusal(const std::string& text) {
  Writer writer = begin(MessageType::refusal);
  writer.putBytes({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  return writer.bytes;
}

std::optional<std::string> parseRefusal(ByteSpan message) {
  Reader reader = open(message, MessageType::refusal);
  if (!reader.well() || reader.left() > 1000) return {};
  const ByteSpan text = reader.take(reader.left());
  return std::string(text.begin(), text.end());
}

Bytes writeRefresh() { return begin(MessageType::refresh).bytes; }

} // namespace streaming
