// The mini-engine's game screen, as its summary and pictures show it: hit tests find the menu's items, nothing
// between them, and the inventory's slots in perspective; a changed score changes no pixel outside of its box, nothing
// is converted or allocated in a settled frame, without fonts the screen is there without text, both eyes see the
// inventory in its frame, and a window's events drive the menu. What each panel looks like is stored in pictures. Every
// run is validated.
#include "host/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace {
using gpgp::host::Picture;
namespace fs = std::filesystem;

const fs::path kOut = GPGP_GOLDEN_OUT "-screen";

struct Shown {
  std::string text;
  Picture picture;
};

/// Runs the screen, with standard error in its text; the process is to succeed, and throws where it has no picture,
/// which a test could only read on without. before: a command that runs it.
Shown runScreen(const std::string& name, const std::string& arguments, const std::string& data = GPGP_TEST_DATA,
                const std::string& before = "") {
  const fs::path folder = kOut / name;
  fs::remove_all(folder);
  const std::string command = before + "\"" + GPGP_MINI_ENGINE + "\" --screen --validate --data \"" + data +
                              "\" --out \"" + folder.string() + "\" " + arguments + " 2>&1";
  Shown run;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot run " + command);
  char part[256];
  while (std::fgets(part, sizeof part, pipe)) run.text += part;
  EXPECT_EQ(pclose(pipe), 0) << command << "\n" << run.text;
  EXPECT_NE(run.text.find("validation  0 messages"), std::string::npos) << run.text;
  if (!fs::exists(folder / "screen.png")) throw std::runtime_error(command + " has made no screen.png:\n" + run.text);
  run.picture = gpgp::host::readPng(folder / "screen.png");
  return run;
}

using Box = std::array<unsigned, 4>; // left, top, right, bottom

/// What each input did, a line for each.
std::string happenings(const std::string& text) {
  std::string said;
  for (size_t line = text.find("input  "); line != std::string::npos; line = text.find("\ninput  ", line + 1)) {
    const size_t begin = text.find("input", line) + 12;
    said += text.substr(begin, text.find('\n', begin) - begin) + "\n";
  }
  return said;
}

/// What follows a label in the summary: "score       23 at 534,26 to 620,47". Throws where there is none.
Box boxOf(const std::string& text, const std::string& label) {
  Box box{};
  const size_t line = text.find("\n" + label), at = line == std::string::npos ? line : text.find(" at ", line);
  if (at == std::string::npos ||
      std::sscanf(text.c_str() + at, " at %u,%u to %u,%u", &box[0], &box[1], &box[2], &box[3]) != 4)
    throw std::runtime_error("no box of " + label + " in\n" + text);
  return box;
}

const char* const kItems[] = {"Pause", "Night", "Hide inventory", "Next line", "Quit"};

bool hasFonts() { return fs::exists(std::string(GPGP_TEST_DATA) + "/fetched/fonts/Inter-roman.var.ttf"); }

TEST(Screen, ScoreChangesOnlyItsBoxAndASettledFrameConvertsNothing) {
  if (!hasFonts()) GTEST_SKIP() << "no fonts in " << GPGP_TEST_DATA << ": run tests/data/fetch.sh";
  const Shown before = runScreen("score", "--frames 2 --size 640x360");
  if (before.text.find("without libgpgp_text") != std::string::npos) GTEST_SKIP() << "built without text";
  const Shown after = runScreen("score-higher", "--frames 2 --size 640x360 --score 4700888");
  EXPECT_NE(before.text.find("last converted in frame 1 of 2; gpgp allocated host memory last in frame 1"),
            std::string::npos)
      << before.text;
  const Box box = boxOf(before.text, "score ");
  ASSERT_EQ(before.picture.rgba.size(), after.picture.rgba.size());
  size_t inside = 0, outside = 0;
  for (unsigned y = 0; y < before.picture.height; ++y)
    for (unsigned x = 0; x < before.picture.width; ++x) {
      const size_t pixel = 4 * (size_t{y} * before.picture.width + x);
      bool equal = true;
      for (size_t c = 0; c < 4; ++c) equal = equal && before.picture.rgba[pixel + c] == after.picture.rgba[pixel + c];
      if (equal) continue;
      const bool in = x >= box[0] && x < box[2] && y >= box[1] && y < box[3];
      ++(in ? inside : outside);
    }
  EXPECT_GT(inside, 100u);
  EXPECT_EQ(outside, 0u);
  // Letters in one colour on a button in another have the area of their edges: 16 samples would mix in 17 ways.
  const Box button = boxOf(before.text, std::string("menu        ") + kItems[3]);
  std::set<std::array<uint8_t, 3>> colours;
  for (unsigned y = button[1] + 4; y < button[3] - 4; ++y)
    for (unsigned x = button[0] + 6; x < button[2] - 6; ++x) {
      const uint8_t* p = &before.picture.rgba[4 * (size_t{y} * before.picture.width + x)];
      colours.insert({p[0], p[1], p[2]});
    }
  EXPECT_GT(colours.size(), 40u);
  // The flame in the dialogue's first line, a glyph that is a picture: nothing else is orange there.
  if (!fs::exists(std::string(GPGP_TEST_DATA) + "/fetched/fonts/NotoColorEmoji.ttf")) return;
  size_t orange = 0;
  for (unsigned y = 287; y < 348; ++y)
    for (unsigned x = 224; x < 495; ++x) {
      const uint8_t* p = &before.picture.rgba[4 * (size_t{y} * before.picture.width + x)];
      orange += p[0] > 180 && p[1] > 60 && p[1] < 200 && p[2] < 90;
    }
  EXPECT_GT(orange, 5u);
  EXPECT_LT(orange, 120u);
}

