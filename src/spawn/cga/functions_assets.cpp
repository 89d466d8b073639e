// Functions that ask files of assets, pictures and materials.
#include "spawn/cga/deriver.h"
#include "spawn/cga/files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace gpgp::spawn::cga {

/// Extents of an asset, and where its lowest corner is, metres.
CgaValue Deriver::assetInfo_(const Arguments& a) {
  const std::string path = text(a[0]);
  const std::string_view which = word(a[1]);
  std::string why;
  const Form* asset = assetForm(path, why);
  if (!asset) {
    warn("asset " + path, "nothing is known of the asset \"" + path + "\": " + why);
    return floatValue(0);
  }
  const int axis = which.ends_with('y') ? 1 : which.ends_with('z') ? 2 : 0;
  return floatValue(which.starts_with('t') ? asset->scope.origin[axis] : asset->scope.size[axis]);
}

/// The names that an asset's file has: of groups (g) or materials (m), in the order of the file.
std::vector<std::string> Deriver::namesOfAsset(const Arguments& a) {
  const std::string path = text(a[0]);
  std::string why;
  if (!assetForm(path, why)) {
    warn("asset " + path, "nothing is known of the asset \"" + path + "\": " + why);
    return {};
  }
  const Asset& asset = *assets_.at(path);
  return word(a[1]) == "m" ? asset.materials : asset.groups;
}
CgaValue Deriver::assetNamingInfo_(const Arguments& a) { return listValue(namesOfAsset(a)); }
CgaValue Deriver::assetNamingInfos_(const Arguments& a) {
  ArrayValue result;
  for (const std::string& name : namesOfAsset(a)) result.values.push_back(stringValue(name));
  return array(std::move(result));
}
/// No format that is read here has any.
CgaValue Deriver::assetMetadata_(const Arguments& a) { return a[2]; }

/// A list of files: in an array, or in a string.
std::vector<std::string> Deriver::filesOf(const CgaValue& v) {
  if (v.type != kCgaArray) return list(v);
  std::vector<std::string> files;
  const ArrayValue all = arrayOf(v);
  for (const CgaValue& file : all.values) files.push_back(text(file));
  return files;
}

/// Those first that have to be stretched least to have the scope's extents along the axes, or its proportions. Files
/// that cannot be read are last. mostError: above 0, the part by which they may be stretched; the others are left out.
std::vector<std::string> Deriver::sortedFiles(const std::vector<std::string>& files, std::string_view axes,
                                              bool byRatio, bool arePictures, float mostError) {
  struct Fit {
    double stretch;
    const std::string* file;
  };
  std::vector<Fit> fits;
  const vec3 scope = shape_.form.scope.size;
  for (const std::string& file : files) {
    vec3 size(0);
    if (arePictures) {
      const PictureSize pixels = pictureSize(findFile(file));
      // A picture's height is the axis that is named second.
      size = {static_cast<float>(pixels.width), static_cast<float>(pixels.height), static_cast<float>(pixels.height)};
      if (axes == "yz") size.y = static_cast<float>(pixels.width);
    } else {
      std::string why;
      const Form* asset = assetForm(file, why);
      if (asset)
        size = asset->scope.size;
      else
        warn("asset " + file, "nothing is known of the asset \"" + file + "\": " + why);
    }
    double least = 1e30, most = -1e30;
    bool isKnown = true;
    for (const char axis : axes) {
      const int i = axis == 'y' ? 1 : axis == 'z' ? 2 : 0;
      isKnown = isKnown && size[i] > 0 && scope[i] > 0;
      const double stretch = isKnown ? std::log(static_cast<double>(scope[i]) / static_cast<double>(size[i])) : 0;
      least = std::min(least, stretch);
      most = std::max(most, stretch);
    }
    const double by = !isKnown ? 1e30 : byRatio ? most - least : std::max(std::fabs(least), std::fabs(most));
    if (mostError > 0 && by > std::log1p(static_cast<double>(mostError)) + 1e-6) continue;
    fits.push_back({by, &file});
  }
  std::stable_sort(fits.begin(), fits.end(), [](const Fit& a, const Fit& b) { return a.stretch < b.stretch; });
  std::vector<std::string> result;
  for (const Fit& fit : fits) result.push_back(*fit.file);
  return result;
}

