// Runs the mini-engine's live editing by a script, and reads what it prints.
#pragma once
#include "host/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace gpgp::test {

/// What a picture shows.
struct State {
  std::string file;
  unsigned count = 0; ///< instances, or triangles of a .cga file
  std::string keyHash;
  int errorBox[4] = {};
  std::vector<std::string> errors;
};
constexpr int kNowhere[4] = {};

/// Of folder/script, on folder/file. output: all that is printed.
inline std::vector<State> runLive(const std::filesystem::path& folder, const char* file, std::string& output) {
  const std::string command = std::string("\"") + GPGP_MINI_ENGINE + "\" --data \"" + GPGP_TEST_DATA + "\" --live \"" +
                              (folder / file).string() + "\" --script \"" + (folder / "script").string() +
                              "\" --size 480x270 --validate --out \"" + folder.string() + "\" 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  EXPECT_NE(pipe, nullptr);
  char part[512];
  while (std::fgets(part, sizeof part, pipe)) output += part;
  EXPECT_EQ(pclose(pipe), 0) << output;
  std::vector<State> states;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("error       ", 0) == 0 && !states.empty()) states.back().errors.push_back(line.substr(12));
    if (line.rfind("live        ", 0) != 0) continue;
    State& state = states.emplace_back();
    state.file = line.substr(12, line.find(": ") - 12);
    char hash[17] = {};
    EXPECT_EQ(std::sscanf(line.c_str() + line.find(": "), ": %u %*s %*s hash %16[0-9a-f], errors at %d,%d to %d,%d",
                          &state.count, hash, &state.errorBox[0], &state.errorBox[1], &state.errorBox[2],
                          &state.errorBox[3]),
              6)
        << line;
    state.keyHash = hash;
  }
  return states;
}

/// Pixels that differ, outside of a box.
inline size_t different(const host::Picture& a, const host::Picture& b, const int (&box)[4]) {
  size_t count = 0;
  for (uint32_t y = 0; y < a.height; ++y)
    for (uint32_t x = 0; x < a.width; ++x) {
      const bool inside = int(x) >= box[0] && int(x) < box[2] && int(y) >= box[1] && int(y) < box[3];
      const size_t at = (size_t{y} * a.width + x) * 4;
      count += !inside && !std::equal(&a.rgba[at], &a.rgba[at] + 4, &b.rgba[at]);
    }
  return count;
}

} // namespace gpgp::test
