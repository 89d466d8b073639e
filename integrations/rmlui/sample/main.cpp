// A document of RmlUi, drawn by gpgp without a window: into a PNG, or just to see that it is well.
#include "gpgp_device.hpp"
#include "pictures.h"

#include <RmlUi/Core.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace {

using namespace gpgp;
namespace device = gpgp::integration;

constexpr const char* kHelp = R"(gpgp_rmlui_sample DOCUMENT: a document of RmlUi, drawn by gpgp

  --font FILE      a font of the document; may be given several times. The last one is what others fall back to
  --root FOLDER    where files whose path begins with / lie
  --picture FILE   the last frame as PNG, over --background
  --background RGB six hexadecimal digits (default 000000)
  --frames N       frames that are drawn, a sixtieth of a second each (default 4)
  --size WxH       of the context (default 1024x768)
  --ratio R        pixels per dp (default 1)
  --click X,Y      a click after the second frame; may be given several times
  --device NAME    GPU: part of its name, or an index (default: $GPGP_DEVICE, else the software device)
  --validate       under the Khronos validation layer; any message of it is an error

Exit code 0: all is well; 1: an error, a validation message, an exceeded budget, or something that gpgp does not draw;
2: wrong usage.
)";

struct Options {
  std::string document, root, picture, deviceName;
  std::vector<std::string> fonts;
  std::vector<std::array<int, 2>> clicks;
  uint32_t frames = 4, width = 1024, height = 768, background = 0;
  float ratio = 1;
  bool validate = false;
};

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--validate") {
      options.validate = true;
      continue;
    }
    if (name.rfind("--", 0) != 0) {
      if (!options.document.empty()) return false;
      options.document = name;
      continue;
    }
    if (++i == argc) return false;
    const char* value = argv[i];
    int x = 0, y = 0;
    char rest = 0;
    if (name == "--font")
      options.fonts.emplace_back(value);
    else if (name == "--root")
      options.root = value;
    else if (name == "--picture")
      options.picture = value;
    else if (name == "--device")
      options.deviceName = value;
    else if (name == "--click" && std::sscanf(value, "%d,%d%c", &x, &y, &rest) == 2)
      options.clicks.push_back({x, y});
    else if (!(name == "--background" && std::sscanf(value, "%x%c", &options.background, &rest) == 1) &&
             !(name == "--frames" && std::sscanf(value, "%u%c", &options.frames, &rest) == 1 && options.frames > 0) &&
             !(name == "--ratio" && std::sscanf(value, "%f%c", &options.ratio, &rest) == 1 && options.ratio > 0) &&
             !(name == "--size" && std::sscanf(value, "%ux%u%c", &options.width, &options.height, &rest) == 2 &&
               options.width > 0 && options.height > 0))
      return false;
  }
  return !options.document.empty();
}

/// Files, or else files below a folder.
class Files final : public Rml::FileInterface {
public:
  explicit Files(std::string root) : root_(std::move(root)) {}
  Rml::FileHandle Open(const Rml::String& path) override {
    FILE* file = std::fopen(path.c_str(), "rb");
    if (!file && !root_.empty()) file = std::fopen((root_ + "/" + path).c_str(), "rb"); // RmlUi has removed the first /
    return reinterpret_cast<Rml::FileHandle>(file);
  }
  void Close(Rml::FileHandle file) override { std::fclose(reinterpret_cast<FILE*>(file)); }
  size_t Read(void* buffer, size_t size, Rml::FileHandle file) override {
    return std::fread(buffer, 1, size, reinterpret_cast<FILE*>(file));
  }
  bool Seek(Rml::FileHandle file, long offset, int origin) override {
    return std::fseek(reinterpret_cast<FILE*>(file), offset, origin) == 0;
  }
  size_t Tell(Rml::FileHandle file) override { return static_cast<size_t>(std::ftell(reinterpret_cast<FILE*>(file))); }

private:
  std::string root_;
};

/// Time passes frame by frame: pictures are the same every time.
struct System final : Rml::SystemInterface {
  double now = 0;
  double GetElapsedTime() override { return now; }
  bool LogMessage(Rml::Log::Type type, const Rml::String& message) override {
    if (type <= Rml::Log::LT_WARNING) std::fprintf(stderr, "%s\n", message.c_str());
    return true;
  }
};

