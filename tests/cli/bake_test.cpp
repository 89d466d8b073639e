// `gpgp bake`: files, folders and streams hold the same bytes, and the library loads them.
#include "files.h"
#include "run.h"

namespace gpgp::test {
namespace {

constexpr const char* kGrammar = "axiom Box A;\nterminal T (1, 0);\nvar n = 2;\n"
                                 "A = Repeat(X, n, ADJUST_TO_FILL) T;\n";

ProcessResult shell(const std::string& line) { return runProcess({"/bin/sh", "-c", line}); }

std::string bakedWith(std::vector<std::string> arguments) {
  const TemporaryFile out("baked.gpgp");
  arguments.insert(arguments.begin(), "bake");
  arguments.insert(arguments.end(), {"-o", out.path()});
  const json result = gpgpJson(arguments);
  EXPECT_EQ(keys(result), (std::set<std::string>{"command", "ok", "baked"}));
  EXPECT_EQ(result["baked"].size(), 1u);
  const std::string bytes = host::readText(out.path());
  EXPECT_EQ(result["baked"][0]["bytes"], bytes.size());
  EXPECT_EQ(result["baked"][0]["out"], out.path());
  return bytes;
}

TEST(CliBake, TheSameInputGivesTheSameBytes) {
  const TemporaryFile grammar("bake.pga", kGrammar), renamed("bake.text", kGrammar);
  const std::string once = bakedWith({grammar.path()});
  EXPECT_EQ(once.substr(0, 4), "gppg");
  EXPECT_TRUE(once == bakedWith({grammar.path()})); // not EQ, which would print them
  EXPECT_TRUE(once == bakedWith({renamed.path(), "--type", "grammar"}));
  const ProcessResult stream = gpgp({"bake", grammar.path(), "-o", "-"});
  EXPECT_EQ(stream.exitCode, 0) << stream.err;
  EXPECT_TRUE(stream.out == once) << stream.out.size();
  EXPECT_TRUE(once != bakedWith({grammar.path(), "--set", "n=3"}));
  const std::string graph = bakedWith({grammar.path(), "--no-kernel"});
  EXPECT_LT(graph.size(), once.size());
  EXPECT_TRUE(graph == once.substr(0, graph.size())); // kernels lie behind the graph
}

TEST(CliBake, SchedulesAreChosen) {
  const TemporaryFile grammar("chosen.pga", kGrammar), tuned("chosen_tuned.gpgp"), both("chosen_both.gpgp"),
      groups("chosen_groups.txt");
  const std::string usual = bakedWith({grammar.path()});
  EXPECT_TRUE(usual == bakedWith({grammar.path(), "--schedule", "default"}));
  const auto scheduleOf = [&](const std::string& file) {
    return gpgpJson(
        {"spawn", grammar.path(), "--schedule", file, "--axioms", "2", "--axiom-size", "4,1,1"})["schedule"];
  };
  ASSERT_EQ(gpgp({"graph", grammar.path(), "--schedule", "sgl", "-o", groups.path()}).exitCode, 0);
  for (const std::string& schedule : {std::string("rw"), groups.path()}) {
    ASSERT_EQ(gpgp({"bake", grammar.path(), "--schedule", schedule, "-o", both.path()}).exitCode, 0);
    EXPECT_EQ(scheduleOf(both.path()), schedule == "rw" ? "rw" : "gpgp_cli_test_chosen_groups");
  }
  // Tuned where it was, and for all others what else is named.
  const json found = gpgpJson(
      {"tune", grammar.path(), "--axioms", "2", "--axiom-size", "4,1,1", "--seconds", "0.001", "-o", tuned.path()});
  gpgpJson({"bake", grammar.path(), "--schedule", tuned.path(), "--schedule", "rw", "-o", both.path()});
  EXPECT_EQ(scheduleOf(both.path()), found["best"]["schedule"]);
  EXPECT_GT(std::filesystem::file_size(both.path()), std::filesystem::file_size(tuned.path()));
  EXPECT_EQ(gpgpJson({"spawn", both.path(), "--axioms", "2", "--axiom-size", "4,1,1"})["terminals"], 4);
  const json linked =
      gpgpJson({"bake", "a=" + grammar.path(), "--link", "--schedule", "rw", "-o", both.path()})["baked"][0];
  EXPECT_EQ(linked["bytes"], std::filesystem::file_size(both.path()));
  const std::vector<std::string> bake = {"bake", grammar.path(), "-o", both.path(), "--schedule"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), bake.begin(), bake.end());
    return more;
  };
  expectWrongUsage({with({"rw", "--schedule", "sgl"}), with({"fastest"}), with({"rw", "--no-kernel"})});
  EXPECT_NE(gpgpFailure(with({"tuned", "--set", "n=77"})).find("no tuned schedule is stored"), std::string::npos);
}

