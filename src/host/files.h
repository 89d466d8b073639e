// Whole files in and out. Throws std::runtime_error with the file's name and the system's words.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gpgp::host {

std::vector<uint8_t> readFile(const std::filesystem::path& file);
std::string readText(const std::filesystem::path& file);
/// Makes missing folders. A file is replaced as a whole, and keeps its permissions: where not all bytes could be
/// written, it stays as it was. Devices, pipes and files with several names are written where they are.
void writeFile(const std::filesystem::path& file, std::string_view bytes);

} // namespace gpgp::host