/// What a canvas is drawn on, and memory that its pixels are copied to.
class Paper {
public:
  Paper(device::Device& device, uint32_t width, uint32_t height) : device_(device), width_(width), height_(height) {
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = VK_FORMAT_R8G8B8A8_UNORM;
    info.extent = {width, height, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    device::check(vkCreateImage(device.device, &info, nullptr, &image_), "vkCreateImage");
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device.device, image_, &needs);
    imageMemory_ = allocate(needs, 0);
    device::check(vkBindImageMemory(device.device, image_, imageMemory_, 0), "vkBindImageMemory");
    VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    viewInfo.image = image_;
    viewInfo.viewType = VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = info.format;
    viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    device::check(vkCreateImageView(device.device, &viewInfo, nullptr, &view_), "vkCreateImageView");
    VkBufferCreateInfo bufferInfo{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    bufferInfo.size = VkDeviceSize{width} * height * 4;
    bufferInfo.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    device::check(vkCreateBuffer(device.device, &bufferInfo, nullptr, &buffer_), "vkCreateBuffer");
    vkGetBufferMemoryRequirements(device.device, buffer_, &needs);
    bufferMemory_ = allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    device::check(vkBindBufferMemory(device.device, buffer_, bufferMemory_, 0), "vkBindBufferMemory");
    device::check(vkMapMemory(device.device, bufferMemory_, 0, VK_WHOLE_SIZE, 0, &mapped_), "vkMapMemory");
  }
  ~Paper() {
    vkDeviceWaitIdle(device_.device);
    vkDestroyBuffer(device_.device, buffer_, nullptr);
    vkDestroyImageView(device_.device, view_, nullptr);
    vkDestroyImage(device_.device, image_, nullptr);
    vkFreeMemory(device_.device, bufferMemory_, nullptr);
    vkFreeMemory(device_.device, imageMemory_, nullptr);
  }
  Paper(const Paper&) = delete;
  Paper& operator=(const Paper&) = delete;

  GpgpImage image() const {
    return {image_,
            view_,
            VK_FORMAT_R8G8B8A8_UNORM,
            0,
            0,
            width_,
            height_,
            {VK_PIPELINE_STAGE_2_COPY_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED},
            {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}};
  }
  void recordCopy(VkCommandBuffer commands) const {
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {width_, height_, 1};
    vkCmdCopyImageToBuffer(commands, image_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer_, 1, &copy);
    VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0,
                         nullptr, 0, nullptr);
  }
  /// After the copy has finished: over a colour.
  std::vector<uint8_t> over(uint32_t rgb) const {
    const auto* from = static_cast<const uint8_t*>(mapped_);
    std::vector<uint8_t> pixels(from, from + size_t{width_} * height_ * 4);
    for (size_t i = 0; i < pixels.size(); i += 4)
      for (size_t c = 0; c < 3; ++c) {
        const uint32_t below = rgb >> (16 - 8 * c) & 255u;
        pixels[i + c] = static_cast<uint8_t>(std::min(255u, pixels[i + c] + below * (255u - pixels[i + 3]) / 255u));
      }
    return pixels;
  }

private:
  VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags) const {
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.allocationSize = needs.size;
    info.memoryTypeIndex = device_.memoryType(needs.memoryTypeBits, flags);
    VkDeviceMemory made = VK_NULL_HANDLE;
    device::check(vkAllocateMemory(device_.device, &info, nullptr, &made), "vkAllocateMemory");
    return made;
  }
  device::Device& device_;
  const uint32_t width_, height_;
  VkImage image_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory imageMemory_ = VK_NULL_HANDLE, bufferMemory_ = VK_NULL_HANDLE;
  void* mapped_ = nullptr;
};

void GPGP_CALL onMessage(void*, const GpgpMessage* message) {
  std::fprintf(stderr, "%s: %s: %s\n", message->function, message->label, message->text);
}

void need(GpgpResult result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + ": " + gpgpResultString(result));
}

/// Nothing where it is no SVG.
Drawing loadDrawing(GpgpContext context, const std::string& file) {
  Rml::String bytes;
  if (std::filesystem::path(file).extension() != ".svg" || !Rml::GetFileInterface()->LoadFile(file, bytes)) return {};
  auto source = init<GpgpSvgSource>();
  source.name = file.c_str();
  source.data = bytes.data();
  source.size = bytes.size();
  source.messageFn = onMessage;
  const Result<Blob> baked = compileSvg(source);
  if (!baked) return {};
  auto info = init<GpgpDrawingCreateInfo>();
  info.label = file.c_str();
  info.data = baked->data();
  info.size = baked->size();
  Result<Drawing> made = Drawing::create(context, info);
  return made ? *std::move(made) : Drawing{};
}

/// RmlUi, from here to there.
struct Toolkit {
  Toolkit(rmlui::FontEngine& fonts, rmlui::Renderer& renderer, System& system, Files& files) {
    Rml::SetSystemInterface(&system);
    Rml::SetFileInterface(&files);
    Rml::SetFontEngineInterface(&fonts);
    Rml::SetRenderInterface(&renderer);
    if (!Rml::Initialise()) throw std::runtime_error("Rml::Initialise failed");
    // Without RmlUi's own SVG plugin `svg` is any element: what is `img` for drawings will do.
    if (Rml::Factory::GetElementInstancer("svg") == Rml::Factory::GetElementInstancer("*"))
      Rml::Factory::RegisterElementInstancer("svg", Rml::Factory::GetElementInstancer("img"));
  }
  ~Toolkit() { Rml::Shutdown(); }
};

