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

} // namespace gpgp::test
