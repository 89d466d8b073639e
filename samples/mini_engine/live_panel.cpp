#include "live_panel.h"

#include <gpgp_imgui.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace mini {
namespace {

bool encodes(VkFormat format) { return format == VK_FORMAT_R8G8B8A8_SRGB || format == VK_FORMAT_B8G8R8A8_SRGB; }

} // namespace

struct LivePanel::Impl {
  struct Ui {
    ImGuiContext* context = ImGui::CreateContext();
    ~Ui() { ImGui::DestroyContext(context); }
  } ui;
  Gpgp& gpgp;
  std::unique_ptr<gpgp::imgui::Renderer> renderer;
  float errorBox[4] = {};
  ImVec4 red{1, 0.25f, 0.2f, 1};
  bool well = true, released = false;

  explicit Impl(Gpgp& g) : gpgp(g) {}
  void showErrors(const LiveFile& file, const ImVec2& size);
};

LivePanel::LivePanel(Device& device, Gpgp& gpgp, const Forward& forward, VkFormat format, const std::string& dataFolder)
    : impl_(std::make_unique<Impl>(gpgp)) {
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  ImGui::StyleColorsDark();
  if (encodes(format)) { // they are taken as linear
    const auto decode = [](ImVec4& color) {
      color = {linearFromSrgb(color.x), linearFromSrgb(color.y), linearFromSrgb(color.z), color.w};
    };
    for (ImVec4& color : ImGui::GetStyle().Colors) decode(color);
    decode(impl_->red);
  }
  const std::string font = dataFolder + "/fetched/fonts/DejaVuSans.ttf";
  if (fileExists(font)) io.Fonts->AddFontFromFileTTF(font.c_str(), 15);
  auto target = gpgp::init<GpgpTargetInfo>();
  target.renderPass = forward.renderPass();
  target.samples = Forward::kSamples;
  gpgp::imgui::RendererInfo info;
  info.context = gpgp.context;
  info.physicalDevice = device.physical;
  info.device = device.device;
  info.queueFamily = device.family;
  info.target = &target;
  info.srgbTarget = encodes(format);
  info.maxWidth = kMaxExtent.width;
  info.maxHeight = kMaxExtent.height;
  info.maxTriangles = 8192;
  info.maxGlyphs = 4096;
  info.maxTextures = 2;
  impl_->renderer = std::make_unique<gpgp::imgui::Renderer>(info);
  if (fileExists(font)) impl_->renderer->useFonts(*io.Fonts);
  impl_->renderer->createFontTexture(*io.Fonts);
}

LivePanel::~LivePanel() = default;

void LivePanel::input(const Input& input) {
  ImGuiIO& io = ImGui::GetIO();
  if (input.kind == Input::move) io.MousePos = {input.x, input.y};
  if (input.kind == Input::click) io.MouseDown[0] = true;
  if (input.kind == Input::release) impl_->released = true; // after a frame has seen it down
}

namespace {

/// True: the person has changed it.
bool edit(LiveAttribute& attribute) {
  const char* const name = attribute.name.c_str();
  switch (attribute.kind) {
  case LiveAttribute::boolean: {
    bool on = attribute.value != 0;
    const bool changed = ImGui::Checkbox(name, &on);
    attribute.value = on ? 1.0f : 0.0f;
    return changed;
  }
  case LiveAttribute::choice: {
    bool changed = false;
    if (!ImGui::BeginCombo(name, attribute.choices[static_cast<size_t>(attribute.value)].c_str())) return false;
    for (size_t i = 0; i < attribute.choices.size(); ++i)
      if (ImGui::Selectable(attribute.choices[i].c_str(), static_cast<float>(i) == attribute.value)) {
        attribute.value = static_cast<float>(i);
        changed = true;
      }
    ImGui::EndCombo();
    return changed;
  }
  case LiveAttribute::colour: return ImGui::ColorEdit3(name, attribute.rgb.data(), ImGuiColorEditFlags_NoInputs);
  case LiveAttribute::number: break;
  }
  return ImGui::SliderFloat(name, &attribute.value, attribute.min, attribute.max,
                            attribute.step == std::floor(attribute.step) && attribute.step > 0 ? "%.0f" : "%.2f",
                            ImGuiSliderFlags_AlwaysClamp);
}

} // namespace

