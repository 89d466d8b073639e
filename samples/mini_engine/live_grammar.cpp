#include "live_grammar.h"

#include <algorithm>
#include <chrono>
#include <regex>
#include <sstream>
#include <utility>

namespace mini {

std::vector<LiveAttribute> attributesOf(const std::string& text) {
  static const std::regex pattern(R"(^\s*var\s+(\w+)\s*=\s*([-+.0-9eE]+)\s*;(\s*//\s*([-+.0-9]+)\s+to\s+([-+.0-9]+))"
                                  R"((\s*,\s*([^\r]*))?)?.*$)");
  std::vector<LiveAttribute> attributes;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (line.size() > 1000 || !std::regex_match(line, match, pattern)) continue;
    const auto number = [&](size_t i) { return std::strtof(match[i].str().c_str(), nullptr); };
    LiveAttribute attribute;
    attribute.name = match[1];
    attribute.value = number(2);
    attribute.written = match[2];
    attribute.min = match[4].matched ? number(4) : std::min(2 * attribute.value, 0.0f);
    attribute.max = match[5].matched ? number(5) : std::max(2 * attribute.value, 0.0f);
    attribute.group = match[7];
    if (attribute.min < attribute.max) attributes.push_back(std::move(attribute));
  }
  return attributes;
}

LiveGrammar::LiveGrammar(GpgpContext context, std::string file) : LiveFile(std::move(file)), context_(context) {
  if (std::optional<std::string> text = readText(file_)) {
    good_ = tried_ = *std::move(text);
    attributes_ = attributesOf(good_);
  }
}

std::optional<gpgp::Grammar> LiveGrammar::update() {
  const std::optional<std::string> text = readText(file_);
  if (text && *text != tried_) {
    tried_ = *text;
    std::vector<LiveAttribute> attributes = attributesOf(tried_);
    keepValues(attributes);
    if (auto made = compile(tried_, attributes)) {
      good_ = tried_;
      attributes_ = std::move(attributes);
      errors_.clear();
      changed_ = false;
      ++version_;
      return made;
    }
  } else {
    showErrors();
  }
  if (!std::exchange(changed_, false)) return std::nullopt;
  std::vector<LiveError> ofFile = std::move(found_);
  auto made = compile(good_, attributes_);
  found_ = std::move(ofFile);
  if (made) ++version_;
  return made;
}

std::optional<gpgp::Grammar> LiveGrammar::compile(const std::string& text,
                                                  const std::vector<LiveAttribute>& attributes) {
  found_.clear();
  std::vector<GpgpVariable> variables;
  for (const LiveAttribute& attribute : attributes) variables.push_back({attribute.name.c_str(), attribute.value});
  auto source = gpgp::init<GpgpGrammarSource>();
  source.name = file_.c_str();
  source.text = text.data();
  source.size = text.size();
  source.variables = variables.data();
  source.variableCount = static_cast<uint32_t>(variables.size());
  source.messageUserData = &found_;
  source.messageFn = [](void* user, const GpgpCompileMessage* m) {
    if (m->severity == GPGP_SEVERITY_ERROR)
      static_cast<std::vector<LiveError>*>(user)->push_back({m->file, m->text, m->line, m->column, {}});
  };
  const auto start = std::chrono::steady_clock::now();
  const gpgp::Result<gpgp::Blob> blob = gpgp::compileGrammar(source);
  compileMilliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  for (LiveError& error : found_) error.source = lineOf(text, error.line);
  if (!blob) {
    if (found_.empty()) found_.push_back({file_, gpgpResultString(blob.code()), 0, 0, {}});
    return std::nullopt;
  }
  auto info = gpgp::init<GpgpGrammarCreateInfo>();
  info.label = "live grammar";
  info.data = blob->data();
  info.size = blob->size();
  gpgp::Result<gpgp::Grammar> made = gpgp::Grammar::create(context_, info);
  if (made) return *std::move(made);
  found_.push_back({file_, gpgpResultString(made.code()), 0, 0, {}});
  return std::nullopt;
}

} // namespace mini
