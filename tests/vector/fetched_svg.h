// Drawings that tests/data/fetch.sh fetches, imported.
#pragma once
#include "host/files.h"
#include "vector/import/svg/import.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>

namespace gpgp::test {

/// Without masks, filters and blend modes, which the references of these tests do not have (layers_test.cpp tests
/// those). Nothing where the file is not there, for tests to skip; a failure where it cannot be imported.
inline std::optional<vector::svg::Imported> fetchedSvg(const std::string& name) {
  const std::string file = std::string(GPGP_TEST_DATA) + "/" + name;
  if (!std::filesystem::exists(file)) {
    std::printf("%s is not there: run tests/data/fetch.sh --only svg\n", file.c_str());
    return {};
  }
  const auto bytes = host::readFile(file);
  vector::svg::Reporter reporter(nullptr, nullptr, name.c_str());
  vector::svg::ImportDetail detail;
  detail.layers = false;
  auto svg = vector::svg::importSvg(std::as_bytes(std::span(bytes)), reporter, {}, {}, detail);
  if (!svg) {
    ADD_FAILURE() << svg.error().text;
    return {};
  }
  return std::move(*svg);
}

} // namespace gpgp::test
