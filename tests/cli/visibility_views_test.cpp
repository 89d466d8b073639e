// `gpgp visibility` from many cameras, with each method, and its overlay.
#include "files.h"
#include "host/picture.h"
#include "run.h"

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

#include <cmath>
#include <functional>
#include <sstream>

namespace gpgp::test {
namespace {

using Args = std::vector<std::string>;
using Ids = std::set<uint32_t>;

Args operator+(Args args, const Args& more) {
  args.insert(args.end(), more.begin(), more.end());
  return args;
}

/// As --camera reads it.
std::string textOf(const glm::dmat4& camera, bool reversed = false) {
  std::ostringstream text;
  text.precision(9);
  for (int i = 0; i < 16; ++i) text << camera[i / 4][i % 4] << ' ';
  if (reversed) text << 1;
  return text.str();
}

/// Runs and reads what --export-ids wrote.
Ids idsOf(const Args& args) {
  const TemporaryFile file("views.ids");
  gpgpJson(args + Args{"--export-ids", file.path()});
  const std::string bytes = host::readText(file.path());
  EXPECT_EQ(bytes.size() % 4, 0u);
  Ids ids;
  uint32_t last = 0;
  for (size_t i = 0; i + 4 <= bytes.size(); i += 4) {
    const auto byte = [&](size_t b) { return uint32_t{static_cast<unsigned char>(bytes[i + b])}; };
    const uint32_t id = byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
    EXPECT_TRUE(ids.empty() || id > last) << "ascending";
    last = id;
    ids.insert(id);
  }
  return ids;
}

/// Those that are in one of both only.
size_t differenceOf(const Ids& a, const Ids& b) {
  Ids both;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::inserter(both, both.end()));
  return both.size();
}

/// A ball of radius 1 round (5, 2, -3), so finely cut that each change of the camera changes what pixels' centres see.
std::string ball() {
  constexpr int kAround = 96, kUp = 48;
  std::ostringstream obj;
  for (int j = 0; j <= kUp; ++j)
    for (int i = 0; i < kAround; ++i) {
      const double pi = std::acos(-1.0), turn = 2 * pi * i / kAround, rise = pi * j / kUp - pi / 2;
      obj << "v " << 5 + std::cos(rise) * std::sin(turn) << ' ' << 2 + std::sin(rise) << ' '
          << -3 + std::cos(rise) * std::cos(turn) << '\n';
    }
  for (int j = 0; j < kUp; ++j)
    for (int i = 0; i < kAround; ++i) {
      const int a = j * kAround + i + 1, b = j * kAround + (i + 1) % kAround + 1;
      obj << "f " << a << ' ' << b << ' ' << b + kAround << ' ' << a + kAround << '\n';
    }
  return obj.str();
}

/// What the issue says of camera k of n: at the scene's centre, elevation 20 degrees, 60 degrees vertical field of
/// view, from so many radii of the sphere round the bounds.
glm::dmat4 orbitCamera(int k, int n, double radii, double elevation = 20, double field = 60) {
  const double turn = 2 * std::acos(-1.0) * k / n, rise = glm::radians(elevation);
  const glm::dvec3 centre(5, 2, -3);
  const glm::dvec3 eye =
      centre + radii * std::sqrt(3.0) *
                   glm::dvec3(std::cos(rise) * std::sin(turn), std::sin(rise), std::cos(rise) * std::cos(turn));
  glm::dmat4 projection = glm::perspectiveRH_ZO(glm::radians(field), 96.0 / 64.0, 0.25, 40.0);
  projection[1][1] *= -1;
  return projection * glm::lookAtRH(eye, centre, glm::dvec3(0, 1, 0));
}

/// An .obj whose vertices lie elsewhere.
std::string moved(const std::string& obj, const glm::dvec3& by) {
  std::istringstream in(obj);
  std::ostringstream out;
  out.precision(17);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string word;
    glm::dvec3 at;
    if (words >> word >> at.x >> at.y >> at.z && word == "v")
      out << "v " << at.x + by.x << ' ' << at.y + by.y << ' ' << at.z + by.z << '\n';
    else
      out << line << '\n';
  }
  return out.str();
}