CgaValue Deriver::sorted(const Arguments& a, bool byRatio, bool arePictures, float mostError) {
  const std::vector<std::string> files = sortedFiles(filesOf(a[0]), word(a[1]), byRatio, arePictures, mostError);
  if (a[0].type != kCgaArray) return listValue(files);
  ArrayValue result;
  for (const std::string& file : files) result.values.push_back(stringValue(file));
  return array(std::move(result));
}
CgaValue Deriver::assetsSortSize_(const Arguments& a) { return sorted(a, false, false, number(a[2])); }
CgaValue Deriver::assetsSortRatio_(const Arguments& a) { return sorted(a, true, false, 0); }
CgaValue Deriver::imagesSortRatio_(const Arguments& a) { return sorted(a, true, true, 0); }

/// One of the `best` files that a search finds and that fit best.
CgaValue Deriver::oneOf(const Arguments& a, bool byRatio, bool arePictures, float best, float mostError) {
  const std::string pattern = text(a[0]);
  const std::vector<std::string> found = pattern.find(';') != std::string::npos ? list(a[0]) : searchFiles(pattern);
  const std::vector<std::string> files = sortedFiles(found, word(a[1]), byRatio, arePictures, mostError);
  const float r = best > 1 ? cgaRandom() : 0.0f;
  if (files.empty()) {
    warn("fileRandom " + pattern, "no file is found for \"" + pattern + "\"");
    return stringValue({});
  }
  const float count = std::clamp(std::floor(best), 1.0f, static_cast<float>(files.size()));
  return stringValue(files[std::min(files.size() - 1, static_cast<size_t>(r * count))]);
}
CgaValue Deriver::assetBestSize_(const Arguments& a) { return oneOf(a, false, false, 1, 0); }
CgaValue Deriver::assetBestRatio_(const Arguments& a) { return oneOf(a, true, false, 1, 0); }
CgaValue Deriver::assetApproxSize_(const Arguments& a) { return oneOf(a, false, false, number(a[2]), 0); }
CgaValue Deriver::assetApproxRatio_(const Arguments& a) { return oneOf(a, true, false, number(a[2]), 0); }
CgaValue Deriver::assetFitSize_(const Arguments& a) { return oneOf(a, false, false, 1e6f, number(a[2])); }
CgaValue Deriver::imageBestRatio_(const Arguments& a) { return oneOf(a, true, true, 1, 0); }
CgaValue Deriver::imageApproxRatio_(const Arguments& a) { return oneOf(a, true, true, number(a[2]), 0); }

/// sx, sy: pixels.
CgaValue Deriver::imageInfo_(const Arguments& a) {
  const std::string path = text(a[0]);
  const std::string_view which = word(a[1]);
  const PictureSize size = pictureSize(findFile(path));
  if (size.width == 0) warn("file " + path, "\"" + path + "\" is no PNG, JPEG, GIF or BMP file");
  if (which != "sx" && which != "sy")
    warn("imageInfo", "imageInfo knows sx and sy, pixels; '" + std::string(which) + "' is 0");
  return floatValue(which == "sx"   ? static_cast<float>(size.width)
                    : which == "sy" ? static_cast<float>(size.height)
                                    : 0.0f);
}

// ---------------------------------------------------------------- materials

/// Names and values of a material: those of a .mtl file's first one, or of a .cgamat file's lines.
CgaValue Deriver::readMaterial_(const Arguments& a) {
  const std::string path = text(a[0]), file = findFile(path);
  ArrayValue result;
  const auto add = [&](std::string_view name, std::string_view value) {
    result.values.push_back(stringValue(name));
    result.values.push_back(stringValue(value));
  };
  std::ifstream in(file);
  if (file.empty() || !in) warn("file " + path, "there is no file \"" + path + "\"");
  std::string line;
  uint32_t materials = 0;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  while (std::getline(in, line) && materials < 2 && result.values.size() < 1000) {
    std::istringstream words(line);
    std::string key, value;
    words >> key;
    if (key == "newmtl") ++materials;
    if (materials > 1) break;
    if (key == "Kd")
      for (const char* channel : {"color.r", "color.g", "color.b"})
        if (words >> value) add(channel, value);
    if ((key == "d" || key == "Pm" || key == "Pr") && words >> value)
      add(key == "d" ? "opacity" : key == "Pm" ? "metallic" : "roughness", value);
    if (key == "map_Kd" && words >> value) add("colormap", (folder / value).generic_string());
  }
  if (!file.empty() && result.values.empty())
    warn("material " + path, "\"" + path + "\" holds no material as .mtl files have them");
  if (!result.values.empty()) result.width = 2;
  return array(std::move(result));
}

