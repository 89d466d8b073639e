// What a data: URI holds (RFC 2397).
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gpgp::vector::svg {

/// %41 becomes A; what is no such code stays as it is.
std::string percentDecoded(std::string_view text);

/// The bytes, from base64 or from percent codes; empty where it is something else.
std::vector<uint8_t> decodeDataUri(std::string_view uri);

} // namespace gpgp::vector::svg