TEST(CliVisibilityViews, FarFromTheOriginAModelKeepsItsForm) {
  // There floats are 8 mm apart, and the ball's triangles 3 to 65 mm wide.
  const glm::dvec3 by(1e5, 0.7e5, -1.3e5);
  const TemporaryFile near("near.obj", ball()), far("far.obj", moved(ball(), by));
  const auto look = [&](const TemporaryFile& model, const Args& camera) {
    return idsOf(Args{"visibility", model.path(), "--method", "exact", "--size", "200x150"} + camera);
  };
  for (const Args& camera : {Args{}, Args{"--orbit", "3"}}) {
    const Ids found = look(near, camera);
    EXPECT_LE(differenceOf(found, look(far, camera)), found.size() / 500);
  }
  glm::dmat4 projection = glm::perspectiveRH_ZO(0.9, 200.0 / 150, 0.5, 20.0);
  projection[1][1] *= -1;
  const glm::dmat4 view = projection * glm::lookAtRH(glm::dvec3(6, 4, 0), glm::dvec3(5, 2, -3), {0, 1, 0});
  const auto file = [](const glm::dmat4& camera) {
    std::ostringstream text;
    text.precision(17);
    for (int i = 0; i < 16; ++i) text << camera[i / 4][i % 4] << ' ';
    return text.str();
  };
  const TemporaryFile here("here.cam", file(view)), there("there.cam", file(glm::translate(view, -by)));
  const Ids found = look(near, {"--camera", here.path()});
  EXPECT_GT(found.size(), 2000u);
  EXPECT_LE(differenceOf(found, look(far, {"--camera", there.path()})), found.size() / 500);
}

TEST(CliVisibilityViews, OrbitIsWhereItIsStated) {
  const TemporaryFile model("ball.obj", ball());
  const Args plain{"visibility", model.path(), "--size", "96x64"};
  const auto from = [&](const std::vector<glm::dmat4>& cameras) {
    Ids all;
    for (const glm::dmat4& camera : cameras) {
      const TemporaryFile file("orbit_camera.txt", textOf(camera));
      all.merge(idsOf(plain + Args{"--camera", file.path()}));
    }
    return all;
  };
  const Ids orbit = idsOf(plain + Args{"--orbit", "2", "--distance", "1.7"});
  ASSERT_GT(orbit.size(), 1000u);
  const size_t most = orbit.size() / 50; // centres that lie on an edge, but for rounding
  EXPECT_LE(differenceOf(orbit, from({orbitCamera(0, 2, 1.7), orbitCamera(1, 2, 1.7)})), most);
  EXPECT_GT(differenceOf(orbit, from({orbitCamera(0, 2, 1.73), orbitCamera(1, 2, 1.73)})), 5 * most);
  EXPECT_GT(differenceOf(orbit, from({orbitCamera(0, 2, 1.7, 21), orbitCamera(1, 2, 1.7, 21)})), 5 * most);
  EXPECT_GT(differenceOf(orbit, from({orbitCamera(0, 2, 1.7, 20, 61), orbitCamera(1, 2, 1.7, 20, 61)})), 5 * most);
  EXPECT_GT(differenceOf(orbit, from({orbitCamera(0, 2, 1.7), orbitCamera(1, 3, 1.7)})), 5 * most);
  const Ids fromTwo = idsOf(plain + Args{"--orbit", "1"});
  EXPECT_LE(differenceOf(fromTwo, from({orbitCamera(0, 1, 2)})), fromTwo.size() / 50)
      << "two radii where none is given";
}

