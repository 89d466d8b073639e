// Messages, frames and codecs of the streaming sample: what comes back is what was sent, and damage is refused.
#include "assembly.h"
#include "compression.h"
#include "display.h"
#include "transport.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

namespace streaming {
namespace {

constexpr uint32_t kSide = 128, kTriangles = 1000;

struct Random { ///< 32 bits at a time
  explicit Random(uint32_t seed) : numbers(seed) {}
  uint32_t operator()() { return static_cast<uint32_t>(numbers()); }
  std::mt19937 numbers;
};

struct Sequence { ///< a server's frames, made up
  Random random{5};
  Atlas atlas;
  std::vector<uint32_t> words = std::vector<uint32_t>(kTriangles), bits = std::vector<uint32_t>((kTriangles + 31) / 32);
  std::unique_ptr<Encoder> encoder;
  Codec codec;
  uint32_t number = 0;

  explicit Sequence(Codec c) : codec(c) {
    atlas.resize(kSide, kSide);
    encoder = makeEncoder({c, 0, 30}, kSide, kSide);
  }
  Bytes next(bool key) {
    FrameBlocks blocks;
    std::vector<bool> touched(kTriangles);
    for (uint32_t i = 0; i < 40; ++i) { // blocks of 4 x 4 anywhere
      const uint32_t triangle = random() % kTriangles;
      touched[triangle] = true;
      words[triangle] = random() % 3 ? 1u << 31 | random() % (kSide / 4) | random() % (kSide / 4) << 11 : 0;
    }
    FrameHeader header;
    header.number = number++;
    header.key = key;
    header.codec = codec;
    for (uint32_t t = 0; t < kTriangles; ++t)
      if (key ? words[t] != 0 : touched[t]) {
        blocks.triangles.push_back(t);
        blocks.words.push_back(words[t]);
      }
    blocks.visibleBits.assign(bits.size(), 0);
    for (uint32_t& word : blocks.visibleBits) word = key ? random() : random() & random() & random();
    for (size_t i = 0; i < bits.size(); ++i) bits[i] = (key ? 0 : bits[i]) ^ blocks.visibleBits[i];
    std::vector<uint32_t> changed;
    for (uint32_t tile = 0; tile < atlas.tileCount(); ++tile) {
      if (random() % 5) continue;
      changed.push_back(tile);
      const uint32_t colour = random() | 0xff000000u;
      for (uint32_t i = 0; i < 16; ++i)
        atlas.texels[size_t{tile / atlas.tileColumns() * 4 + i / 4} * kSide + tile % atlas.tileColumns() * 4 + i % 4] =
            colour;
    }
    return writeFrame(header, blocks, encoder->encode(atlas, changed, key));
  }
};

Welcome welcomeOf(Codec codec) {
  Welcome welcome;
  welcome.atlasWidth = welcome.atlasHeight = kSide;
  welcome.triangleCount = kTriangles;
  welcome.codec = codec;
  welcome.drawColours = {0xff112233u};
  return welcome;
}

double psnrOf(const Atlas& a, const Atlas& b) {
  double sum = 0;
  for (size_t i = 0; i < a.texels.size(); ++i)
    for (int c = 0; c < 24; c += 8) {
      const double d = static_cast<double>(a.texels[i] >> c & 255) - static_cast<double>(b.texels[i] >> c & 255);
      sum += d * d;
    }
  return 10 * std::log10(255 * 255 * 3.0 * static_cast<double>(a.texels.size()) / std::max(sum, 1e-9));
}

std::vector<Bytes> validMessages() {
  Missing missing{7, {1, 2, 900}};
  PoseMessage pose;
  pose.number = 3;
  pose.seconds = 1.5;
  const Bytes data(5000, 7);
  return {write(Hello{12345, 640, 360, 1.0f}),
          write(welcomeOf(Codec::x264)),
          writeRefusal("no"),
          write(pose),
          write(partOf(data, 9, 4)),
          write(missing),
          writeRefresh()};
}

/// How many of all parsers take the bytes.
int parsersOf(ByteSpan bytes) {
  return parseHello(bytes).has_value() + parseWelcome(bytes).has_value() + parsePose(bytes).has_value() +
         parsePart(bytes).has_value() + parseMissing(bytes).has_value() + parseRefusal(bytes).has_value();
}

TEST(Messages, SayWhatWasSaid) {
  const auto hello = parseHello(write(Hello{0x123456789abcdefull, 640, 361, 0.9f}));
  ASSERT_TRUE(hello);
  EXPECT_EQ(hello->world, 0x123456789abcdefull);
  EXPECT_EQ(hello->width, 640u);
  EXPECT_EQ(hello->height, 361u);
  EXPECT_EQ(hello->fieldOfView, 0.9f);
  const auto welcome = parseWelcome(write(welcomeOf(Codec::x264)));
  ASSERT_TRUE(welcome);
  EXPECT_EQ(welcome->codec, Codec::x264);
  EXPECT_EQ(welcome->drawColours, std::vector<uint32_t>{0xff112233u});
  PoseMessage pose;
  pose.number = 5;
  pose.view.eye = {1, 2, 3};
  pose.latest = 0.25f;
  const auto parsedPose = parsePose(write(pose));
  ASSERT_TRUE(parsedPose);
  EXPECT_EQ(parsedPose->view.eye, pose.view.eye);
  EXPECT_EQ(parsedPose->latest, 0.25f);
  const auto missing = parseMissing(write(Missing{8, {3, 1}}));
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->parts, (std::vector<uint16_t>{3, 1}));
  EXPECT_EQ(parseRefusal(writeRefusal("why")), "why");
  EXPECT_EQ(typeOf(writeRefresh()), MessageType::refresh);
  EXPECT_FALSE(typeOf(Bytes{}));
  EXPECT_FALSE(typeOf(Bytes{99}));
}

TEST(Messages, RefuseNumbersOutOfRange) {
  EXPECT_FALSE(parseHello(write(Hello{1, 15, 360, 1.0f})));
  EXPECT_FALSE(parseHello(write(Hello{1, 640, 5000, 1.0f})));
  EXPECT_FALSE(parseHello(write(Hello{1, 640, 360, std::nanf("")})));
  Welcome welcome = welcomeOf(Codec::zstd);
  welcome.atlasWidth = 100;
  EXPECT_FALSE(parseWelcome(write(welcome)));
  PoseMessage pose;
  pose.view.forward = {0, 0, 0};
  EXPECT_FALSE(parsePose(write(pose)));
  pose = {};
  pose.view.eye.y = INFINITY;
  EXPECT_FALSE(parsePose(write(pose)));
  pose = {};
  pose.earliest = 0.5f, pose.latest = 0.2f;
  EXPECT_FALSE(parsePose(write(pose)));
  EXPECT_FALSE(parseMissing(write(Missing{1, std::vector<uint16_t>(kMaxNumbersInMissing + 1)})));
}

TEST(Messages, RefuseEveryTruncationAndSurviveDamage) {
  Random random(11);
  for (const Bytes& message : validMessages()) {
    if (typeOf(message) != MessageType::refresh) {
      EXPECT_EQ(parsersOf(message), 1) << int{message[0]};
    }
    for (size_t size = 0; size < message.size(); ++size) {
      if (typeOf(message) == MessageType::refusal && size > 0) continue; // a shorter text is a text
      EXPECT_EQ(parsersOf(ByteSpan(message).first(size)), 0) << int{message[0]} << ' ' << size;
    }
    for (int i = 0; i < 20000; ++i) {
      Bytes damaged = message;
      for (uint32_t k = 0; k <= random() % 4; ++k) damaged[random() % damaged.size()] = static_cast<uint8_t>(random());
      if (random() % 4 == 0) damaged.resize(random() % (damaged.size() + 20));
      EXPECT_LE(parsersOf(damaged), 1);
    }
  }
}

TEST(Frames, ComeBackAsTheyWere) {
  for (const Codec codec : {Codec::zstd, Codec::x264}) {
    Sequence server(codec);
    StreamState client(welcomeOf(codec));
    for (int n = 0; n < 8; ++n) {
      const Bytes bytes = server.next(n == 0 || n == 5);
      EXPECT_EQ(isKeyFrame(bytes), n == 0 || n == 5);
      const auto frame = parseFrame(bytes, kTriangles);
      ASSERT_TRUE(frame);
      EXPECT_EQ(frame->header.number, static_cast<uint32_t>(n));
      ASSERT_TRUE(client.apply(*frame));
      EXPECT_EQ(client.blocks(), server.words);
      EXPECT_EQ(client.visibleBits(), server.bits);
      if (codec == Codec::zstd) {
        EXPECT_EQ(client.atlas().texels, server.atlas.texels);
      } else {
        EXPECT_GT(psnrOf(client.atlas(), server.atlas), 28) << n; // noise of single tiles, at constant quality
      }
    }
  }
}

TEST(Frames, RefuseTimesThatAreNone) {
  for (const double seconds : {std::nan(""), HUGE_VAL}) {
    FrameHeader header;
    header.key = 1;
    header.seconds = seconds;
    const FrameBlocks blocks{{}, {}, std::vector<uint32_t>((kTriangles + 31) / 32)};
    EXPECT_FALSE(parseFrame(writeFrame(header, blocks, {}), kTriangles));
    header.seconds = 1;
    EXPECT_TRUE(parseFrame(writeFrame(header, blocks, {}), kTriangles));
  }
}

TEST(Frames, KeepTheColourOfWhatGoes) {
  Sequence server(Codec::zstd);
  StreamState client(welcomeOf(Codec::zstd));
  server.words[77] = 1u << 31 | 3 | 5 << 11; // 4 x 4 texels at (12, 20)
  const auto first = server.next(true);
  ASSERT_TRUE(client.apply(*parseFrame(first, kTriangles)));
  ASSERT_NE(server.words[77], 0u); // this sequence leaves it alone
  FrameHeader header;
  header.number = 1;
  FrameBlocks blocks;
  blocks.triangles = {77};
  blocks.words = {0};
  blocks.visibleBits.assign(server.bits.size(), 0);
  const uint32_t expected = client.atlas().texels[size_t{20} * kSide + 12]; // tiles are of one colour
  const Bytes bytes = writeFrame(header, blocks, server.encoder->encode(server.atlas, {}, false));
  EXPECT_EQ(client.lastColours()[77], 0u);
  ASSERT_TRUE(client.apply(*parseFrame(bytes, kTriangles)));
  EXPECT_EQ(client.lastColours()[77], expected);
  EXPECT_EQ(client.blocks()[77], 0u);
}

/// Damaged frames with a checksum that fits, so that everything behind it sees them, too.
TEST(Frames, RefuseDamageAndRecoverWithAKeyFrame) {
  Random random(3);
  for (const Codec codec : {Codec::zstd, Codec::x264}) {
    Sequence server(codec);
    StreamState client(welcomeOf(codec));
    ASSERT_TRUE(client.apply(*parseFrame(server.next(true), kTriangles)));
    uint32_t refused = 0, unseen = 0;
    constexpr int kRounds = 300;
    for (int i = 0; i < kRounds; ++i) {
      Bytes bytes = server.next(false);
      Bytes damaged = bytes;
      for (uint32_t k = 0; k <= random() % 3; ++k)
        damaged[random() % damaged.size()] ^= static_cast<uint8_t>(1 + random() % 255);
      if (random() % 3 == 0) damaged.resize(random() % damaged.size());
      unseen += damaged != bytes && parseFrame(damaged, kTriangles).has_value();
      if (damaged.size() >= 4) {
        const uint32_t sum = checksum(ByteSpan(damaged).first(damaged.size() - 4));
        std::memcpy(damaged.data() + damaged.size() - 4, &sum, 4);
      }
      const auto frame = parseFrame(damaged, kTriangles);
      if (!frame || !client.apply(*frame)) ++refused;
    }
    EXPECT_EQ(unseen, 0u);
    EXPECT_GT(refused, uint32_t{kRounds / 3});
    const Bytes key = server.next(true);
    ASSERT_TRUE(client.apply(*parseFrame(key, kTriangles)));
    EXPECT_EQ(client.blocks(), server.words);
    EXPECT_GT(psnrOf(client.atlas(), server.atlas), 28);
  }
}

TEST(Frames, RefuseBlocksBesideTheAtlas) {
  StreamState client(welcomeOf(Codec::zstd));
  Sequence server(Codec::zstd);
  const Bytes texels = server.encoder->encode(server.atlas, {}, true);
  const auto isTaken = [&](uint32_t triangle, uint32_t word) {
    FrameHeader header;
    header.key = 1;
    FrameBlocks blocks;
    blocks.triangles = {triangle};
    blocks.words = {word};
    blocks.visibleBits.assign((kTriangles + 31) / 32, 0);
    const Bytes bytes = writeFrame(header, blocks, texels);
    const auto frame = parseFrame(bytes, kTriangles);
    return frame && client.apply(*frame);
  };
  EXPECT_TRUE(isTaken(0, 1u << 31 | 31 | 31 << 11));             // the last 4 x 4 texels
  EXPECT_FALSE(isTaken(0, 1u << 31 | 32));                       // beyond the right side
  EXPECT_FALSE(isTaken(0, 1u << 31 | 31 | 31 << 11 | 1u << 22)); // 8 wide there
  EXPECT_FALSE(isTaken(0, 1u << 31 | 7u << 22));                 // wider than any block
  EXPECT_FALSE(isTaken(0, 1u << 31 | 3u << 28));                 // no such corner
  EXPECT_FALSE(isTaken(0, 5));                                   // no block, and yet a place
  EXPECT_FALSE(isTaken(kTriangles, 1u << 31));
}

/// Parts are lost, come twice and in any order, in both directions' requests.
TEST(Assembly, GivesAllFramesInOrderThroughAnyLoss) {
  for (const uint32_t lossPerCent : {0u, 5u, 40u}) {
    Random random(lossPerCent + 1);
    FrameAssembly assembly;
    FrameStore store;
    std::vector<Bytes> sent;
    std::vector<std::pair<double, Bytes>> flying;
    size_t taken = 0, most = 0;
    constexpr size_t kFrames = 60;
    double now = 0;
    const auto fly = [&](const Bytes& message) {
      for (uint32_t copy = 0; copy <= (random() % 20 == 0); ++copy)
        if (random() % 100 >= lossPerCent) flying.emplace_back(now + 0.001 * (random() % 50), message);
    };
    for (; taken < kFrames && now < 60; now += 0.005) {
      if (sent.size() < kFrames && static_cast<double>(sent.size()) * 0.03 < now) {
        FrameHeader header;
        header.number = static_cast<uint32_t>(sent.size());
        header.key = sent.empty();
        Bytes texels(random() % 30000);
        for (uint8_t& byte : texels) byte = static_cast<uint8_t>(random());
        sent.push_back(writeFrame(header, {}, texels));
        for (uint32_t i = 0; i < partCount(sent.back().size()); ++i) fly(write(partOf(sent.back(), header.number, i)));
        store.add(header.number, sent.back());
      }
      for (size_t i = 0; i < flying.size();)
        if (flying[i].first <= now) {
          EXPECT_TRUE(assembly.add(*parsePart(flying[i].second), now));
          flying.erase(flying.begin() + static_cast<std::ptrdiff_t>(i));
        } else {
          ++i;
        }
      for (const Missing& missing : assembly.missing(now, 0.06))
        if (random() % 100 >= lossPerCent)
          for (const Bytes& part : store.answer(missing)) fly(part);
      while (const auto frame = assembly.take()) {
        ASSERT_LT(taken, sent.size());
        EXPECT_EQ(*frame, sent[taken]);
        ++taken;
      }
      EXPECT_FALSE(assembly.isStuck(now, 5));
      most = std::max(most, assembly.heldBytes());
    }
    EXPECT_EQ(taken, kFrames) << lossPerCent;
    EXPECT_LE(most, size_t{40} * 30000);
    EXPECT_EQ(assembly.heldBytes(), 0u);
    if (lossPerCent == 0) {
      EXPECT_LT(assembly.requestedParts(), 400u); // what came late
    }
  }
}

TEST(Assembly, BeginsAnewWhereAFrameIsLostForGood) {
  FrameAssembly assembly;
  const auto frameOf = [](uint32_t number, bool key) {
    FrameHeader header;
    header.number = number;
    header.key = key;
    return writeFrame(header, {}, Bytes(2000, static_cast<uint8_t>(number)));
  };
  const auto send = [&](const Bytes& frame, uint32_t number, double now) {
    for (uint32_t i = 0; i < partCount(frame.size()); ++i)
      assembly.add(*parsePart(write(partOf(frame, number, i))), now);
  };
  send(frameOf(1, false), 1, 0); // no key frame: of no use
  EXPECT_FALSE(assembly.take());
  send(frameOf(0, true), 0, 0.01);
  EXPECT_TRUE(assembly.take());
  EXPECT_TRUE(assembly.take());
  for (uint32_t number = 3; number < 20; ++number) send(frameOf(number, false), number, 0.1);
  EXPECT_FALSE(assembly.take());
  EXPECT_FALSE(assembly.missing(0.2, 0.05).empty());
  EXPECT_FALSE(assembly.isStuck(0.3, 0.5));
  EXPECT_TRUE(assembly.isStuck(0.7, 0.5));
  EXPECT_FALSE(assembly.isStuck(0.8, 0.5)); // once
  send(frameOf(20, true), 20, 0.9);
  const auto frame = assembly.take();
  ASSERT_TRUE(frame);
  EXPECT_TRUE(isKeyFrame(*frame));
  EXPECT_EQ(assembly.heldBytes(), 0u);
}

TEST(Assembly, HoldsNoMoreThanItMay) {
  FrameAssembly assembly;
  Random random(1);
  for (int i = 0; i < 80; ++i) { // an adversary's parts: first parts of large frames, anywhere
    Part part;
    part.frame = random() % 3000;
    part.bytes = random() % 2 ? kMaxFrameBytes : 1 + random() % kMaxFrameBytes;
    part.count = static_cast<uint16_t>(partCount(part.bytes));
    const Bytes data(std::min(part.bytes, kPartBytes));
    part.data = data;
    if (part.count > 1 || part.bytes <= kPartBytes) assembly.add(part, 0.001 * i);
    ASSERT_LE(assembly.heldBytes(), FrameAssembly::kMaxHeldBytes);
    if (i % 8 == 0) {
      EXPECT_LE(assembly.missing(0.001 * i, 0).size(), FrameAssembly::kMaxFrames);
    }
    assembly.take();
  }
  Part far;
  far.frame = 4000000000u;
  far.bytes = far.count = 1;
  const Bytes one(1);
  far.data = one;
  EXPECT_FALSE(assembly.add(far, 9));
}

TEST(Transport, ReliableMessagesComeInOrderThroughABadNetwork) {
  Endpoint server = Endpoint::listenAt("127.0.0.1", 0);
  RelayOptions bad;
  bad.latency = 30;
  bad.jitter = 10;
  bad.loss = 6;
  Relay relay("127.0.0.1", server.port(), bad);
  std::thread serving([&] { // echoes until the client leaves
    bool was = false;
    for (int i = 0; i < 4000 && !(was && !server.isConnected()); ++i) {
      server.poll(5, [&](ByteSpan message) { server.send(Bytes(message.begin(), message.end()), true); });
      was = was || server.isConnected();
    }
  });
  const auto begin = std::chrono::steady_clock::now();
  Endpoint client = Endpoint::connectTo("127.0.0.1", relay.port(), 20);
  for (uint8_t i = 0; i < 50; ++i) client.send(Bytes(500, i), true);
  uint8_t expected = 0;
  for (int i = 0; i < 4000 && expected < 50 && client.isConnected(); ++i)
    client.poll(5, [&](ByteSpan message) {
      ASSERT_EQ(message.size(), 500u);
      EXPECT_EQ(message[499], expected++);
    });
  EXPECT_EQ(expected, 50);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(60)); // connecting, then one echo
  client.disconnect();
  serving.join();
  EXPECT_GT(relay.lost(), 0u);
}

} // namespace
} // namespace streaming