/// Rows of a name and a value; colours and textures, which is what shapes have here.
CgaValue Deriver::getMaterial_(const Arguments& a) {
  const bool all = word(a[1]) == "all";
  ArrayValue result;
  const auto add = [&](std::string_view name, std::string_view value) {
    result.values.push_back(stringValue(name));
    result.values.push_back(stringValue(value));
  };
  const glm::vec4 c = shape_.color;
  const bool isColored = c.x != 1 || c.y != 1 || c.z != 1;
  if (all || isColored) {
    add("color.b", textOf(c.z));
    add("color.g", textOf(c.y));
    add("color.r", textOf(c.x));
  }
  if (all || c.w != 1) add("opacity", textOf(c.w));
  if (all || shape_.texture) add("colormap", strings_.text(shape_.texture));
  if (!result.values.empty()) result.width = 2;
  return array(std::move(result));
}

/// Whether there is such an attribute of materials; others have no effect.
bool Deriver::material(std::string_view name, const CgaValue& v) {
  const CgaValue value =
      v.type == kCgaString && name != "colormap" && !name.ends_with("rgb") ? floatValue(numberOf(text(v))) : v;
  if (const auto operation = findSettable("material." + std::string(name)))
    return setAttributeOfShape(*operation, value);
  for (uint32_t slot = 0; slot < program_.attributes.size(); ++slot)
    if (program_.attributes[slot].isMaterial && program_.attributes[slot].name == "material." + std::string(name))
      cgaSetAttribute(slot, v);
  return true;
}

CgaValue Deriver::firstOfMaterial(std::string_view name) {
  constexpr std::pair<std::string_view, float> kNumbers[] = {{"material.shininess", 1.0f},
                                                             {"material.bumpValue", 1.0f},
                                                             {"material.roughness", 1.0f},
                                                             {"material.opacitymap.cutoff", 0.5f}};
  for (const auto& [known, value] : kNumbers)
    if (known == name) return floatValue(value);
  if (name == "material.shader") return stringValue("CityEngineShader");
  if (name == "material.opacitymap.mode") return stringValue("blend");
  if (name == "material.name" || name.ends_with("map")) return stringValue({});
  if (name.ends_with("map.su") || name.ends_with("map.sv")) return floatValue(1);
  return name == "material.doubleSided" ? cgaBoolValue(true) : floatValue(0);
}

/// A name and a value in turn.
bool Deriver::setMaterial_(const Arguments& a) {
  if (a[0].type != kCgaArray) {
    warn("setMaterial", "setMaterial takes an array of names and values");
    return true;
  }
  const ArrayValue all = arrayOf(a[0]);
  for (size_t i = 0; i + 1 < all.values.size(); i += 2) {
    const std::string name = text(all.values[i]);
    if (!material(name, all.values[i + 1])) return false;
  }
  return true;
}

bool Deriver::resetMaterial_(const Arguments&) {
  shape_.color = glm::vec4(1);
  shape_.texture = 0;
  return true;
}

/// In the pool, once for each axiom.
Form* Deriver::assetForm(const std::string& path, std::string& why) {
  const auto [found, isNew] = assets_.try_emplace(path);
  why = "there is no such file";
  if (isNew) {
    std::string file = findFile(path);
    if (file.empty() && !options_.assetsAreFiles) file = program_.folder + path;
    Asset asset;
    if (!file.empty() && options_.loadAsset && options_.loadAsset(file, asset, why) && !asset.indices.empty())
      found->second = std::make_unique<Asset>(std::move(asset));
  }
  if (!found->second) return nullptr;
  const auto [form, isNewForm] = assetForms_.try_emplace(path);
  if (isNewForm) {
    const std::vector<uint32_t> sizes(found->second->indices.size() / 3, 3);
    const Status status = makeMesh(pool_, found->second->positions, found->second->indices, sizes, {}, form->second);
    if (status != kGeometryOk) {
      assetForms_.erase(path);
      why = describeStatus(status);
      if (status == kGeometryNoRoom || (status == kGeometryTooLarge && poolWords_ < (1u << 26))) noRoom_ = true;
      return nullptr;
    }
  }
  return &form->second;
}

} // namespace gpgp::spawn::cga