int run(const Options& options) {
  device::DeviceInfo deviceInfo;
  deviceInfo.device = options.deviceName;
  deviceInfo.validate = options.validate;
  device::Device device(deviceInfo);
  bool well = true;
  {
    device::Frames frames(device);
    GpgpContextCreateInfo contextInfo = device.contextCreateInfo();
    contextInfo.label = "sample";
    contextInfo.maxFramesInFlight = frames.inFlight();
    contextInfo.messageFn = onMessage;
    Result<Context> made = Context::create(contextInfo);
    need(made.code(), "gpgpCreateContext");
    const Context context = *std::move(made);

    rmlui::FontEngine fonts;
    rmlui::RendererInfo info;
    info.context = context;
    info.physicalDevice = device.physical;
    info.device = device.device;
    info.queueFamily = device.family;
    info.fonts = &fonts;
    info.maxWidth = options.width;
    info.maxHeight = options.height;
    info.loadImage = [](const std::string& source, rmlui::DecodedImage& image) {
      Rml::String bytes;
      return Rml::GetFileInterface()->LoadFile(source, bytes) && sample::decode(bytes, image);
    };
    info.loadDrawing = [&](const std::string& source) { return loadDrawing(context, source); };
    rmlui::Renderer renderer(info);
    Paper paper(device, options.width, options.height);
    System system;
    Files files(options.root);
    {
      Toolkit toolkit(fonts, renderer, system, files);
      for (size_t i = 0; i < options.fonts.size(); ++i)
        if (!Rml::LoadFontFace(options.fonts[i], i + 1 == options.fonts.size()))
          throw std::runtime_error("cannot read the font " + options.fonts[i]);
      Rml::Context* ui =
          Rml::CreateContext("main", {static_cast<int>(options.width), static_cast<int>(options.height)});
      if (!ui) throw std::runtime_error("Rml::CreateContext failed");
      ui->SetDensityIndependentPixelRatio(options.ratio);
      Rml::ElementDocument* document = ui->LoadDocument(options.document);
      if (!document) throw std::runtime_error("cannot read " + options.document);
      document->Show();
      for (uint32_t done = 0; done < options.frames; ++done) {
        VkCommandBuffer commands = frames.begin();
        need(gpgpAdvance(context, &frames.number()), "gpgpAdvance");
        system.now = done / 60.0;
        if (done == 2)
          for (const std::array<int, 2>& at : options.clicks) {
            ui->ProcessMouseMove(at[0], at[1], 0);
            ui->ProcessMouseButtonDown(0, 0);
            ui->ProcessMouseButtonUp(0, 0);
          }
        ui->Update();
        renderer.beginFrame(options.width, options.height);
        ui->Render();
        const GpgpImage image = paper.image();
        const GpgpResult prepared = renderer.prepare(commands, frames.number(), &image);
        need(prepared, "gpgp::rmlui");
        if (prepared == GPGP_SUCCESS) paper.recordCopy(commands);
        frames.submit();
        well = well && prepared == GPGP_SUCCESS && renderer.report().dropped == 0;
      }
      frames.finish();
      need(gpgpAdvance(context, &frames.number()), "gpgpAdvance");
      GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
      for (GpgpCanvasReport next = report; gpgpGetCanvasReport(renderer.canvas(), &next) == GPGP_SUCCESS;) {
        report = next;
        if (report.base.status != GPGP_SUCCESS) well = false;
      }
      std::printf(
          "canvas      %u paths of %u, %u glyphs of %u, %u shapes of %u, %u items of %u, %u layer pixels of %u, "
          "%u images: %s\n",
          report.paths, report.pathsGiven, report.glyphs, report.glyphsGiven, report.shapes, report.shapesGiven,
          report.items, report.itemsGiven, report.layerPixels, report.layerPixelsGiven, renderer.report().images,
          gpgpResultString(report.base.status));
      for (const std::string& what : renderer.unsupported()) std::printf("not drawn   %s\n", what.c_str());
      well = well && renderer.unsupported().empty();
    }
    if (!options.picture.empty() &&
        !sample::writePng(options.picture, options.width, options.height, paper.over(options.background).data()))
      throw std::runtime_error("cannot write " + options.picture);
  }
  std::printf("device      %s\n", device.properties.deviceName);
  if (options.validate) std::printf("validation  %u messages\n", device.validationMessages());
  return well && device.validationMessages() == 0 ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--help") == 0 || std::strcmp(argv[i], "-h") == 0) {
      std::fputs(kHelp, stdout);
      return 0;
    }
  if (!parse(argc, argv, options)) {
    std::fprintf(stderr, "%s\ngpgp_rmlui_sample: wrong usage\n", kHelp);
    return 2;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gpgp_rmlui_sample: %s\n", error.what());
    return 1;
  }
}