TEST(CliBake, AFolderTakesOneFileEach) {
  const TemporaryFile one("one.pga", kGrammar), two("two.pga", kGrammar), folder("baked");
  const json result = gpgpJson({"bake", one.path(), two.path(), "--no-kernel", "-o", folder.path()});
  ASSERT_EQ(result["baked"].size(), 2u);
  const std::string first = host::readText(folder.path() + "/gpgp_cli_test_one.pga.gpgp");
  EXPECT_EQ(first, host::readText(folder.path() + "/gpgp_cli_test_two.pga.gpgp"));
  std::filesystem::remove_all(folder.path());
}

TEST(CliBake, WhatFailsLeavesNothingBehind) {
  const TemporaryFile one("whole.pga", kGrammar), wrong("not_whole.pga", "axiom Box A;\nA = Nothing;\n"),
      folder("whole");
  gpgpFailure({"bake", one.path(), wrong.path(), "--no-kernel", "-o", folder.path()});
  EXPECT_FALSE(std::filesystem::exists(folder.path())); // not even what could be baked
  const TemporaryFile out("whole.gpgp", "good");
  const auto limited = shell("ulimit -f 4; '" GPGP_CLI "' bake '" + one.path() + "' -o '" + out.path() + "'");
  EXPECT_EQ(limited.exitCode, 1);
  EXPECT_NE(limited.err.find(out.path() + ": File too large"), std::string::npos) << limited.err;
  EXPECT_EQ(host::readText(out.path()), "good");
  const auto piped = shell("'" GPGP_CLI "' bake '" + one.path() + "' --no-kernel -o /dev/stdout | cat");
  EXPECT_EQ(piped.out.substr(0, 4), "gppg");
}

TEST(CliBake, EndingsSayWhatIsInAFile) {
  const std::string svg = "<svg xmlns='http://www.w3.org/2000/svg' width='4' height='4'><path d='M0 0H3V3Z'/></svg>";
  const TemporaryFile grammar("kinds.pga", kGrammar), drawing("kinds.svg", svg), folder("kinds");
  const json result = gpgpJson({"bake", grammar.path(), drawing.path(), "--no-kernel", "-o", folder.path()});
  ASSERT_EQ(result["baked"].size(), 2u);
  EXPECT_EQ(result["baked"][0]["out"], folder.path() + "/gpgp_cli_test_kinds.pga.gpgp");
  EXPECT_EQ(result["baked"][1]["out"], folder.path() + "/gpgp_cli_test_kinds.svg.gpgpv");
  EXPECT_EQ(host::readText(result["baked"][1]["out"]), bakedWith({drawing.path()}));
  std::filesystem::remove_all(folder.path());
}