void LivePanel::update(LiveFile& file, const std::string& summary, VkExtent2D extent) {
  ImGuiIO& io = ImGui::GetIO();
  const ImVec2 size{static_cast<float>(extent.width), static_cast<float>(extent.height)};
  io.DisplaySize = size;
  io.DeltaTime = 1.0f / 60;
  ImGui::NewFrame();
  if (std::exchange(impl_->released, false)) io.MouseDown[0] = false;

  const float wide = std::min(size.x * 0.4f, 340.0f);
  ImGui::SetNextWindowPos({size.x - wide - 12, 12}, ImGuiCond_Always);
  ImGui::SetNextWindowSize({wide, 0}, ImGuiCond_Always);
  ImGui::Begin("Grammar", nullptr, ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize);
  ImGui::TextUnformatted(file.file().substr(file.file().find_last_of("/\\") + 1).c_str());
  ImGui::TextUnformatted(summary.c_str());
  float label = 0;
  for (const LiveAttribute& attribute : file.attributes())
    label = std::max(label, ImGui::CalcTextSize(attribute.name.c_str()).x);
  ImGui::PushItemWidth(std::max(wide - label - 32, 60.0f));
  std::string group;
  for (const LiveAttribute& attribute : file.attributes()) {
    if (attribute.group != group) {
      group = attribute.group;
      ImGui::Separator();
      ImGui::TextUnformatted(group.c_str());
    }
    LiveAttribute edited = attribute;
    if (edit(edited)) file.set(edited.name, edited.text());
    if (!attribute.description.empty() && ImGui::IsItemHovered())
      ImGui::SetTooltip("%s", attribute.description.c_str());
  }
  ImGui::PopItemWidth();
  ImGui::End();

  std::fill_n(impl_->errorBox, 4, 0.0f);
  if (!file.errors().empty()) impl_->showErrors(file, size);
  ImGui::Render();
}

void LivePanel::Impl::showErrors(const LiveFile& file, const ImVec2& size) {
  constexpr size_t kShown = 4;
  std::vector<std::pair<std::string, bool>> lines; // red?
  for (const LiveError& error : file.errors()) {
    if (lines.size() >= 2 * kShown) {
      lines.emplace_back("and more", false);
      break;
    }
    lines.emplace_back(error.place() + ": " + error.text, true);
    lines.emplace_back(error.line ? "    " + std::to_string(error.line) + " | " + error.source : " ", false);
  }
  // A size of its own: ImGui hides a window for a frame to find one.
  const ImGuiStyle& style = ImGui::GetStyle();
  const float wide = size.x - 24, wrapped = wide - 2 * style.WindowPadding.x;
  float high = 2 * style.WindowPadding.y;
  for (const auto& line : lines)
    high += ImGui::CalcTextSize(line.first.c_str(), nullptr, false, wrapped).y + style.ItemSpacing.y;
  high = std::min(std::ceil(high), size.y - 24);
  ImGui::SetNextWindowPos({12, size.y - 12 - high}, ImGuiCond_Always);
  ImGui::SetNextWindowSize({wide, high}, ImGuiCond_Always);
  ImGui::Begin("Error", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoFocusOnAppearing);
  for (const auto& line : lines) {
    ImGui::PushStyleColor(ImGuiCol_Text, line.second ? red : style.Colors[ImGuiCol_Text]);
    ImGui::TextWrapped("%s", line.first.c_str());
    ImGui::PopStyleColor();
  }
  ImGui::End();
  const float corners[4] = {11, size.y - 13 - high, 13 + wide, size.y - 11}; // with its smooth border
  std::copy_n(corners, 4, errorBox);
}

void LivePanel::prepare(VkCommandBuffer commands, const GpgpFrame& frame) {
  if (impl_->renderer->prepare(*ImGui::GetDrawData(), commands, frame) < 0)
    throw std::runtime_error("the panel: " + impl_->renderer->error());
  impl_->well = impl_->well && impl_->renderer->report().dropped == 0;
}

void LivePanel::draw(VkCommandBuffer commands, const GpgpFrame& frame) {
  impl_->gpgp.check(impl_->renderer->draw(commands, frame), "the panel");
}

void LivePanel::collect() {
  GpgpCanvasReport report = GPGP_CANVAS_REPORT_INIT;
  while (gpgpGetCanvasReport(impl_->renderer->canvas(), &report) == GPGP_SUCCESS)
    impl_->well = impl_->well && report.base.status == GPGP_SUCCESS;
}

bool LivePanel::well() const { return impl_->well; }
const float (&LivePanel::errorBox() const)[4] { return impl_->errorBox; }

} // namespace mini