/// Shown so: what the inputs made of the screen, and the panels that are compared.
struct Stored {
  const char* name;
  const char* inputs;
  std::vector<Box> panels;
};

/// Of two pictures the block of 8 x 8 pixels, about a letter's size, that differs most: mean over its channels.
struct Block {
  double mean = 0;
  unsigned x = 0, y = 0;
};
Block worstBlock(const Picture& a, const Picture& b) {
  constexpr unsigned kSide = 8;
  Block worst;
  for (unsigned y = 0; y < a.height; y += kSide)
    for (unsigned x = 0; x < a.width; x += kSide) {
      unsigned sum = 0;
      for (unsigned row = y; row < std::min(y + kSide, a.height); ++row)
        for (unsigned column = x; column < std::min(x + kSide, a.width); ++column)
          for (size_t c = 0; c < 3; ++c) {
            const size_t at = 4 * (size_t{row} * a.width + column) + c;
            sum += static_cast<unsigned>(std::abs(a.rgba[at] - b.rgba[at]));
          }
      const double mean = sum / (3.0 * kSide * kSide);
      if (mean > worst.mean) worst = {mean, x, y};
    }
  return worst;
}

// Tolerance: edges of the scene around the panels move by a sample between devices, as in golden_test.cpp. A comma that
// is missing is a difference of 4/255 in its block, a letter one of 11 to 23, shapes moved by an eighth of a pixel one
// of 5; letters with three quarters of their blue are 0.17/255 on average.
TEST(Screen, PanelsLookAsStored) {
  for (const char* needed : {"fonts/Inter-roman.var.ttf", "fonts/NotoColorEmoji.ttf", "fonts/NotoSansCJK-Regular.ttc",
                             "fonts/NotoSansArabic-Regular.ttf", "models/2CylinderEngine.glb", "svg/tiger.svgz"})
    if (!fs::exists(std::string(GPGP_TEST_DATA) + "/fetched/" + needed))
      GTEST_SKIP() << GPGP_TEST_DATA << "/fetched/" << needed << " is missing: run tests/data/fetch.sh";
  const Box status = {9, 9, 143, 51}, score = {396, 9, 471, 39}, map = {399, 183, 471, 261}, menu = {9, 66, 92, 190},
            dialogue = {113, 199, 368, 261}, inventory = {302, 42, 434, 134};
  for (const Stored& state :
       {Stored{"game", "", {status, score, map, menu, dialogue, inventory}},
        Stored{"dialogue", "--input down,down,down,enter", {dialogue}},
        Stored{"menu", "--input down,down,enter", {menu, inventory}}, // hidden: the scene behind it
        Stored{"inventory", "--input down,enter,402x90", {inventory}}}) {
    SCOPED_TRACE(state.name);
    const Shown run =
        runScreen(std::string("stored-") + state.name, std::string("--frames 2 --size 480x270 ") + state.inputs);
    if (run.text.find("without libgpgp_text") != std::string::npos) GTEST_SKIP() << "built without text";
    ASSERT_EQ(run.picture.width, 480u);
    ASSERT_EQ(run.picture.height, 270u);
    Picture panels{480, 270, std::vector<uint8_t>(run.picture.rgba.size())};
    for (const Box& box : state.panels)
      for (unsigned y = box[1]; y < box[3]; ++y) {
        const auto row = static_cast<std::ptrdiff_t>(4 * (size_t{y} * 480 + box[0]));
        std::copy_n(run.picture.rgba.begin() + row, 4 * (box[2] - box[0]), panels.rgba.begin() + row);
      }
    const std::string name = std::string("screen-") + state.name + ".png";
    gpgp::host::writePng(kOut / "stored" / name, panels); // regenerate.sh takes it from here
    EXPECT_TRUE(fs::exists(fs::path(GPGP_GOLDEN) / name)) << name;
    if (!fs::exists(fs::path(GPGP_GOLDEN) / name)) continue;
    const Picture stored = gpgp::host::readPng(fs::path(GPGP_GOLDEN) / name);
    const double mean = gpgp::host::compare(panels, stored).mean;
    const Block worst = worstBlock(panels, stored);
    std::printf("%s: mean difference %.4f/255, at most %.2f/255 in a block, at %u,%u\n", name.c_str(), mean, worst.mean,
                worst.x, worst.y);
    EXPECT_LT(mean, 0.1) << (kOut / "stored" / name);
    EXPECT_LT(worst.mean, 3.0) << (kOut / "stored" / name);
  }
}

