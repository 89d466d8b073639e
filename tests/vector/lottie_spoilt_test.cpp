// Animations with values spoilt at random: whatever is read converts, and all that it holds is within bounds.
#include "lottie_file.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using Json = nlohmann::json;

void collect(Json& value, std::vector<Json*>& all) {
  all.push_back(&value);
  if (value.is_structured())
    for (Json& part : value) collect(part, all);
}

/// A number, kind or size that nobody expects there.
Json spoilt(const Json& value, std::mt19937& random) {
  switch (random() % 12) {
  case 0: return nullptr;
  case 1: return "x";
  case 2: return Json::array();
  case 3: return Json::object();
  case 4: return 0;
  case 5: return -1;
  case 6: return 1e9;
  case 7: return 1e-9;
  case 8: return value.is_number() ? Json(-value.get<double>()) : Json(7);
  case 9: return value.is_number() ? Json(1000 * value.get<double>()) : Json(true);
  case 10: return Json::array({value, value});
  default: return Json::object({{"a", 1}, {"k", Json::array({{{"t", 5}, {"s", value}}, {{"t", 5}, {"e", value}}})}});
  }
}

TEST(LottieSpoilt, WhateverIsReadConverts) {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(GPGP_TEST_DATA) / "lottie"))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_GE(files.size(), 50u);
  std::mt19937 random(11);
  size_t read = 0, drawn = 0;
  for (const fs::path& path : files) {
    std::ifstream stream(path);
    const Json whole = Json::parse(stream);
    for (int i = 0; i < 40; ++i) {
      Json json = whole;
      std::vector<Json*> values;
      collect(json["layers"], values);
      if (json.contains("assets")) collect(json["assets"], values);
      // One alone, so that what comes after it is reached.
      Json& chosen = *values[random() % values.size()];
      chosen = spoilt(chosen, random);
      const std::string text = json.dump();
      SCOPED_TRACE(path.stem().string() + ": " + text.substr(0, 4000));
      LottieFile file(text);
      if (file.result != GPGP_SUCCESS) {
        ASSERT_EQ(file.result, GPGP_ERROR_INVALID_DATA);
        ASSERT_FALSE(file.messages.empty());
        continue;
      }
      ++read;
      for (const double frame : {0.0, 29.5, 59.0}) {
        const GpgpLottieFrame shown = file.at(frame);
        drawn += shown.pathCount > 0;
        for (uint32_t p = 0; p < shown.pathCount; ++p)
          for (uint32_t k = 0; k < 2 * shown.paths[p].pointCount; ++k)
            ASSERT_LE(std::fabs(shown.paths[p].points[k]), 1e7f);
        GpgpBlob blob{};
        const GpgpResult compiled = gpgpCompileLottieFrame(file.lottie, frame, nullptr, &blob);
        gpgpFreeBlob(&blob);
        ASSERT_EQ(compiled, GPGP_SUCCESS) << "frame " << frame << ": " << file.messages.back();
      }
    }
  }
  EXPECT_GT(read, 1500u);
  EXPECT_GT(drawn, 3000u);
}

} // namespace
