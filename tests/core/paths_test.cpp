// Files whose names have spaces and letters of other scripts, a character outside the basic plane among them: names are
// UTF-8 wherever a program of ours or the library takes one, whichever code page the system has.
#include "core/open_file.h"
#include "host/device.h"
#include "host/files.h"

#include <gpgp/gpgp.h>
#include <gtest/gtest.h>

#include <fstream>

namespace {
namespace fs = std::filesystem;
using namespace gpgp;

struct PathsTest : testing::Test {
  const std::string folder = testing::TempDir() + "/gpgp Pfäde δρόμος 路 🛤";
  const std::string file = folder + "/größe und maß 🂡.txt";
  void SetUp() override { fs::remove_all(folder); }
  void TearDown() override { fs::remove_all(folder); }
};

TEST_F(PathsTest, FilesAreWrittenReadAndReplaced) {
  host::writeFile(file, "one\r\ntwo\n");
  EXPECT_EQ(host::readText(file), "one\r\ntwo\n") << "line ends are bytes like others";
  host::writeFile(file, "three");
  EXPECT_EQ(host::readText(file), "three");
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  EXPECT_EQ(names, std::vector<std::string>{"größe und maß 🂡.txt"}) << "nothing is left beside the file";
  std::ifstream named(file), path{fs::path(file)};
  EXPECT_TRUE(named);
  EXPECT_TRUE(path);
}

TEST_F(PathsTest, TheSystemSeesTheSameName) {
  host::writeFile(file, "x");
  const fs::path expected = fs::path(u8"größe und maß 🂡.txt");
  for (const auto& entry : fs::directory_iterator(folder)) EXPECT_EQ(entry.path().filename(), expected);
  EXPECT_EQ(fs::path(file).filename(), expected);
}

TEST_F(PathsTest, TheLibraryOpensThem) {
  host::writeFile(file, "bytes");
  EXPECT_TRUE(core::openToRead(file.c_str()));
  EXPECT_FALSE(core::openToRead((file + "x").c_str()));
  EXPECT_FALSE(core::openToRead((folder + "/\xff\xfe").c_str())) << "no UTF-8, and no such file";
}

#ifdef GPGP_WITH_VECTOR
TEST_F(PathsTest, AssetsAreReadFromThem) {
  host::HeadlessDevice device{host::DeviceOptions{}};
  std::string message;
  GpgpContextCreateInfo info = device.contextCreateInfo();
  info.messageUserData = &message;
  info.messageFn = [](void* user, const GpgpMessage* m) { *static_cast<std::string*>(user) = m->text; };
  GpgpContext context = nullptr;
  ASSERT_EQ(gpgpCreateContext(&info, &context), GPGP_SUCCESS);
  GpgpDrawingCreateInfo drawingInfo = GPGP_DRAWING_CREATE_INFO_INIT;
  drawingInfo.filePath = file.c_str();
  GpgpAsset drawing = nullptr;
  EXPECT_EQ(gpgpCreateDrawing(context, &drawingInfo, &drawing), GPGP_ERROR_IO);
  EXPECT_NE(message.find(file), std::string::npos) << message;
  host::writeFile(file, "found, but no drawing");
  EXPECT_EQ(gpgpCreateDrawing(context, &drawingInfo, &drawing), GPGP_ERROR_INVALID_DATA) << message;
  gpgpDestroyContext(context);
}
#endif

} // namespace