TEST(Screen, ScoresHaveSevenDigits) {
  for (const char* score : {"-5", "10000000", "99999999999999999999", "12x", "+7", ""}) {
    const std::string command =
        std::string("\"") + GPGP_MINI_ENGINE + "\" --screen --score \"" + score + "\" 2>/dev/null";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2) << score;
  }
  const Shown highest = runScreen("score-highest", "--frames 2 --size 640x360 --score 9999999");
  EXPECT_NE(highest.text.find("score       9999999 at"), std::string::npos) << highest.text;
}

TEST(Screen, MenuIsDrivenByMouseAndKeysAndIsThereWithoutFonts) {
  // A folder of test data in which nothing was fetched.
  const fs::path data = kOut / "data";
  fs::remove_all(data);
  fs::create_directories(data);
  for (const char* part : {"grammars", "svg"})
    fs::copy(fs::path(GPGP_TEST_DATA) / part, data / part, fs::copy_options::recursive);
  const Shown still = runScreen("still", "--frames 2 --size 320x180 --input up,enter", data.string());
  EXPECT_NE(still.text.find("input       chose Quit\n"), std::string::npos) << still.text;
  EXPECT_NE(still.text.find("in frame 0 of 1;"), std::string::npos) << still.text; // it quit, and nothing was converted
  if (still.text.find("without libgpgp_text") == std::string::npos) {
    EXPECT_NE(still.text.find("the screen goes without text"), std::string::npos) << still.text;
    EXPECT_NE(still.text.find("Inter-roman.var.ttf is not there"), std::string::npos) << still.text;
  }
  std::string inputs, happened;
  const auto input = [&](const std::string& what, const std::string& expected) {
    inputs += (inputs.empty() ? "" : ",") + what;
    happened += expected + "\n";
  };
  const auto at = [](unsigned x, unsigned y) { return std::to_string(x) + "x" + std::to_string(y); };
  Box boxes[5];
  for (size_t i = 0; i < 5; ++i) {
    boxes[i] = boxOf(still.text, std::string("menu        ") + kItems[i]);
    input(at((boxes[i][0] + boxes[i][2]) / 2, (boxes[i][1] + boxes[i][3]) / 2), std::string("over ") + kItems[i]);
  }
  ASSERT_LT(boxes[1][3], boxes[2][1]);
  input(at((boxes[1][0] + boxes[1][2]) / 2, (boxes[1][3] + boxes[2][1]) / 2), "over nothing");
  input("click", "nothing");
  input("268x60", "over slot 3");     // of the inventory, which hangs in the world
  input("down", "highlighted Pause"); // after Quit, which the mouse was over last
  input("down", "highlighted Night");
  input("enter", "chose Night");
  input(at(boxes[0][0] + 8, boxes[0][1] + 4), "over Pause");
  input("click", "chose Pause");
  input("click", "chose Resume"); // it does what it says
  const Shown run = runScreen("menu", "--frames 2 --size 320x180 --input " + inputs,
                              hasFonts() ? std::string(GPGP_TEST_DATA) : data.string());
  EXPECT_EQ(happenings(run.text), happened) << run.text;
  // By night it is darker: the mean of what lies between the panels.
  const auto light = [](const Picture& picture) {
    double sum = 0;
    for (unsigned x = picture.width * 3 / 10; x < picture.width * 8 / 10; ++x)
      sum += picture.rgba[4 * (size_t{picture.height / 40} * picture.width + x) + 1];
    return sum;
  };
  EXPECT_LT(light(run.picture), 0.6 * light(still.picture));
}

/// Panels find room beside each other, and the inventory hangs in sight.
TEST(Screen, NarrowPicturesShowAll) {
  const Shown run = runScreen("narrow", "--frames 2 --size 270x480 --input 225x212");
  EXPECT_EQ(happenings(run.text), "over slot 3\n");
  const Box score = boxOf(run.text, "score "), menu = boxOf(run.text, "menu        Pause");
  const double unit = (menu[2] - menu[0]) / 196.0;
  EXPECT_GT(score[0], 380 * unit) << "right of the status";
  EXPECT_LT(score[2], 270u);
}

