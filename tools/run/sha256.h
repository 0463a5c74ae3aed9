#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace hoof::tools {

/// SHA-256 (FIPS 180-4, by OpenSSL's libcrypto) as 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

/// The same of a file's content; UserError where it cannot be read.
std::string sha256_hex_of_file(const std::filesystem::path& path);

}  // namespace hoof::tools
