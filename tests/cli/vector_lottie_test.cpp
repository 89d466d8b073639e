// `gpgp vector` on animations whose pixels are known.
#include "files.h"
#include "host/picture.h"
#include "run.h"

namespace gpgp::test {
namespace {

/// A square of 10 in red that jumps 10 to the right at frame 10 and 20.
std::string jumping(const std::string& rotation = "{\"a\":0,\"k\":0}") {
  return R"({"v":"5.7","fr":10,"ip":0,"op":30,"w":30,"h":10,"layers":[
{"ty":1,"sw":10,"sh":10,"sc":"#ff0000","ip":0,"op":30,"st":0,"ks":{"p":{"a":1,"k":[
{"t":0,"s":[0,0],"h":1},{"t":10,"s":[10,0],"h":1},{"t":20,"s":[20,0],"h":1}]},"r":)" +
         rotation + "}}]}";
}

std::vector<int> pixel(const host::Picture& picture, uint32_t x, uint32_t y) {
  const uint8_t* p = &picture.rgba[(size_t{y} * picture.width + x) * 4];
  return {p[0], p[1], p[2], p[3]};
}
const std::vector<int> kRed{255, 0, 0, 255}, kBlue{0, 0, 255, 255};

TEST(CliLottie, DrawsTheFrameThatIsAskedFor) {
  const TemporaryFile file("jumping.json", jumping(R"({"a":0,"k":0,"x":"time"})")), picture("jumping.png");
  const ProcessResult run = gpgp({"vector", file.path(), "--frame", "15.5", "--background", "blue", "--out",
                                  picture.path(), "--validate", "--json"});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  EXPECT_NE(run.err.find("jumping.json: layers[0].ks.r: warning: expressions are not supported"), std::string::npos)
      << run.err;
  const json drawn = json::parse(run.out);
  EXPECT_EQ(drawn["width"], 30);
  EXPECT_EQ(drawn["end_frame"], 30);
  ASSERT_EQ(drawn["frames"].size(), 1u);
  EXPECT_EQ(drawn["frames"][0]["frame"], 15.5);
  EXPECT_EQ(drawn["frames"][0]["paths"], 1);
  ASSERT_EQ(drawn["unsupported"].size(), 1u);
  EXPECT_EQ(drawn["unsupported"][0]["place"], "layers[0].ks.r");
  const host::Picture seen = host::readPng(picture.path());
  ASSERT_EQ(seen.width, 30u);
  EXPECT_EQ(pixel(seen, 5, 5), kBlue);
  EXPECT_EQ(pixel(seen, 15, 5), kRed);
  EXPECT_EQ(pixel(seen, 25, 5), kBlue);
}

TEST(CliLottie, SheetsAreRowsOfFrames) {
  const TemporaryFile file("jumping.json", jumping()), picture("sheet.png");
  const json drawn = gpgpJson(
      {"vector", file.path(), "--sheet", "2x3", "--size", "60x20", "--background", "blue", "--out", picture.path()});
  ASSERT_EQ(drawn["frames"].size(), 6u);
  EXPECT_EQ(drawn["frames"][5]["frame"], 25);
  const host::Picture seen = host::readPng(picture.path());
  ASSERT_EQ(seen.width, 120u);
  ASSERT_EQ(seen.height, 60u);
  for (uint32_t i = 0; i < 6; ++i) // frames 0, 5, 10, 15, 20, 25
    for (uint32_t place = 0; place < 3; ++place)
      EXPECT_EQ(pixel(seen, i % 2 * 60 + place * 20 + 10, i / 2 * 20 + 10), place == i / 2 ? kRed : kBlue)
          << i << place;
}

TEST(CliLottie, MistakesAreNamed) {
  const TemporaryFile broken("broken.json", "{\"w\":1,\n x}"), file("jumping.json", jumping()),
      svg("one.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><path d='M0 0H9V9Z'/></svg>");
  EXPECT_NE(gpgpFailure({"vector", broken.path()}).find("broken.json:2:2: not JSON"), std::string::npos);
  EXPECT_NE(gpgpFailure({"vector", file.path(), "--tilt", "20"}).find("--tilt is not for animations"),
            std::string::npos);
  EXPECT_NE(gpgpFailure({"vector", svg.path(), "--frame", "3"}).find("no animation"), std::string::npos);
  expectWrongUsage(
      {{"vector", file.path(), "--frame", "1", "--sheet", "2x2"}, {"vector", file.path(), "--sheet", "0x2"}});
}

} // namespace
} // namespace gpgp::test