TEST(CliBake, ErrorsHaveAPlace) {
  const TemporaryFile wrong("wrong.pga", "axiom Box A;\nA = Nothing;\n"), out("wrong.gpgp");
  EXPECT_NE(gpgpFailure({"bake", wrong.path(), "-o", out.path()}).find("wrong.pga:2:"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(out.path()));
  gpgpFailure({"bake", "no_such_file.pga", "-o", out.path()});
}

TEST(CliBake, BytesSayWhatStandardInputIs) {
  const std::string svg = "<svg xmlns='http://www.w3.org/2000/svg' width='4' height='4'><path d='M0 0H3V3Z'/></svg>";
  const TemporaryFile drawing("piped.svg", svg), marked("marked.svg", "\xef\xbb\xbf \n" + svg),
      grammar("piped.pga", kGrammar);
  const std::string bake = std::string(" | ") + GPGP_CLI + " bake - -o -";
  const auto piped = [&bake](const std::string& from) {
    const ProcessResult result = shell(from + bake);
    EXPECT_EQ(result.exitCode, 0) << from << result.err;
    return result.out;
  };
  const std::string baked = bakedWith({drawing.path()});
  EXPECT_TRUE(piped("cat " + drawing.path()) == baked);
  EXPECT_TRUE(piped("gzip -c " + drawing.path()) == baked);
  EXPECT_TRUE(piped("iconv -f UTF-8 -t UTF-16 " + drawing.path()) == baked);
  EXPECT_TRUE(piped("cat " + marked.path()) == baked);
  EXPECT_TRUE(piped("cat " + grammar.path()) == bakedWith({grammar.path()}));
  const ProcessResult nothing = shell("printf 'a\\0b'" + bake); // neither text nor a kind of file that bake knows
  EXPECT_EQ(nothing.exitCode, 2);
  EXPECT_NE(nothing.err.find("state its type with --type"), std::string::npos) << nothing.err;
}

TEST(CliBake, DrawingsForAScale) {
  const TemporaryFile icon("scaled.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='24' height='24'>"
                                         "<circle cx='12' cy='12' r='9' stroke='red'/></svg>");
  const std::string one = bakedWith({icon.path()});
  EXPECT_TRUE(one == bakedWith({icon.path(), "--scale", "1"}));
  EXPECT_GT(bakedWith({icon.path(), "--scale", "1000"}).size(), one.size());
  expectWrongUsage({{"bake", icon.path(), "--scale", "0", "-o", "x.gpgpv"}});
}

TEST(CliBake, SaysWhatIsNotDrawn) {
  const TemporaryFile drawing("told.svg",
                              "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>\n"
                              "<path d='M0 0H3V3Z mist'/>\n<rect width='3' height='3' filter='url(#f)'/></svg>"),
      out("told.gpgpv");
  const ProcessResult result = gpgp({"bake", drawing.path(), "-o", out.path(), "--json"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  const json told = json::parse(result.out, nullptr, false)["baked"][0]["messages"];
  ASSERT_EQ(told.size(), 2u) << told;
  EXPECT_EQ(told[0]["severity"], "error");
  EXPECT_EQ(told[0]["element"], "path");
  EXPECT_EQ(told[0]["line"], 2);
  EXPECT_EQ(told[0]["column"], 21); // in the data
  EXPECT_EQ(told[1]["severity"], "warning");
  EXPECT_EQ(told[1]["line"], 3);
  for (const json& message : told)
    EXPECT_NE(result.err.find(message["text"].get<std::string>()), std::string::npos) << result.err;
}

// What can be drawn is baked, but who asked for all of it is told by the exit code, too.
TEST(CliBake, FailsWhereAPathIsTooMuch) {
  std::string tangle = "<svg xmlns='http://www.w3.org/2000/svg' width='99' height='99'><rect width='9' height='9'/>\n"
                       "<path d='M0 0";
  uint32_t random = 1;
  const auto next = [&] { return std::to_string((random = random * 1664525u + 1013904223u) >> 16); };
  for (int i = 0; i < 20000; ++i) tangle += "L" + next() + " " + next();
  const TemporaryFile drawing("tangle.svg", tangle + "z'/></svg>"), out("tangle.gpgpv");
  for (const bool json : {false, true}) {
    std::vector<std::string> line = {"bake", drawing.path(), "-o", out.path()};
    if (json) line.push_back("--json");
    const ProcessResult result = gpgp(line);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_NE(result.err.find("tangle.svg:2:"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("gpgp bake: 1 error\n"), std::string::npos) << result.err;
    EXPECT_GT(std::filesystem::file_size(out.path()), 0u);
  }
}

TEST(CliBake, ReadsStyleSheetsBesideTheDrawingAndNowhereElse) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / "gpgp_cli_test_sheets", inside = folder / "drawings";
  fs::remove_all(folder);
  host::writeFile((inside / "css/a.css").string(), ".a{fill:#f00}");
  host::writeFile((folder / "out.css").string(), ".a{fill:#f00}");
  std::error_code failed;
  fs::create_symlink(folder / "out.css", inside / "link.css", failed);
  const std::string rest = "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><rect class='a' width='9' "
                           "height='9'/></svg>",
                    file = (inside / "a.svg").string();
  const auto baked = [&](const std::string& sheet) {
    host::writeFile(file, "<?xml-stylesheet href='" + sheet + "'?>\n" + rest);
    const ProcessResult result = gpgp({"bake", file, "-o", (folder / "a.gpgpv").string(), "--json"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return result;
  };
  EXPECT_EQ(baked("css/a.css").err, "");
  host::writeFile(file, rest);
  const std::string red = host::readText((folder / "a.gpgpv").string());
  gpgp({"bake", file, "-o", (folder / "b.gpgpv").string()});
  EXPECT_FALSE(red == host::readText((folder / "b.gpgpv").string())) << "the sheet paints nothing";
  for (const char* sheet : {"no.css", "../out.css", "css", "http://localhost/a.css"})
    EXPECT_NE(baked(sheet).err.find(file + ":1:1: warning: the style sheet '" + sheet + "' "), std::string::npos)
        << sheet;
  if (!failed) {
    EXPECT_NE(baked("link.css").err.find("'link.css' cannot be read"), std::string::npos);
  }
  fs::remove_all(folder);
}

TEST(CliBake, WrongUsage) {
  const TemporaryFile grammar("usage2.pga", kGrammar), text("usage2.text", kGrammar);
  expectWrongUsage({{"bake"},
                    {"bake", grammar.path()},
                    {"bake", text.path(), "-o", "x.gpgp"},
                    {"bake", "-", "-o", "x.gpgp"},
                    {"bake", grammar.path(), grammar.path(), "-o", "-"},
                    {"bake", grammar.path(), "-o", "-", "--json"},
                    {"bake", grammar.path(), "--set", "n", "-o", "x.gpgp"}});
}

} // namespace
} // namespace gpgp::test
