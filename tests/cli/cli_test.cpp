// The `gpgp` command as a person or a script meets it: exit codes, one JSON object, nothing else on standard output.
#include "run.h"

namespace gpgp::test {
namespace {

TEST(Cli, InfoSaysWhatThereIs) {
  const json info = gpgpJson({"info", "--validate"});
  EXPECT_EQ(keys(info), (std::set<std::string>{"command", "ok", "version", "services", "device", "devices", "usable",
                                               "missing", "features", "paths", "computeOnlyQueue", "limits"}));
  EXPECT_EQ(info["command"], "info");
  EXPECT_TRUE(info["usable"].get<bool>());
  EXPECT_FALSE(info["devices"].empty());
  EXPECT_EQ(info["devices"][info["device"]["index"].get<size_t>()], info["device"]);
  EXPECT_EQ(keys(info["features"]), keys(info["paths"]));
}

TEST(Cli, InfoForPeople) {
  const ProcessResult result = gpgp({"info"});
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("This device can run gpgp."), std::string::npos) << result.out;
}

TEST(Cli, PipelinesAndWhatTheyCost) {
  const json all = gpgpJson({"info", "--pipelines"})["recorders"];
  std::map<std::string, size_t> counts;
  for (const json& recorder : all) {
    double milliseconds = 0;
    uint64_t bytes = 0;
    for (const json& pipeline : recorder["pipelines"]) {
      EXPECT_NE(pipeline["name"], "");
      EXPECT_GT(pipeline["ms"], 0);
      milliseconds += pipeline["ms"].get<double>();
      bytes += pipeline["code_bytes"].get<uint64_t>();
    }
    EXPECT_NEAR(recorder["ms"], milliseconds, 1e-3 * milliseconds);
    EXPECT_EQ(recorder["code_bytes"], bytes);
    counts[recorder["name"]] = recorder["pipelines"].size();
  }
  EXPECT_EQ(counts.size(), all.size());
  EXPECT_LT(counts["canvas for RGBA8 images"], counts["canvas"]);
  EXPECT_LT(counts["canvas"], counts["canvas with layers"]);
  EXPECT_GT(counts["spawner"], 0u);
  EXPECT_GT(counts["visibility recorder, exact"], counts["visibility recorder, standard"]);
}

TEST(Cli, ADeviceCanBeNamed) {
  const std::string name = gpgpJson({"info"})["device"]["name"];
  EXPECT_EQ(gpgpJson({"info", "--device", "0"})["device"]["index"], 0);
  EXPECT_EQ(gpgpJson({"info", "--device", name})["device"]["name"], name);
}

TEST(Cli, FailedWorkIsOneAndStillOneObject) {
  EXPECT_NE(gpgpFailure({"info", "--device", "no such device"}).find("no such device"), std::string::npos);
  const ProcessResult text = gpgp({"info", "--device", "no such device"});
  EXPECT_EQ(text.exitCode, 1);
  EXPECT_EQ(text.out, "");
  EXPECT_NE(text.err, "");
}

TEST(Cli, WrongUsageIsTwoAndSilentOnStandardOutput) {
  const std::vector<std::vector<std::string>> wrong = {
      {}, {"nonsense"}, {"info", "--nonsense"}, {"info", "too", "many"}, {"info", "--device"}};
  for (const auto& arguments : wrong) {
    const ProcessResult result = gpgp(arguments);
    EXPECT_EQ(result.exitCode, 2) << testing::PrintToString(arguments);
    EXPECT_EQ(result.out, "") << testing::PrintToString(arguments);
    EXPECT_NE(result.err, "") << testing::PrintToString(arguments);
  }
}

TEST(Cli, WrongNamesAreAnsweredWithTheRightOnes) {
  const ProcessResult misspelt = gpgp({"spwan", "x.pga"});
  EXPECT_EQ(misspelt.exitCode, 2);
  EXPECT_NE(misspelt.err.find("there is no command \"spwan\"; there are info, "), std::string::npos) << misspelt.err;
  EXPECT_NE(misspelt.err.find("; did you mean 'spawn'?"), std::string::npos) << misspelt.err;
  EXPECT_NE(misspelt.err.find("Run `gpgp --help`"), std::string::npos) << misspelt.err;
  for (const char* argument : {"--jsno", "--jsno=3"}) {
    const ProcessResult close = gpgp({"info", argument, "no such file"});
    EXPECT_EQ(close.exitCode, 2);
    EXPECT_NE(close.err.find("there is no option '--jsno'; did you mean '--json'?"), std::string::npos) << close.err;
  }
  const ProcessResult option = gpgp({"info", "--ouput"});
  EXPECT_EQ(option.exitCode, 2);
  EXPECT_NE(option.err.find("there is no option '--ouput'\n"), std::string::npos) << option.err;
  EXPECT_NE(option.err.find("Run `gpgp info --help`"), std::string::npos) << option.err;
}

TEST(Cli, HelpTeaches) {
  const ProcessResult all = gpgp({"--help"});
  EXPECT_EQ(all.exitCode, 0);
  EXPECT_EQ(all.err, "");
  EXPECT_NE(all.out.find("Examples:"), std::string::npos);
  const json info = gpgpJson({"info"});
  std::vector<std::string> commands = {"info"};
  for (const json& service : info["services"]) commands.push_back(service.get<std::string>());
  for (const std::string& command : commands) {
    const ProcessResult help = gpgp({command, "--help"});
    EXPECT_EQ(help.exitCode, 0) << command;
    EXPECT_NE(help.out.find("Examples:"), std::string::npos) << command;
    EXPECT_NE(help.out.find("--json"), std::string::npos) << command;
  }
  EXPECT_EQ(gpgp({"--version"}).exitCode, 0);
}

} // namespace
} // namespace gpgp::test
