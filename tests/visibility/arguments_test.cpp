// Bad arguments of the C functions: the documented code, one message that names the argument, nothing changed.
#include "gpu.h"

#include <fstream>

namespace gpgp::test {
namespace {

struct ArgumentsTest : VisibilityGpuTest {
  Scene scene = randomSoup(1, 10, 16, 16, true, false);
  std::unique_ptr<SceneBuffers> buffers;
  host::Buffer bits, list, count;
  GpgpRecorder recorder = nullptr;
  GpgpAsset set = nullptr;
  GpgpFrame f{};

  void SetUp() override {
    VisibilityGpuTest::SetUp();
    scene.input();
    recorder = createRecorder(64, 64);
    set = createGeometrySet(scene);
    buffers = std::make_unique<SceneBuffers>(device, scene);
    for (host::Buffer* buffer : {&bits, &list, &count})
      *buffer = host::Buffer(device, 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    upload();
    f = advance();
  }
  void TearDown() override {
    buffers.reset();
    for (host::Buffer* buffer : {&bits, &list, &count}) *buffer = host::Buffer();
    VisibilityGpuTest::TearDown();
  }
  GpgpVisibilityInfo good() {
    GpgpVisibilityInfo info = sampleInfo(scene, *buffers, set);
    info.visibleBits = bits.range();
    info.visibleList = list.range();
    info.visibleCount = count.range();
    return info;
  }
  /// One failing call: its code, and a message that holds `text` (empty: no message).
  void expect(GpgpResult expected, GpgpResult got, const std::string& text) {
    EXPECT_EQ(got, expected) << text;
    if (text.empty()) {
      EXPECT_TRUE(messages.empty());
    } else {
      ASSERT_EQ(messages.size(), 1u) << text;
      EXPECT_NE(messages[0].find(text), std::string::npos) << messages[0];
    }
    messages.clear();
  }
  void expectRecord(GpgpResult expected, const GpgpVisibilityInfo& info, const std::string& text) {
    device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
      expect(expected, gpgpRecordPrepareVisibility(recorder, cmd, &f, &info), text);
    });
  }
};

TEST_F(ArgumentsTest, ExactSamplingHasSoManyRowsOfAllCameras) {
  recorder = createRecorder(1, 8192, 64, false, GPGP_SAMPLING_STANDARD_BIT | GPGP_SAMPLING_EXACT_BIT, 1, 0, 0, 29);
  upload();
  f = advance();
  GpgpVisibilityInfo info = good();
  const std::vector<GpgpCamera> more(28, info.camera);
  info.moreCameras = more.data();
  info.moreCameraCount = 28;
  info.width = 1, info.height = 8192;
  info.method = GPGP_SAMPLING_STANDARD;
  expectRecord(GPGP_SUCCESS, info, "");
  info.method = GPGP_SAMPLING_EXACT;
  expectRecord(GPGP_ERROR_INVALID_ARGUMENT, info, "height is 8192 for 29 cameras");
  info.moreCameraCount = 27;
  expectRecord(GPGP_SUCCESS, info, "");
}

TEST_F(ArgumentsTest, RecordsAreChecked) {
  expectRecord(GPGP_SUCCESS, good(), "");
  const auto bad = [&](GpgpResult code, const char* text, auto change) {
    GpgpVisibilityInfo info = good();
    change(info);
    expectRecord(code, info, text);
  };
  const GpgpResult argument = GPGP_ERROR_INVALID_ARGUMENT;
  bad(GPGP_ERROR_INVALID_STRUCT, "sType", [](auto& i) { i.sType = 7; });
  bad(GPGP_ERROR_INVALID_STRUCT, "pNext", [](auto& i) { i.pNext = &i; });
  bad(GPGP_ERROR_INVALID_HANDLE, "geometrySet", [](auto& i) { i.geometrySet = nullptr; });
  bad(argument, "method", [](auto& i) { i.method = 4; });
  bad(argument, "viewProjection", [](auto& i) { i.camera.viewProjection[3] = NAN; });
  bad(argument, "origin of camera 0", [](auto& i) { i.camera.origin[2] = NAN; });
  bad(argument, "origin of camera 0", [](auto& i) { i.camera.origin[0] = -1e30; });
  bad(argument, "origins is NULL", [](auto& i) { i.originCount = 1; });
  const double places[33 * 3] = {0, 0, 0, 0, HUGE_VAL};
  bad(argument, "origins[1]", [&](auto& i) { i.origins = places, i.originCount = 2; });
  bad(argument, "originCount is 33; at most 32", [&](auto& i) { i.origins = places, i.originCount = 33; });
  bad(argument, "viewport", [](auto& i) { i.width = 0; });
  bad(argument, "viewport", [](auto& i) { i.height = 65; });
  bad(argument, "drawCount", [](auto& i) { i.drawCount = 65537; });
  bad(argument, "draws.size", [](auto& i) { i.drawCount = 2; });
  bad(argument, "draws", [](auto& i) { i.draws.buffer = VK_NULL_HANDLE; });
  bad(argument, "positions", [](auto& i) { i.positions.buffer = VK_NULL_HANDLE; });
  bad(argument, "indices", [](auto& i) { i.indices.buffer = VK_NULL_HANDLE; });
  bad(argument, "indices.size", [](auto& i) { i.indices.size = 118; });
  bad(argument, "indexType", [](auto& i) { i.indexType = VK_INDEX_TYPE_UINT8_EXT; });
  bad(argument, "positionStride", [](auto& i) { i.positionStride = 8; });
  bad(argument, "positionStride", [](auto& i) { i.positionStride = 14; });
  bad(argument, "triangleCount", [](auto& i) { i.triangleCount = 0x80000001u; });
  bad(argument, "visibleBits.size", [](auto& i) { i.triangleCount = 16 * 32 + 1; });
  bad(argument, "visibleBits", [](auto& i) { i.visibleBits.buffer = VK_NULL_HANDLE; });
  bad(argument, "visibleList", [](auto& i) { i.visibleList.size = 0; });
  bad(argument, "visibleCount.size", [](auto& i) { i.visibleCount.size = 12; });
  bad(argument, "visibleBits.offset", [](auto& i) { i.visibleBits.offset = 4; });
  const GpgpFrame unknown{f.current + 5, f.safe};
  device.submitAndWait(queue(), [&](VkCommandBuffer cmd) {
    const GpgpVisibilityInfo info = good();
    EXPECT_LT(gpgpRecordPrepareVisibility(recorder, cmd, &unknown, &info), 0);
    EXPECT_LT(gpgpRecordPrepareVisibility(recorder, cmd, nullptr, &info), 0);
    EXPECT_EQ(gpgpRecordPrepareVisibility(nullptr, cmd, &f, &info), GPGP_ERROR_INVALID_HANDLE);
    EXPECT_EQ(gpgpRecordPrepareVisibility(recorder, cmd, &f, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(gpgpRecordPrepareVisibility(recorder, nullptr, &f, &info), GPGP_ERROR_INVALID_ARGUMENT);
  });
  // Only the good record left a report.
  advance();
  GpgpVisibilityReport report = GPGP_VISIBILITY_REPORT_INIT;
  EXPECT_EQ(gpgpGetVisibilityReport(recorder, &report), GPGP_SUCCESS);
  EXPECT_EQ(gpgpGetVisibilityReport(recorder, &report), GPGP_NOT_READY);
  report.sType = 0;
  EXPECT_EQ(gpgpGetVisibilityReport(recorder, &report), GPGP_ERROR_INVALID_STRUCT);
  EXPECT_EQ(gpgpGetVisibilityReport(recorder, nullptr), GPGP_ERROR_INVALID_ARGUMENT);
}

TEST_F(ArgumentsTest, HandlesOfOtherKindsAndDestroyedOnesAreRefused) {
  GpgpVisibilityInfo info = good();
  info.geometrySet = reinterpret_cast<GpgpAsset>(recorder);
  expectRecord(GPGP_ERROR_INVALID_HANDLE, info, "geometrySet is a visibility recorder");
  info = good();
  info.history = reinterpret_cast<GpgpHistory>(set);
  expectRecord(GPGP_ERROR_INVALID_HANDLE, info, "history");
  gpgpDestroyAsset(set);
  expectRecord(GPGP_ERROR_INVALID_HANDLE, good(), "geometrySet is destroyed");
}

TEST_F(ArgumentsTest, NotReadyUntilResidentAndPrewarmed) {
  GpgpVisibilityInfo info = good();
  info.history = createView(0);
  expectRecord(GPGP_NOT_READY, info, "history is not resident"); // each reason is said once
  expectRecord(GPGP_NOT_READY, info, "");
  info = good();
  info.geometrySet = createGeometrySet(scene);
  expectRecord(GPGP_NOT_READY, info, "geometrySet is not resident");
  GpgpVisibilityRecorderCreateInfo create = GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT;
  create.base.queueFamily = queue().family;
  create.maxWidth = create.maxHeight = 64;
  ASSERT_EQ(gpgpCreateVisibilityRecorder(context, &create, &recorder), GPGP_SUCCESS);
  expectRecord(GPGP_NOT_READY, good(), "gpgpPrewarm");
  ASSERT_EQ(gpgpPrewarm(recorder, nullptr), GPGP_SUCCESS);
  expectRecord(GPGP_SUCCESS, good(), "");
}

TEST_F(ArgumentsTest, AViewTooSmallIsRefused) {
  GpgpVisibilityInfo info = good();
  info.history = createView(9);
  upload();
  f = advance();
  expectRecord(GPGP_ERROR_INVALID_ARGUMENT, info, "the history was made for 9");
}

TEST_F(ArgumentsTest, CreationIsChecked) {
  GpgpGeometrySetCreateInfo setInfo = GPGP_GEOMETRY_SET_CREATE_INFO_INIT;
  GpgpMesh mesh{0, 4, 0};
  setInfo.meshCount = 1;
  GpgpAsset asset = nullptr;
  expect(GPGP_ERROR_INVALID_ARGUMENT, gpgpCreateGeometrySet(context, &setInfo, &asset), "meshes is NULL");
  setInfo.meshes = &mesh;
  expect(GPGP_ERROR_INVALID_ARGUMENT, gpgpCreateGeometrySet(context, &setInfo, &asset), "multiple of 3");
  mesh = {0xfffffff0u, 30, 0};
  expect(GPGP_ERROR_INVALID_ARGUMENT, gpgpCreateGeometrySet(context, &setInfo, &asset), "32 bits");
  expect(GPGP_ERROR_INVALID_ARGUMENT, gpgpCreateGeometrySet(context, &setInfo, nullptr), "geometrySet is NULL");
  expect(GPGP_ERROR_INVALID_ARGUMENT, gpgpCreateGeometrySet(context, nullptr, &asset), "info is NULL");
  setInfo.sType = 0;
  expect(GPGP_ERROR_INVALID_STRUCT, gpgpCreateGeometrySet(context, &setInfo, &asset), "sType");
  EXPECT_EQ(asset, nullptr);

  GpgpVisibilityRecorderCreateInfo recorderInfo = GPGP_VISIBILITY_RECORDER_CREATE_INFO_INIT;
  recorderInfo.base.queueFamily = queue().family;
  GpgpRecorder made = nullptr;
  recorderInfo.maxWidth = 8193;
  expect(GPGP_ERROR_INVALID_ARGUMENT, gpgpCreateVisibilityRecorder(context, &recorderInfo, &made), "maxWidth");
  recorderInfo.maxWidth = 64;
  recorderInfo.maxTriangles = (1u << 30) + 1;
  expect(GPGP_ERROR_INVALID_ARGUMENT, gpgpCreateVisibilityRecorder(context, &recorderInfo, &made), "maxTriangles");
  recorderInfo.maxTriangles = 64;
  recorderInfo.base.queueFamily = 99;
  expect(GPGP_ERROR_INVALID_ARGUMENT, gpgpCreateVisibilityRecorder(context, &recorderInfo, &made), "queueFamily");
  expect(GPGP_ERROR_INVALID_ARGUMENT, gpgpCreateVisibilityRecorder(context, &recorderInfo, nullptr),
         "recorder is NULL");
  expect(GPGP_ERROR_INVALID_ARGUMENT, gpgpCreateVisibilityRecorder(context, nullptr, &made), "info is NULL");
  EXPECT_EQ(made, nullptr);

  GpgpCameraHistoryCreateInfo viewInfo = GPGP_CAMERA_HISTORY_CREATE_INFO_INIT;
  GpgpHistory view = nullptr;
  viewInfo.maxTriangles = 0x80000001u;
  expect(GPGP_ERROR_INVALID_ARGUMENT, gpgpCreateCameraHistory(context, &viewInfo, &view), "maxTriangles");
  viewInfo.maxTriangles = 64;
  for (const float late : {-0.001f, 0.00001f, 0.06f, std::nanf("")}) {
    viewInfo.maxLate = late;
    expect(GPGP_ERROR_INVALID_ARGUMENT, gpgpCreateCameraHistory(context, &viewInfo, &view), "maxLate");
  }
  viewInfo.maxLate = 0;
  expect(GPGP_ERROR_INVALID_ARGUMENT, gpgpCreateCameraHistory(context, &viewInfo, nullptr), "history is NULL");
  viewInfo.sType = 1;
  expect(GPGP_ERROR_INVALID_STRUCT, gpgpCreateCameraHistory(context, &viewInfo, &view), "sType");
  EXPECT_EQ(view, nullptr);
}

TEST_F(ArgumentsTest, PassesAreThoseOfTheDocumentation) {
  uint32_t passes = 0;
  ASSERT_EQ(gpgpGetPasses(recorder, &passes, nullptr), GPGP_SUCCESS);
  std::vector<const char*> names(passes);
  ASSERT_EQ(gpgpGetPasses(recorder, &passes, names.data()), GPGP_SUCCESS);
  ASSERT_EQ(passes, contextFeatures & GPGP_FEATURE_BUFFER_INT64_ATOMICS ? 20u : 24u); // ids with depths, or after them
  std::ifstream file(GPGP_TEST_DATA "/../../docs/internals/visibility.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  size_t at = 0;
  for (const char* name : names) { // the page's pass table lists them in order
    const size_t found = page.find('`' + std::string(name) + '`', at);
    EXPECT_NE(found, std::string::npos) << name;
    at = found == std::string::npos ? at : found;
  }
}

} // namespace
} // namespace gpgp::test
