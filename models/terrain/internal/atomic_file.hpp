#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "models/types/result.hpp"

namespace wex::terrain_internal {

/// Writes the whole file or leaves what was there: the text goes to a file beside it, which is then
/// renamed.
///   errors  kBadInput naming the file and the system's reason (folder missing or not writable,
///   ...)
[[nodiscard]] Result<void> write_whole_file(const std::filesystem::path& file,
                                            std::string_view text);

/// The whole text of a file.
///   errors  kBadInput naming the file: missing, a folder, unreadable
[[nodiscard]] Result<std::string> read_whole_file(const std::filesystem::path& file);

}  // namespace wex::terrain_internal