/// In a window of a virtual display: its events go through SDL, and the window shows what the headless picture has.
TEST(Screen, AWindowsEventsDriveTheMenu) {
  if (!fs::exists(GPGP_XVFB_RUN)) GTEST_SKIP() << "no xvfb-run (Debian: xvfb, xauth)";
  const std::string size = "--size 640x360 --frames 3 ";
  const Shown still = runScreen("window-still", size);
  const auto middle = [&](const char* item) {
    const Box box = boxOf(still.text, std::string("menu        ") + item);
    return std::to_string((box[0] + box[2]) / 2) + "x" + std::to_string((box[1] + box[3]) / 2);
  };
  // By mouse, by keys from there, by mouse again: onto the item, and past all of them.
  const std::string inputs =
      "--input " + middle("Night") + ",click,down,enter," + middle("Next line") + ",click,320x40,click";
  const Shown headless = runScreen("window-none", size + inputs);
  EXPECT_EQ(happenings(headless.text), "over Night\nchose Night\nhighlighted Hide inventory\nchose Hide inventory\n"
                                       "over Next line\nchose Next line\nover nothing\nnothing\n");
  const Shown window =
      runScreen("window", "--window " + size + inputs, GPGP_TEST_DATA,
                std::string("SDL_VIDEODRIVER=x11 \"") + GPGP_XVFB_RUN + "\" -a -s \"-screen 0 1280x800x24\" ");
  // A click says where it is, too; the display's own pointer may have been somewhere before.
  EXPECT_NE(happenings(window.text)
                .find("over Night\nover Night\nchose Night\nhighlighted Hide inventory\nchose Hide inventory\n"
                      "over Next line\nover Next line\nchose Next line\nover nothing\nover nothing\nnothing\n"),
            std::string::npos)
      << window.text;
  ASSERT_EQ(window.picture.width, 640u);
  ASSERT_EQ(window.picture.height, 360u);
  EXPECT_EQ(gpgp::host::compare(window.picture, headless.picture).pixelsDifferent, 0u);
  EXPECT_GT(gpgp::host::compare(window.picture, still.picture).mean, 5.0) << "night, and no inventory";
}

/// The brass of the inventory's frame, which nothing else has around its upper half: how many of its pixels lie there
/// in an eye's part of the picture, and the leftmost column of them.
struct Brass {
  size_t pixels = 0;
  unsigned left = ~0u;
};
Brass brassIn(const Picture& picture, unsigned begin, unsigned end) {
  Brass found;
  const unsigned width = end - begin;
  for (unsigned y = picture.height * 14 / 100; y < picture.height * 34 / 100; ++y)
    for (unsigned x = begin + width * 6 / 10; x < begin + width * 95 / 100; ++x) {
      const uint8_t* p = &picture.rgba[4 * (size_t{y} * picture.width + x)];
      if (p[0] < 120 || p[1] < p[0] / 2 || p[1] > p[0] * 9 / 10 || p[2] > p[1] * 7 / 10) continue;
      ++found.pixels;
      found.left = std::min(found.left, x - begin);
    }
  return found;
}

TEST(Screen, StereoHangsTheInventoryBeforeBothEyes) {
  const Shown run = runScreen("stereo", "--frames 2 --size 960x270 --stereo --input 847x87");
  EXPECT_NE(run.text.find("input       over slot"), std::string::npos) << run.text; // by the right eye's part, too
  const unsigned width = run.picture.width / 2;
  ASSERT_EQ(width, 480u);
  const Brass left = brassIn(run.picture, 0, width), right = brassIn(run.picture, width, 2 * width);
  EXPECT_GT(left.pixels, 150u);
  EXPECT_GT(right.pixels, 150u);
  // What the right eye sees lies further left, by no more than what is near would.
  EXPECT_GT(left.left, right.left);
  EXPECT_LT(left.left, right.left + 24);
  // The panels in front are the same for both: where the menu's highlight is, nothing shines through.
  const Box box = boxOf(run.text, "menu        Pause");
  size_t different = 0;
  for (unsigned y = box[1] + 2; y + 2 < box[3]; ++y)
    for (unsigned x = box[0] + 2; x + 2 < box[2]; ++x)
      for (size_t c = 0; c < 3; ++c)
        different += run.picture.rgba[4 * (size_t{y} * run.picture.width + x) + c] !=
                     run.picture.rgba[4 * (size_t{y} * run.picture.width + x + width) + c];
  EXPECT_EQ(different, 0u);
}

} // namespace
