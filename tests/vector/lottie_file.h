// A Lottie animation in a test: what was said about it, and what a frame shows.
#pragma once
#include <gpgp/lottie.hpp>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace gpgp::test {

struct LottieFile {
  Lottie lottie;
  GpgpResult result = GPGP_SUCCESS;
  std::vector<std::string> messages; ///< "test.json: layers[0]: text"

  explicit LottieFile(std::string_view bytes, GpgpLottieSource source = init<GpgpLottieSource>()) {
    source.name = "test.json";
    source.data = bytes.data();
    source.size = bytes.size();
    source.messageFn = [](void* user, const GpgpMessage* m) {
      static_cast<LottieFile*>(user)->messages.push_back(std::string(m->label) + ": " + m->text);
    };
    source.messageUserData = this;
    GpgpLottie raw = nullptr;
    result = gpgpCreateLottie(&source, &raw);
    lottie.reset(raw);
  }
  LottieFile(const LottieFile&) = delete; // messages refer to it
  GpgpLottieFrame at(double frame) {
    GpgpLottieFrame value = init<GpgpLottieFrame>();
    EXPECT_EQ(gpgpEvaluateLottie(lottie, frame, &value), GPGP_SUCCESS);
    return value;
  }
  bool said(std::string_view part) const {
    for (const std::string& message : messages)
      if (message.find(part) != message.npos) return true;
    return false;
  }
};

/// An animation of 100 x 100 units and 60 frames.
inline std::string animation(const std::string& layers, const std::string& more = "") {
  return R"({"v":"5.7","fr":30,"ip":0,"op":60,"w":100,"h":100,)" + more + R"("layers":[)" + layers + "]}";
}
inline std::string shapeLayer(const std::string& shapes, const std::string& ks = "{}", const std::string& more = "") {
  return R"({"ty":4,"ip":0,"op":60,"st":0,)" + more + R"("ks":)" + ks + R"(,"shapes":[)" + shapes + "]}";
}
inline const std::string kSquare = R"({"ty":"rc","p":{"k":[10,20]},"s":{"k":[20,10]},"r":{"k":0}})";
inline const std::string kRed = R"({"ty":"fl","c":{"k":[1,0,0]},"o":{"k":100}})";

} // namespace gpgp::test