// Two squares back to back: each camera sees one.
TEST(CliVisibilityViews, OrbitAveragesFiguresAndUnitesIds) {
  const TemporaryFile model("back_to_back.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                                                "f 1 2 3 4\nf 4 3 2 1\nf 4 3 2\n");
  const Args args{"visibility", model.path(), "--size", "64x48", "--orbit", "2", "--method", "exact"};
  const json seen = gpgpJson(args);
  EXPECT_EQ(seen["cameras"], 2);
  EXPECT_EQ(seen["triangles"], 5);
  EXPECT_EQ(idsOf(args), (Ids{0, 1, 2, 3})) << "of identical triangles the lower number is seen";
  EXPECT_EQ(seen["visible"], 2);
  EXPECT_EQ(seen["facing"], 3) << "two from the front, three from behind, rounded";
}

// Of one depth are more than a pixel's list can sort. Seen from behind they are back faces.
TEST(CliVisibilityViews, WhatOneCameraExceedsIsReported) {
  std::string stack = "v -1 -1 -1\nv 1 1 1\nv -0.004 -0.003 0\nv 0.004 -0.003 0\nv 0.001 0.005 0\n";
  for (int i = 0; i < 2000; ++i) stack += "f 3 4 5\n";
  const TemporaryFile model("stack.obj", stack);
  Args args{"visibility", model.path(), "--size", "32x32", "--method", "exact", "--orbit"};
  const json first = gpgpJson(args + Args{"1"});
  ASSERT_EQ(first["status"], "GPGP_BUDGET_EXCEEDED");
  EXPECT_GT(first["visible"], 500) << "the last of them are not decided";
  const json both = gpgpJson(args + Args{"2"});
  EXPECT_EQ(both["visible"], std::llround(first["visible"].get<double>() / 2)) << "the second camera sees none";
  for (const char* key : {"status", "unresolved", "neededCandidates", "neededPairs"})
    EXPECT_EQ(both[key], first[key]) << key;
  const ProcessResult text = gpgp(args + Args{"2"});
  EXPECT_NE(text.out.find("no budget changes that"), std::string::npos) << text.out;
  EXPECT_EQ(text.out.find("budget exceeded"), std::string::npos) << text.out;
}

TEST(CliVisibilityViews, GridIsCopiesSideBySide) {
  const TemporaryFile model("tile.obj", "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nf 1 2 3 4\n");
  // Straight down on 0 to 2.1 by 0 to 3.2, a hundred pixels for 1.
  glm::dmat4 camera(0);
  camera[0] = {2 / 2.1, 0, 0, 0};
  camera[2] = {0, 2 / 3.2, 0, 0};
  camera[1] = {0, 0, -0.1, 0};
  camera[3] = {-1, -1, 0.5, 1};
  const TemporaryFile file("down.txt", textOf(camera));
  const Args args{"visibility", model.path(), "--size", "210x320", "--camera", file.path(), "--grid"};
  const json seen = gpgpJson(args + Args{"2x3"});
  EXPECT_EQ(seen["triangles"], 12);
  EXPECT_EQ(seen["draws"], 6);
  EXPECT_EQ(seen["visible"], 12);
  EXPECT_NEAR(seen["coveredPixels"].get<double>(), 6 * 100 * 100, 300) << "a tenth apart";
  EXPECT_NEAR(gpgpJson(args + Args{"3x1"})["coveredPixels"].get<double>(), 2 * 100 * 100, 200) << "columns go right";
  const std::string failure = gpgpFailure({"visibility", model.path(), "--grid", "16384x16384"});
  EXPECT_NE(failure.find("536870912 triangles"), std::string::npos) << failure;
  EXPECT_NE(failure.find("the device binds at most"), std::string::npos) << failure;
}

TEST(CliVisibilityViews, GridsOfFlatModels) {
  const TemporaryFile model("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const json rows = gpgpJson({"visibility", model.path(), "--size", "64x64", "--yaw", "60", "--grid", "2x3"});
  EXPECT_EQ(rows["triangles"], 6);
  EXPECT_EQ(rows["visible"], 6) << "of copies in one place the first is seen";
}

/// Pixels of a picture that are so coloured.
size_t count(const host::Picture& picture, const std::function<bool(int, int, int)>& isSo) {
  size_t n = 0;
  for (size_t i = 0; i < picture.rgba.size(); i += 4)
    if (isSo(picture.rgba[i], picture.rgba[i + 1], picture.rgba[i + 2])) ++n;
  return n;
}

TEST(CliVisibilityViews, SizesAreOfNoImportance) {
  const auto seen = [](const std::string& size, const Args& more) {
    const TemporaryFile model("size.obj", "v 0 0 0\nv " + size + " 0 0\nv " + size + ' ' + size + " 0\nv 0 " + size +
                                              " 0\nf 1 2 3 4\n"),
        image("size.png");
    const json figures = gpgpJson(Args{"visibility", model.path(), "--size", "32x32", "--image", image.path()} + more);
    const host::Picture picture = host::readPng(image.path());
    return std::pair(figures["coveredPixels"].get<int>(), count(picture, [](int r, int, int b) { return r > b + 60; }));
  };
  for (const Args& more : {Args{}, Args{"--yaw", "0", "--pitch", "0"}, Args{"--orbit", "1"}}) {
    const auto [pixels, orange] = seen("1", more);
    EXPECT_GT(pixels, 100);
    for (const char* size : {"1e-12", "1e-6", "1e12"}) {
      const auto [otherPixels, otherOrange] = seen(size, more);
      EXPECT_NEAR(otherPixels, pixels, 4) << size;
      EXPECT_NEAR(static_cast<double>(otherOrange), static_cast<double>(orange), 6) << size;
    }
  }
}

/// Looks from (0, 0, 3) along -z; sees so far to each side at distance 1: at z = 0 just a square of 2 x 2, without
/// more.
glm::dmat4 plainCamera(double half = 1.0 / 3.0) {
  glm::dmat4 projection = glm::perspectiveRH_ZO(2 * std::atan(half), 1.0, 1.0, 10.0);
  projection[1][1] *= -1;
  return projection * glm::lookAtRH(glm::dvec3(0, 0, 3), glm::dvec3(0), glm::dvec3(0, 1, 0));
}

// A square, and one that it hides from the middle.
constexpr const char* kHidden = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n"
                                "v -0.5 -0.5 -1\nv 0.5 -0.5 -1\nv 0.5 0.5 -1\nv -0.5 0.5 -1\nf 5 6 7 8\n";

TEST(CliVisibilityViews, CellsSeeRoundWhatHides) {
  const TemporaryFile model("hidden.obj", kHidden), camera("hidden.txt", textOf(plainCamera(2)));
  const Args args{"visibility", model.path(), "--size", "32x32", "--camera", camera.path()};
  EXPECT_EQ(idsOf(args), (Ids{0, 1}));
  EXPECT_EQ(idsOf(args + Args{"--method", "exact"}), (Ids{0, 1}));
  // At z = 3 the inner corner at 0.5 is seen past the outer edge at 1 from 2.5 on.
  EXPECT_EQ(idsOf(args + Args{"--method", "cell", "--cell", "2.2:9"}), (Ids{0, 1}));
  EXPECT_EQ(idsOf(args + Args{"--method", "cell", "--cell", "3.5:9"}), (Ids{0, 1, 2, 3}));
  EXPECT_EQ(idsOf(args + Args{"--method", "standard", "--cell", "3.5:9"}), (Ids{0, 1, 2, 3})) << "any method";
  // The scene's middle is 3.5 away, where a pixel is 7/16: view points lie 3 1/2 and 7 1/2 of them to each side.
  EXPECT_EQ(idsOf(args + Args{"--method", "cell", "--cell", "8x8/7"}), (Ids{0, 1}));
  EXPECT_EQ(idsOf(args + Args{"--method", "cell", "--cell", "16x16/15"}), (Ids{0, 1, 2, 3}));
}

bool isGreen(int r, int g, int b) { return g > 2 * r && g > 2 * b; }
bool isBlue(int r, int g, int b) { return b > 2 * r && b > 2 * g; }
bool isRed(int r, int g, int b) { return r > 2 * g && r > 2 * b; }
bool isGrey(int r, int g, int b) { return r == g && g == b && r < 160; } // lit, it is 153 at most
bool isBackground(int r, int g, int b) { return r > 240 && g > 240 && b > 240; }

/// A sheet, and before it, between the centres of two columns of pixels, a strip 0.8 of a pixel wide and 20 high.
/// (Pixels are 1/16 there.)
std::string strip() {
  std::ostringstream obj;
  obj << "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";
  for (const double y : {-10.0, 10.0})
    for (const double x : {0.6, 1.4}) obj << "v " << x / 16 << ' ' << y / 16 << " 0.0001\n";
  obj << "f 5 6 8 7\n";
  return obj.str();
}

TEST(CliVisibilityViews, MethodsAndOverlay) {
  const TemporaryFile model("strip.obj", strip()), camera("strip.txt", textOf(plainCamera())), png("strip.png");
  const Args args{"visibility", model.path(), "--size", "32x32", "--camera", camera.path()};
  EXPECT_EQ(idsOf(args), (Ids{0, 1}));
  EXPECT_EQ(idsOf(args + Args{"--samples", "8"}), (Ids{0, 1, 2, 3}));
  EXPECT_EQ(idsOf(args + Args{"--method", "exact"}), (Ids{0, 1, 2, 3}));
  // Of each row of an overlay's pixels, three for one of the viewport, the strip has two.
  constexpr uint32_t kAll = 96 * 96, kStrip = 2 * 60;
  const auto overlay = [&](const Args& more, json& figures) {
    figures = gpgpJson(args + more + Args{"--overlay", png.path()});
    return host::readPng(png.path());
  };
  json figures;
  const host::Picture missed = overlay({"--reference", "64"}, figures);
  EXPECT_EQ(missed.width, 96u);
  EXPECT_EQ(missed.height, 96u);
  EXPECT_EQ(figures["coverage"], 0.5);
  EXPECT_EQ(count(missed, isBlue), kStrip) << "missed";
  EXPECT_EQ(count(missed, isGreen), kAll - kStrip);

  const host::Picture added = overlay({"--method", "exact", "--reference", "64"}, figures);
  EXPECT_EQ(figures["coverage"], 1.0);
  EXPECT_EQ(figures["overestimation"], 0.0);
  EXPECT_EQ(count(added, isGreen), kAll - kStrip);
  EXPECT_EQ(count(added, isGrey), kStrip) << "the method's alone";
  // Both face the same light: 0.75 of it is green, 0.6 grey.
  EXPECT_NEAR(added.rgba[(48 * 96 + 51) * 4 + 1], 0.8 * added.rgba[1], 1);

  // One sample a pixel does not find the strip, 64 x 64 do: without them it is too much, with them it is not.
  const host::Picture tooMuch = overlay({"--method", "exact", "--reference", "1", "--recheck", "0"}, figures);
  EXPECT_EQ(figures["overestimation"], 1.0);
  EXPECT_EQ(count(tooMuch, isRed), kStrip);
  const host::Picture checked = overlay({"--method", "exact", "--reference", "1", "--recheck", "64"}, figures);
  EXPECT_EQ(figures["overestimation"], 0.0);
  EXPECT_EQ(figures["reference"], 4);
  EXPECT_EQ(checked.rgba, added.rgba) << "the overlay is of what the figures count";
}

/// Wires a tenth of a pixel wide before a wall, as many as rows of 16; between the points of a magnified picture.
std::string wires() {
  std::ostringstream obj;
  obj << "v -2 -2 -0.1\nv 2 -2 -0.1\nv 2 2 -0.1\nv -2 2 -0.1\nf 1 2 3 4\n";
  for (int i = 0; i < 16; ++i) {
    const double y = -1 + (i + 0.05) / 8;
    obj << "v -1 " << y << " 0\nv 1 " << y << " 0\nv 1 " << y + 0.0125 << " 0\nv -1 " << y + 0.0125 << " 0\n"
        << "f -4 -3 -2 -1\n";
  }
  return obj.str();
}

TEST(CliVisibilityViews, OverlaysShowWhatIsBelowAPixel) {
  const TemporaryFile png("below.png"), thin("wires.obj", wires()), plain("plain.txt", textOf(plainCamera()));
  const auto overlay = [&](const TemporaryFile& model, const Args& more, json& figures) {
    figures = gpgpJson(Args{"visibility", model.path(), "--size", "16x16", "--overlay", png.path()} + more);
    return host::readPng(png.path());
  };
  json figures;
  const Args wall{"--camera", plain.path(), "--reference", "16"};
  const host::Picture missed = overlay(thin, wall, figures);
  EXPECT_EQ(figures["visible"], 2);
  EXPECT_EQ(figures["reference"], 34);
  EXPECT_EQ(count(missed, isBlue), 16u * 48) << "each wire is a line of its pixels";
  EXPECT_EQ(count(missed, isGreen), 48u * 48 - 16 * 48);
  const host::Picture added = overlay(thin, wall + Args{"--method", "exact"}, figures);
  EXPECT_EQ(figures["visible"], 34);
  EXPECT_EQ(count(added, isGrey), 16u * 48);
  EXPECT_EQ(count(added, isGreen), 48u * 48 - 16 * 48);

  // Some twenty triangles a pixel: the centres show what standard sampling finds, all else what it misses.
  const TemporaryFile round("below_ball.obj", ball());
  const host::Picture small = overlay(round, {"--orbit", "1", "--reference", "4", "--recheck", "0"}, figures);
  size_t centres = 0;
  for (size_t y = 1; y < 48; y += 3)
    for (size_t x = 1; x < 48; x += 3) {
      const uint8_t* pixel = &small.rgba[(y * 48 + x) * 4];
      centres += isGreen(pixel[0], pixel[1], pixel[2]);
    }
  EXPECT_NEAR(static_cast<double>(centres), figures["coveredPixels"].get<double>(), 2);
  EXPECT_GT(count(small, isBlue), 4 * centres);
}

// A speck beside the centre of a pixel of a wall, which is hit by none of a picture's points.
TEST(CliVisibilityViews, OverlaysMarkSpecks) {
  const auto speck = [](double x, double y) { // in pixels from the middle
    std::ostringstream obj;
    obj << "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";
    for (const auto& [dx, dy] : {std::pair(0.0, 0.0), std::pair(0.06, 0.0), std::pair(0.0, 0.06)})
      obj << "v " << (x + dx) / 8 << ' ' << (y + dy) / 8 << " 0.0001\n";
    obj << "f 5 6 7\n";
    return obj.str();
  };
  const TemporaryFile camera("speck.txt", textOf(plainCamera())), png("speck.png");
  for (const auto& [x, y, column, row] :
       {std::tuple(0.55, 0.52, 26u, 22u), std::tuple(0.42, 0.52, 24u, 22u), std::tuple(0.02, 0.02, 24u, 23u)}) {
    const TemporaryFile model("speck.obj", speck(x, y));
    const json figures = gpgpJson({"visibility", model.path(), "--size", "16x16", "--camera", camera.path(),
                                   "--reference", "64", "--overlay", png.path()});
    ASSERT_EQ(figures["reference"], 3);
    const host::Picture picture = host::readPng(png.path());
    EXPECT_EQ(count(picture, isBlue), 1u);
    EXPECT_EQ(count(picture, isGreen), 48u * 48 - 1);
    const uint8_t* pixel = &picture.rgba[(row * 48 + column) * 4];
    EXPECT_TRUE(isBlue(pixel[0], pixel[1], pixel[2])) << "at " << column << ", " << row;
  }
}

TEST(CliVisibilityViews, OverlaysOfCellsShowNothingThroughWalls) {
  const TemporaryFile model("cell_overlay.obj", kHidden), camera("cell_overlay.txt", textOf(plainCamera(2))),
      png("cell_overlay.png");
  const json figures = gpgpJson({"visibility", model.path(), "--size", "32x32", "--camera", camera.path(), "--method",
                                 "cell", "--cell", "3.5:9", "--overlay", png.path()});
  EXPECT_EQ(figures["visible"], 4);
  EXPECT_EQ(count(host::readPng(png.path()), isGrey), 0u) << "the hidden square is seen from beside alone";
}

// The triangles overlap in no view, and so their numbers are known.
TEST(CliVisibilityViews, CountsAndSharesAreWrittenOut) {
  std::ostringstream obj;
  for (int i = 0; i < 120; ++i)
    for (int j = 0; j < 100; ++j) {
      const double x = (i + 0.05) / 60 - 1, y = (j + 0.05) / 50 - 1;
      obj << "v " << x << ' ' << y << " 0\nv " << x + 0.014 << ' ' << y << " 0\nv " << x << ' ' << y + 0.018
          << " 0\nf -3 -2 -1\n";
    }
  obj << "v 5 5 0\nv 6 5 0\nv 5 6 0\nf -3 -2 -1\n";
  const TemporaryFile many("many.obj", obj.str()), camera("many.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  const Args args{"visibility", many.path(), "--camera", camera.path(), "--size", "120x100", "--two-sided"};
  const std::string text = gpgp(args + Args{"--method", "exact", "--reference", "16"}).out;
  EXPECT_NE(text.find("\n12000 visible (99.99 %); GPU"), std::string::npos) << text;
  EXPECT_NE(text.find("\nreference 12000: coverage 100.00 %, overestimation 0.00 %;"), std::string::npos) << text;

  // Of two cameras one sees the square, one the triangle.
  const TemporaryFile both("means.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\nf 4 3 2\n");
  const std::string means =
      gpgp({"visibility", both.path(), "--size", "64x48", "--orbit", "2", "--method", "exact"}).out;
  EXPECT_NE(means.find("\n1.5 visible (50.00 %)"), std::string::npos) << means;
}

TEST(CliVisibilityViews, TimesOfCellsAndOrbits) {
  const TemporaryFile model("times.obj", kHidden), camera("times.txt", textOf(plainCamera(2)));
  const auto sumOf = [](const json& passes) {
    double sum = 0;
    for (const json& pass : passes) sum += pass["milliseconds"].get<double>();
    return sum;
  };
  const Args args{"visibility", model.path(), "--size", "32x32", "--method", "exact"};
  for (const Args& more : {Args{"--camera", camera.path(), "--cell", "4x4"}, Args{"--orbit", "3"}, Args{}}) {
    const json seen = gpgpJson(args + more);
    const json& times = seen["gpuMilliseconds"];
    const double median = seen["gpu_ms_median"];
    EXPECT_EQ(times["median"], median);
    EXPECT_EQ(times["repeats"], 1);
    EXPECT_EQ(times["least"], median) << "of one repeat";
    const double sum = sumOf(times["passes"]);
    double byName = 0;
    for (const auto& [name, time] : seen["passes"].items()) byName += time.get<double>();
    EXPECT_NEAR(byName, sum, 1e-6);
    // A single repeat is timed by its passes, too; medians of passes over cameras need not add up.
    EXPECT_LE(sum, median * (more.size() == 2 ? 2 : 1.001));
    EXPECT_GT(sum, median * 0.25) << "all views of a cell";
  }
}

// A floor from behind the eye to far before it: half of the picture.
TEST(CliVisibilityViews, OverlayOfWhatReachesBehindTheEye) {
  const TemporaryFile model("floor.obj", "v -500 0 500\nv 500 0 500\nv 500 0 -500\nv -500 0 -500\nf 1 2 3 4\n");
  glm::dmat4 projection = glm::perspectiveRH_ZO(1.0, 2.0, 0.1, 2000.0);
  projection[1][1] *= -1;
  const glm::dmat4 view = glm::lookAtRH(glm::dvec3(0, 1, 0), glm::dvec3(0, 1, -1), glm::dvec3(0, 1, 0));
  const TemporaryFile camera("floor.txt", textOf(projection * view)), overlay("floor.png"), image("floor_image.png");
  gpgpJson({"visibility", model.path(), "--size", "64x32", "--camera", camera.path(), "--overlay", overlay.path(),
            "--image", image.path()});
  const host::Picture picture = host::readPng(overlay.path());
  EXPECT_EQ(count(picture, isGreen), 192u * 48);
  EXPECT_EQ(count(picture, isBackground), 192u * 48);
  for (size_t y = 0; y < 96; ++y)
    EXPECT_EQ(picture.rgba[y * 192 * 4] > 240, y < 48) << "the floor is below, in row " << y;
  const host::Picture both = host::readPng(image.path());
  ASSERT_EQ(both.width, 128u);
  EXPECT_TRUE(isBackground(both.rgba[8 * 512], both.rgba[8 * 512 + 1], both.rgba[8 * 512 + 2]));
  EXPECT_FALSE(isBackground(both.rgba[24 * 512], both.rgba[24 * 512 + 1], both.rgba[24 * 512 + 2]))
      << "the image's left half is from the camera";
}

TEST(CliVisibilityViews, ReversedDepth) {
  const TemporaryFile model("reversed.obj", kHidden), overlay("reversed.png"), image("reversed_image.png");
  glm::dmat4 flip(1.0); // depth d becomes 1 - d
  flip[2][2] = -1;
  flip[3][2] = 1;
  const TemporaryFile camera("reversed.txt", textOf(flip * plainCamera(), true));
  const Args args{"visibility", model.path(), "--size", "32x32", "--camera", camera.path()};
  EXPECT_EQ(idsOf(args + Args{"--image", image.path(), "--overlay", overlay.path()}), (Ids{0, 1}));
  const host::Picture both = host::readPng(image.path());
  for (size_t y = 0; y < 32; ++y)
    for (size_t x = 0; x < 32; ++x) {
      const uint8_t* pixel = &both.rgba[(y * 64 + x) * 4];
      ASSERT_GT(pixel[0], pixel[2] + 60) << "the nearer one is orange and hides the grey one, " << x << ", " << y;
    }
  EXPECT_EQ(count(host::readPng(overlay.path()), isGreen), 96u * 96);
}

TEST(CliVisibilityViews, WalksTakeDecisionsOver) {
  const TemporaryFile model("walk.obj", ball());
  const auto walk = [&](const char* how) {
    return gpgpJson({"visibility", model.path(), "--size", "48x48", "--method", "exact", "--walk", how})["walk"];
  };
  const json still = walk("0,0,4");
  ASSERT_EQ(still["frames"].size(), 4u);
  for (size_t k = 0; k < 4; ++k) {
    const json& frame = still["frames"][k];
    EXPECT_GT(frame["allPixels"], 100) << k;
    EXPECT_GT(frame["visible"], 1000) << k;
    EXPECT_EQ(frame["late"], 0) << k;
    EXPECT_EQ(frame["kept"], 0) << k;
    EXPECT_EQ(frame["decided"], k ? json(0) : frame["allDecided"]) << k;
    EXPECT_EQ(frame["decidedPixels"], k ? json(0) : frame["allPixels"]) << k;
  }
  EXPECT_EQ(still["decidedPixels"], 0);
  // One degree a second.
  const json slow = walk("0,1,12,0.02");
  ASSERT_EQ(slow["frames"].size(), 12u);
  EXPECT_LT(slow["decided"], 0.7);
  EXPECT_LT(slow["decidedPixels"], 0.9);
  EXPECT_LE(slow["late"], 0.02);
  EXPECT_LE(slow["kept"], 0.02);
}

TEST(CliVisibilityViews, WhatIsWrongWithCameras) {
  const TemporaryFile model("wrong_cameras.obj", kHidden);
  const std::string good = textOf(plainCamera());
  const auto failure = [&](const std::string& contents, const Args& more = {}) {
    const TemporaryFile camera("wrong.txt", contents);
    return gpgpFailure(Args{"visibility", model.path(), "--size", "32x32", "--camera", camera.path()} + more);
  };
  EXPECT_NE(failure("0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0").find("no inverse"), std::string::npos);
  EXPECT_NE(failure("1 2 3").find("3 numbers"), std::string::npos);
  EXPECT_NE(failure(good + " reversed").find("word 17, 'reversed'"), std::string::npos);
  EXPECT_NE(failure(good + " 1 1").find("18 numbers"), std::string::npos);
  EXPECT_NE(failure(good + " nan").find("not a finite number"), std::string::npos);
  const glm::dmat4 away = plainCamera() * glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 20));
  EXPECT_NE(failure(textOf(away), {"--cell", "2x2"}).find("does not lie before the camera"), std::string::npos);
  expectWrongUsage({{"visibility", model.path(), "--cell", "inf:4"},
                    {"visibility", model.path(), "--cell", "1e38:4"},
                    {"visibility", model.path(), "--cell", "nan:4"},
                    {"visibility", model.path(), "--cell", "0:4"},
                    {"visibility", model.path(), "--cell", "1:5"},
                    {"visibility", model.path(), "--cell", "1:0"},
                    {"visibility", model.path(), "--cell", "65x1"},
                    {"visibility", model.path(), "--cell", "2x2/0"},
                    {"visibility", model.path(), "--cell", "2x2/-1"},
                    {"visibility", model.path(), "--cell", "4294967297x1"},
                    {"visibility", model.path(), "--cell", "2"}});
}

} // namespace
} // namespace gpgp::test
