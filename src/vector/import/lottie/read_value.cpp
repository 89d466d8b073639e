#include "vector/import/lottie/read_value.h"

namespace gpgp::vector::lottie {

std::string placeOf(const Json& root, const Json* value) {
  // The file is searched only where there is a message. Its depth is bounded.
  struct Search {
    const Json* value;
    std::string path;
    bool in(const Json& node) {
      if (&node == value) return true;
      const size_t length = path.size();
      if (node.is_object()) {
        for (const Json::Member& member : node.members) {
          path += (path.empty() ? "" : ".") + member.key.substr(0, 40);
          if (in(member.value)) return true;
          path.resize(length);
        }
      } else if (node.is_array()) {
        for (size_t i = 0; i < node.size(); ++i) {
          if (!node[i].is_array() && !node[i].is_object() && &node[i] != value) continue;
          path += "[" + std::to_string(i) + "]";
          if (in(node[i])) return true;
          path.resize(length);
        }
      }
      return false;
    }
  };
  Search search{value, {}};
  return search.in(root) ? search.path : std::string();
}

void Reader::unsupported(const Json& where, const std::string& text) {
  if (named_.size() < 1000 && named_.insert(text).second)
    reporter_.say(GPGP_SEVERITY_WARNING, GPGP_ERROR_UNSUPPORTED, placeOf(root_, &where), text);
}

void Reader::ignored(const Json& where, const std::string& text) {
  if (named_.size() < 1000 && named_.insert(text).second)
    reporter_.say(GPGP_SEVERITY_WARNING, GPGP_ERROR_INVALID_DATA, placeOf(root_, &where), text);
}

std::vector<double> Reader::numbers(const Json& value, bool& closed) {
  std::vector<double> result;
  if (value.is_number() || value.is_boolean()) return {toNumber(value)};
  if (value.is_array()) {
    if (!value.empty() && value[0].is_object()) return numbers(value[0], closed); // a path in a list of one
    result.reserve(value.size());
    for (const Json& part : value) result.push_back(toNumber(part));
    return result;
  }
  if (!value.is_object()) return result;
  const Json &vertices = listOf(value, "v"), &in = listOf(value, "i"), &out = listOf(value, "o");
  if (vertices.size() > limits_.vertices)
    throw Refusal{&value, "a path has more than " + std::to_string(limits_.vertices) + " vertices"};
  closed = numberOf(value, "c") != 0;
  for (size_t i = 0; i < vertices.size(); ++i)
    for (const Json* list : {&vertices, &in, &out})
      for (size_t k = 0; k < 2; ++k) {
        const bool there = i < list->size() && (*list)[i].is_array() && k < (*list)[i].size();
        result.push_back(there ? toNumber((*list)[i][k]) : 0);
      }
  return result;
}

Keyframe Reader::keyframe(const Json& value, bool& closed) {
  if (++keyframes_ > limits_.keyframes)
    throw Refusal{&value, "the file has more than " + std::to_string(limits_.keyframes) + " keyframes"};
  Keyframe key;
  key.time = numberOf(value, "t");
  if (const Json* s = find(value, "s")) key.start = numbers(*s, closed);
  if (const Json* e = find(value, "e")) key.end = numbers(*e, closed);
  key.hold = numberOf(value, "h") != 0;
  const Json *in = find(value, "i"), *out = find(value, "o");
  if (in && out) {
    const auto along = [](const Json& of, const char* axis, size_t i, double otherwise) {
      const Json* list = find(of, axis);
      if (!list) return otherwise;
      if (!list->is_array()) return toNumber(*list, otherwise);
      return list->empty() ? otherwise : toNumber((*list)[std::min(i, list->size() - 1)], otherwise);
    };
    const Json* x = find(*in, "x");
    const size_t count = x && x->is_array() ? std::clamp<size_t>(x->size(), 1, 16) : 1;
    for (size_t i = 0; i < count; ++i) {
      const Easing easing{std::clamp(along(*out, "x", i, 0), 0.0, 1.0), along(*out, "y", i, 0),
                          std::clamp(along(*in, "x", i, 1), 0.0, 1.0), along(*in, "y", i, 1)};
      key.easing.push_back(easing);
    }
  }
  const Json &to = listOf(value, "to"), &ti = listOf(value, "ti");
  if (to.size() >= 2 && ti.size() >= 2) {
    key.by = {Point{toNumber(to[0]), toNumber(to[1])}, Point{toNumber(ti[0]), toNumber(ti[1])}};
    key.curved = key.by[0] != Point{} || key.by[1] != Point{};
  }
  return key;
}

Property Reader::propertyOf(const Json& value, std::vector<double> otherwise) {
  Property result;
  result.value = std::move(otherwise);
  if (value.is_number() || value.is_array()) { // a bare value
    result.value = numbers(value, result.closed);
    return result;
  }
  if (!value.is_object()) return result;
  if (const Json* x = find(value, "x"); x && x->is_string())
    unsupported(value, "expressions are not supported: the values that the file has without them are shown");
  if (find(value, "sid")) unsupported(value, "slots are not supported: the values that the file has are shown");
  const Json* k = find(value, "k");
  if (!k) return result;
  const bool animated = k->is_array() && !k->empty() && (*k)[0].is_object() && find((*k)[0], "t");
  if (!animated) {
    std::vector<double> read = numbers(*k, result.closed);
    if (!read.empty()) result.value = std::move(read);
    return result;
  }
  result.keys.reserve(k->size());
  for (const Json& key : *k)
    if (key.is_object()) result.keys.push_back(keyframe(key, result.closed));
  const auto before = [](const Keyframe& a, const Keyframe& b) { return a.time < b.time; };
  if (!std::is_sorted(result.keys.begin(), result.keys.end(), before)) {
    ignored(*k, "keyframes are not in the order of their times: they are sorted");
    std::stable_sort(result.keys.begin(), result.keys.end(), before);
  }
  if (result.keys[0].start.empty()) result.keys[0].start = result.value;
  return result;
}

Property Reader::property(const Json& object, const char* key, std::vector<double> otherwise) {
  const Json* value = find(object, key);
  if (value) return propertyOf(*value, std::move(otherwise));
  Property result;
  result.value = std::move(otherwise);
  return result;
}

Transform Reader::transform(const Json& value) {
  Transform t;
  t.anchor = property(value, "a", {0, 0});
  t.scale = property(value, "s", {100, 100});
  t.opacity = property(value, "o", {100});
  t.skew = property(value, "sk", {0});
  t.skewAxis = property(value, "sa", {0});
  t.startOpacity = property(value, "so", {100});
  t.endOpacity = property(value, "eo", {100});
  t.rotation = find(value, "r") ? property(value, "r", {0}) : property(value, "rz", {0});
  for (const char* turn : {"rx", "ry", "or"})
    if (const Json* p = find(value, turn))
      if (const Property angle = propertyOf(*p, {0}); angle.animated() || angle.number(0) != 0)
        unsupported(*p, "rotation in three dimensions is not supported: it is left out");
  if (const Json* p = find(value, "p"); p && numberOf(*p, "s") != 0) {
    t.split = true;
    t.x = property(*p, "x", {0});
    t.y = property(*p, "y", {0});
  } else {
    t.position = property(value, "p", {0, 0});
  }
  return t;
}

void Reader::unitColor(Property& color) {
  bool bytes = false;
  const auto look = [&](const std::vector<double>& v) {
    for (size_t i = 0; i < std::min<size_t>(v.size(), 3); ++i) bytes |= v[i] > 1.5;
  };
  const auto divide = [](std::vector<double>& v) {
    for (double& c : v) c /= 255;
  };
  look(color.value);
  for (const Keyframe& key : color.keys) look(key.start), look(key.end);
  if (!bytes) return;
  divide(color.value);
  for (Keyframe& key : color.keys) divide(key.start), divide(key.end);
}

bool Reader::hexColor(const std::string& text, double (&color)[3]) {
  if (text.size() != 7 || text[0] != '#') return false;
  for (size_t i = 0; i < 3; ++i) {
    int value = 0;
    for (size_t k = 0; k < 2; ++k) {
      const char c = text[1 + 2 * i + k];
      const int digit = c >= '0' && c <= '9'   ? c - '0'
                        : c >= 'a' && c <= 'f' ? c - 'a' + 10
                        : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                               : -1;
      if (digit < 0) return false;
      value = value * 16 + digit;
    }
    color[i] = value / 255.0;
  }
  return true;
}

std::vector<Mask> Reader::masks(const Json& list) {
  std::vector<Mask> result;
  for (const Json& value : list) {
    if (result.size() >= 64) {
      ignored(value, "a layer has more than 64 masks: the rest are left out");
      break;
    }
    Mask mask;
    const std::string mode = stringOf(value, "mode");
    mask.mode = mode.empty() ? 'a' : mode[0];
    if (mask.mode == 'n') continue;
    if (mask.mode == 'l') mask.mode = 'a', unsupported(value, "the mask mode 'lighten' is not supported: it adds");
    if (mask.mode == 'd') mask.mode = 'i', unsupported(value, "the mask mode 'darken' is not supported: it intersects");
    if (mask.mode != 'a' && mask.mode != 's' && mask.mode != 'i') {
      unsupported(value, "the mask mode '" + mode.substr(0, 20) + "' is not supported: the mask is left out");
      continue;
    }
    mask.inverted = numberOf(value, "inv") != 0;
    mask.path = property(value, "pt");
    mask.opacity = property(value, "o", {100});
    mask.feather = property(value, "f", {0, 0});
    mask.expansion = property(value, "x", {0});
    result.push_back(std::move(mask));
  }
  return result;
}

std::vector<Effect> Reader::effects(const Json& list) {
  std::vector<Effect> result;
  for (const Json& value : list) {
    if (find(value, "en") && numberOf(value, "en") == 0) continue;
    const Json& parts = listOf(value, "ef");
    const auto part = [&](size_t i, std::vector<double> otherwise) {
      return i < parts.size() ? property(parts[i], "v", std::move(otherwise)) : Property{{otherwise}, {}, false};
    };
    Effect effect;
    switch (intOf(value, "ty")) {
    case 20:
      effect.kind = EffectKind::Tint;
      effect.colors[0] = part(0, {0, 0, 0}), effect.colors[1] = part(1, {1, 1, 1});
      effect.numbers[0] = part(2, {100});
      break;
    case 21:
      effect.kind = EffectKind::Fill;
      effect.colors[0] = part(2, {1, 0, 0});
      effect.numbers[0] = part(6, {1});
      break;
    case 25:
      effect.kind = EffectKind::DropShadow;
      effect.colors[0] = part(0, {0, 0, 0});
      effect.numbers[0] = part(1, {127.5}), effect.numbers[1] = part(2, {135});
      effect.numbers[2] = part(3, {5}), effect.numbers[3] = part(4, {0});
      break;
    case 29:
      effect.kind = EffectKind::Blur;
      effect.numbers[0] = part(0, {0}), effect.numbers[1] = part(1, {1});
      if (part(2, {0}).number(0) != 0) unsupported(value, "a blur that repeats the edge's pixels is not supported");
      break;
    case 5: continue; // values for expressions
    default: {
      const std::string name = stringOf(value, "nm");
      unsupported(value, "effect " + std::to_string(intOf(value, "ty")) +
                             (name.empty() ? "" : " ('" + name.substr(0, 40) + "')") + " is not supported");
      continue;
    }
    }
    for (Property& color : effect.colors) unitColor(color);
    if (result.size() < 64) result.push_back(std::move(effect));
  }
  return result;
}

std::vector<TextDocument> Reader::documents(const Json& text) {
  std::vector<TextDocument> result;
  if (!listOf(text, "a").empty()) unsupported(listOf(text, "a"), "text animators are not supported");
  if (const Json* path = find(text, "p"); path && find(*path, "m"))
    unsupported(*path, "text on a path is not supported: it is drawn along a line");
  for (const Json& key : listOf(orNothing(find(text, "d")), "k")) {
    const Json* s = find(key, "s");
    if (!s || !s->is_object() || result.size() >= 10'000) continue;
    TextDocument document;
    document.time = numberOf(key, "t");
    document.text = stringOf(*s, "t");
    document.font = stringOf(*s, "f");
    document.size = std::clamp(numberOf(*s, "s", 10), 0.0, 1e5);
    document.lineHeight = numberOf(*s, "lh", 1.2 * document.size);
    document.tracking = numberOf(*s, "tr");
    document.baselineShift = numberOf(*s, "ls");
    document.justify = intOf(*s, "j");
    if (document.justify > 2)
      unsupported(*s, "justified text is not supported: its lines begin at one side"), document.justify = 0;
    document.strokeWidth = numberOf(*s, "sw", 1);
    document.strokeOver = numberOf(*s, "of") != 0;
    const auto color = [&](const char* name, double(&to)[3]) {
      Property read = property(*s, name);
      unitColor(read);
      for (size_t i = 0; i < 3 && i < read.value.size(); ++i) to[i] = read.value[i];
      return read.value.size() >= 3;
    };
    document.hasFill = color("fc", document.fill);
    document.hasStroke = color("sc", document.stroke);
    const Json &place = listOf(*s, "ps"), &size = listOf(*s, "sz");
    if (size.size() >= 2)
      document.box = {place.size() > 0 ? toNumber(place[0]) : 0, place.size() > 1 ? toNumber(place[1]) : 0,
                      toNumber(size[0]), toNumber(size[1])};
    if (intOf(*s, "ca") != 0) unsupported(*s, "text in capitals or small capitals is drawn as it is written");
    if (document.text.size() > 10'000) throw Refusal{s, "a text has more than 10 000 bytes"};
    result.push_back(std::move(document));
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const TextDocument& a, const TextDocument& b) { return a.time < b.time; });
  return result;
}

} // namespace gpgp::vector::lottie
