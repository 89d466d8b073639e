// Runs the `gpgp` command.
#pragma once
#include "process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <regex>
#include <set>
#include <string>
#include <vector>

namespace gpgp::test {

using nlohmann::json;

inline ProcessResult gpgp(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), GPGP_CLI);
  return runProcess(arguments);
}

/// Standard error without the lines that say how far long work is: where everything is slow, anything takes long.
inline std::string withoutProgress(const std::string& err) {
  static const std::regex progress("^[^\n]*( left| so far|takes less)$\n?", std::regex::multiline);
  return std::regex_replace(err, progress, "");
}

/// Runs with --json and expects success, one object, and nothing on standard error but progress.
inline json gpgpJson(std::vector<std::string> arguments) {
  arguments.push_back("--json");
  const ProcessResult result = gpgp(arguments);
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(withoutProgress(result.err), "");
  json object = json::parse(result.out, nullptr, false); // fails where anything stands beside the object
  EXPECT_TRUE(object.is_object()) << result.out;
  EXPECT_EQ(object.value("ok", false), true);
  return object.is_object() ? object : json::object();
}

/// Runs with --json and expects failed work: exit code 1, one object with the error, the same on standard error.
inline std::string gpgpFailure(std::vector<std::string> arguments) {
  arguments.push_back("--json");
  const ProcessResult result = gpgp(arguments);
  EXPECT_EQ(result.exitCode, 1) << result.err;
  const json object = json::parse(result.out, nullptr, false);
  EXPECT_TRUE(object.is_object()) << result.out;
  if (!object.is_object()) return {};
  EXPECT_EQ(object.value("ok", true), false);
  const std::string error = object.value("error", "");
  EXPECT_NE(error, "");
  // Several are on standard error each by itself.
  EXPECT_NE(result.err.find(error.substr(0, error.find(" (and "))), std::string::npos) << result.err;
  return error;
}

/// Runs with --json what is done, but for what exceeds a budget: exit code 1, one object that has the result and the
/// error, the same on standard error.
inline json gpgpExceeded(std::vector<std::string> arguments) {
  arguments.push_back("--json");
  const ProcessResult result = gpgp(arguments);
  EXPECT_EQ(result.exitCode, 1) << result.err;
  const json object = json::parse(result.out, nullptr, false);
  EXPECT_TRUE(object.is_object()) << result.out;
  if (!object.is_object()) return json::object();
  EXPECT_EQ(object.value("ok", true), false);
  EXPECT_NE(object.value("error", "").find("budget exceeded: "), std::string::npos);
  EXPECT_NE(result.err.find(object.value("error", "-")), std::string::npos) << result.err;
  return object;
}

/// Each of these is wrong usage: exit code 2 and nothing on standard output.
inline void expectWrongUsage(const std::vector<std::vector<std::string>>& wrong) {
  for (const auto& arguments : wrong) {
    const ProcessResult result = gpgp(arguments);
    EXPECT_EQ(result.exitCode, 2) << testing::PrintToString(arguments);
    EXPECT_EQ(result.out, "");
  }
}

inline std::set<std::string> keys(const json& object) {
  std::set<std::string> result;
  for (const auto& [key, value] : object.items()) result.insert(key);
  return result;
}

} // namespace gpgp::test
